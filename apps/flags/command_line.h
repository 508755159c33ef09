// apps: the command line of every program: help, version, which flags were given, common checks.
#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include "apps/support/app_support.h"
#include "datasets/files/error.h"

namespace pushid {

// Parses flags (--help and --version answer themselves), refuses outputs that would replace an
// input or each other, then calls run. usage: one paragraph and an example. Words that are no flags
// go to `words`; without it they are an error.
int RunApp(int argc, char** argv, const std::string& usage, int (*run)(),
           std::vector<std::string>* words = nullptr);

// A flag that is given several times would keep its last value alone: all of them, with the
// separator between. Before RunApp.
void JoinRepeated(const std::string& flag, char separator, int argc, char** argv);

// "--recordings is missing ..." when a flag that is needed is empty.
MaybeError Require(const std::string& flag, const std::string& value, const std::string& what);

// Whether a flag was given at all, even with its default's value.
bool Given(const char* flag);

// The effective flags of this executable that are part of a result: not outputs, threads,
// verbosity.
std::map<std::string, std::string> EffectiveFlags();

// Names of those that are not at their defaults.
std::vector<std::string> ChangedFlags();

// "--spacing is -1; it must lie between ...". Written so that NaN fails.
MaybeError CheckRange(const char* flag, double value, double lowest, double highest);

// Whether the outputs that are named (not empty) can be written, before a long run.
MaybeError CheckOutputFiles(std::initializer_list<std::string> files);

}  // namespace pushid
