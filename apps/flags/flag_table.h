// apps: the flags of this executable as a table: what is given, what goes with what, the list that
// --help prints and that shells complete from.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/units.h"
#include "models/enum_names.h"

// A string flag that takes one of an enum's names: shells complete them.
#define DEFINE_choice(name, value, help)            \
  DEFINE_string(name, pushid::NameOf(value), help); \
  const bool choices_of_##name =                    \
      pushid::SetChoices(#name, pushid::AllNames<std::decay_t<decltype(value)>>())

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

// What a program's JSON begins with: the name of its schema (apps/schemas), version, effective
// flags.
nlohmann::ordered_json ResultHead(const char* schema);

// Names of those that are not at their defaults.
std::vector<std::string> ChangedFlags();

// Flags that belong to another program now, and are taken here for one more version.
struct MovedFlags {
  std::vector<std::string> names;
  std::string program;
  std::string what;  // "Checks of a finished fit"

  bool Has(const std::string& flag) const;
  // The first of them that is given; empty: none.
  std::string FirstGiven() const;
  static constexpr char kUntil[] = "version 0.4";
};

// What --help and the manual are made of: flags below their headings.
struct HelpEntry {
  std::string name, text;  // "--out=", what it does
};
struct HelpSection {
  std::string title;
  std::vector<HelpEntry> entries;
};
std::vector<HelpSection> FlagSections(const MovedFlags& moved, bool full);
// Under headings, without those that moved. full: what is rarely changed, too, is described and not
// only named.
std::string FlagHelp(const MovedFlags& moved, bool full);
// One line a flag: name, `bool` or `value`, the words it takes, the first sentence of its help;
// tabs between. What `pushid completion` is made of.
std::string FlagList(const MovedFlags& moved);

// A name that gflags does not know: names the program, and what may be meant.
Error NoSuchFlag(const std::string& name);

// The words that a flag takes. Always true, so that it can be said beside the flag.
bool SetChoices(const std::string& flag, const std::vector<std::string>& words);

}  // namespace pushid
