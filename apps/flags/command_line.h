// apps: the command line of every program: help, version, common checks, what is given and what
// goes with what. A program includes it before all else: it brings gflags and the files, names and
// numbers that every program reads and writes.
#pragma once

#include <gflags/gflags.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/support/app_support.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/units.h"

namespace pushid {

// Parses flags (--help and --version answer themselves), refuses outputs that would replace an
// input or each other, then calls run. usage: one paragraph and an example. Words that are no flags
// go to `words`; without it they are an error.
int RunApp(int argc, char** argv, const std::string& usage, int (*run)(),
           std::vector<std::string>* words = nullptr);

// Joins the values of a flag that is given several times, of which gflags would keep the last
// alone. Called before RunApp.
void JoinRepeated(const std::string& flag, char separator, int argc, char** argv);

// Whether a flag was given, even with its default's value.
bool Given(const char* flag);

// Throws "--FLAG WHY" for the first of these flags that is given; where the sentence has a {},
// which stands for the flag, WHY alone. file: the one that refuses them.
void RefuseGiven(const std::vector<std::string>& flags, const std::string& why,
                 const std::string& file = "");

// Throws "--recordings is missing ..." when a flag that is needed is empty.
void Require(const std::string& flag, const std::string& value, const std::string& what);

// Throws "--spacing is -1; it must lie between ..."; NaN is outside every range.
void CheckRange(const char* flag, double value, double lowest, double highest);
// Copies the value of a flag to its target and checks it.
template <typename Value, typename Target>
void TakeInRange(const char* flag, Value value, double lowest, double highest, Target* target) {
  *target = value;
  CheckRange(flag, static_cast<double>(value), lowest, highest);
}

// The effective flags of this executable that are part of a result: not outputs, threads,
// verbosity.
std::map<std::string, std::string> EffectiveFlags();

// The beginning of a program's JSON: name of its format, version, effective flags.
nlohmann::ordered_json ResultHead(const char* schema);

// Writes the JSON of a result; nothing where no file is named.
void WriteIfNamed(const std::string& file, const nlohmann::ordered_json& json);

// Names of flags that are not at their defaults.
std::vector<std::string> ChangedFlags();

}  // namespace pushid
