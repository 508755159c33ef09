// apps: the flags of this executable as a table: what is given, what goes with what, the list that
// --help prints.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/units.h"

namespace pushid {

// What one flag asks of others, a row each.
struct FlagRule {
  enum Kind { kNeeds, kExcludes };
  std::string flag;
  Kind kind;
  std::vector<std::string> others;  // one of them is enough
  // kNeeds: what follows "--flag needs --other or --another". kExcludes, and where there is a {},
  // which stands for the flag: the whole sentence.
  std::string why;
};
// Whether a flag that is given has what it needs, and nothing that it excludes. A flag of others
// acts where its value is not its default. A switch that is given as off asks for nothing.
void CheckFlagRules(const std::vector<FlagRule>& rules);
// Of many flags that need, or exclude, the same.
void CheckNeeds(const std::vector<std::string>& flags, const std::vector<std::string>& others,
                const std::string& why = "");
void CheckExcludes(const std::vector<std::string>& flags, const std::string& other,
                   const std::string& why);

// Whether a flag was given at all, even with its default's value.
bool Given(const char* flag);

// "--recordings is missing ..." when a flag that is needed is empty.
void Require(const std::string& flag, const std::string& value, const std::string& what);

// "--spacing is -1; it must lie between ...". Written so that NaN fails.
void CheckRange(const char* flag, double value, double lowest, double highest);
// The value that a flag has, into its place.
template <typename Value, typename Target>
void TakeInRange(const char* flag, Value value, double lowest, double highest, Target* target) {
  *target = value;
  CheckRange(flag, static_cast<double>(value), lowest, highest);
}

// --length_unit or --length_scale, whichever has a value, into its place. Errors: both; a unit or a
// scale that is none.
void TakeLength(const std::string& unit, double scale, std::optional<LengthUnit>* length_unit,
                std::optional<double>* length_scale);

// The effective flags of this executable that are part of a result: not outputs, threads,
// verbosity.
std::map<std::string, std::string> EffectiveFlags();

// What a program's JSON begins with: the name of its format, version, effective flags.
nlohmann::ordered_json ResultHead(const char* schema);

// Names of those that are not at their defaults.
std::vector<std::string> ChangedFlags();

// What --help prints: flags below their headings. full: what is rarely changed, too, is described
// and not only named.
std::string FlagHelp(bool full);

// A name that gflags does not know: names the program, and what may be meant.
Error NoSuchFlag(const std::string& name);

}  // namespace pushid
