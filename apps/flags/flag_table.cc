// apps: flags in one table.
#include "apps/flags/flag_table.h"

#include <gflags/gflags.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "apps/support/app_support.h"
#include "apps/support/overwrite_check.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/parameters/option_table.h"

namespace pushid {
namespace {

using FlagInfo = gflags::CommandLineFlagInfo;

// gflags lists the flags of every library it finds; users care for ours.
std::vector<FlagInfo> OwnFlags() {
  std::vector<FlagInfo> all, own;
  gflags::GetAllFlags(&all);
  for (const FlagInfo& flag : all) {
    if (flag.filename.find("apps/") != std::string::npos) own.push_back(flag);
  }
  return own;
}

// What names outputs or only changes speed and talk is no part of a result.
bool IsPartOfResult(const FlagInfo& flag) {
  static const std::set<std::string> kLeftOut = {"quiet", "num_threads", "check",
                                                 "list_parameters"};
  return !IsOutputFlag(flag.name) && kLeftOut.count(flag.name) == 0;
}

// gflags prints 0.2 as 0.20000000000000001.
std::string WithoutDust(const FlagInfo& flag, const std::string& text) {
  double value = 0.0;
  return flag.type == "double" && ParseDouble(text, &value) ? DoubleText(value) : text;
}

// By value: a default that is given is no change, `none` over a preset's value is one.
bool Changed(const FlagInfo& flag) {
  double now = 0.0, before = 0.0;
  const bool numbers =
      ParseDouble(flag.current_value, &now) && ParseDouble(flag.default_value, &before);
  return numbers ? now != before : flag.current_value != flag.default_value;
}

// A switch that is off by default, and given as off.
bool IsOff(const FlagInfo& flag) {
  return flag.type == "bool" && flag.current_value == "false" && !Changed(flag);
}

bool HasEffect(const std::string& name) {
  FlagInfo flag;
  return gflags::GetCommandLineFlagInfo(name.c_str(), &flag) && Changed(flag);
}

std::string WithDashes(const std::vector<std::string>& names, const std::string& between) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "--" : between + "--") + name;
  return text;
}

// The headings of --help, in their order, and the files of flags below each.
struct Heading {
  const char* title;
  std::vector<const char*> files;
};
const std::vector<Heading>& Headings() {
  static const std::vector<Heading> headings = {
      {"recordings", {"recording_flags"}},
      {"model", {"model_flags"}},
      {"fit", {}},
      {kRarelyChanged, {}},
      {"settings", {}},  // what stands nowhere else: the program's own
      {"prediction", {"observed_flags", "futures_flags"}},
      {"bodies", {"restoration_flags", "postprocess_flags", "diffusion_flags"}},
      {"output", {"overwrite_flag"}},
      {"general", {"command_line"}}};
  return headings;
}

std::string HeadingOf(const FlagInfo& flag) {
  if (IsOutputFlag(flag.name)) return "output";
  if (flag.name == "num_threads" || flag.name == "seed") return "general";
  const FitOptionRow* const row = FindFitOption(flag.name);
  if (row != nullptr && flag.filename.find("fit_option") != std::string::npos) return row->heading;
  for (const Heading& heading : Headings()) {
    for (const char* file : heading.files) {
      if (flag.filename.find(std::string("/") + file + ".") != std::string::npos) {
        return heading.title;
      }
    }
  }
  return "settings";
}

}  // namespace

void CheckFlagRules(const std::vector<FlagRule>& rules) {
  for (const FlagRule& rule : rules) {
    const FlagInfo flag = gflags::GetCommandLineFlagInfoOrDie(rule.flag.c_str());
    if (flag.is_default || flag.current_value.empty() || IsOff(flag)) continue;
    const bool acts = std::any_of(rule.others.begin(), rule.others.end(), HasEffect);
    if (acts == (rule.kind == FlagRule::kNeeds)) continue;
    std::string sentence = rule.why;
    const size_t name = sentence.find("{}");
    if (name != std::string::npos) throw Error{sentence.replace(name, 2, rule.flag)};
    if (acts) throw Error{sentence};
    throw Error{"--" + rule.flag + " needs " + WithDashes(rule.others, " or ") + sentence};
  }
}

namespace {

void CheckSame(const std::vector<std::string>& flags, FlagRule::Kind kind,
               const std::vector<std::string>& others, const std::string& why) {
  std::vector<FlagRule> rules;
  for (const std::string& flag : flags) rules.push_back({flag, kind, others, why});
  CheckFlagRules(rules);
}

}  // namespace

void CheckNeeds(const std::vector<std::string>& flags, const std::vector<std::string>& others,
                const std::string& why) {
  CheckSame(flags, FlagRule::kNeeds, others, why);
}

void CheckExcludes(const std::vector<std::string>& flags, const std::string& other,
                   const std::string& why) {
  CheckSame(flags, FlagRule::kExcludes, {other}, why);
}

bool Given(const char* flag) { return !gflags::GetCommandLineFlagInfoOrDie(flag).is_default; }

void Require(const std::string& flag, const std::string& value, const std::string& what) {
  if (!value.empty()) return;
  throw Error{"--" + flag + " is missing: " + what};
}

void CheckRange(const char* flag, double value, double lowest, double highest) {
  if (value >= lowest && value <= highest) return;
  std::ostringstream text;
  text << "--" << flag << " is " << value << "; it must lie between " << lowest << " and "
       << highest;
  throw Error{text.str()};
}

void TakeLength(const std::string& unit, double scale, std::optional<LengthUnit>* length_unit,
                std::optional<double>* length_scale) {
  if (scale != 0.0 && !unit.empty()) {
    throw Error{"--length_scale is given together with --length_unit; give one of them"};
  }
  if (scale != 0.0) {
    const std::string problem = LengthScaleProblem(scale);
    if (!problem.empty()) throw Error{"--length_scale " + problem};
    *length_scale = scale;
  }
  if (unit.empty()) return;
  OrFail(ParseName("--length_unit", unit, &length_unit->emplace()));
}

std::map<std::string, std::string> EffectiveFlags() {
  std::map<std::string, std::string> flags;
  for (const FlagInfo& flag : OwnFlags()) {
    if (IsPartOfResult(flag)) flags[flag.name] = WithoutDust(flag, flag.current_value);
  }
  return flags;
}

nlohmann::ordered_json ResultHead(const char* schema) {
  return {{"schema", schema}, {"version", Version()}, {"configuration", EffectiveFlags()}};
}

std::vector<std::string> ChangedFlags() {
  std::vector<std::string> names;
  for (const FlagInfo& flag : OwnFlags()) {
    if (Changed(flag) && IsPartOfResult(flag)) names.push_back(flag.name);
  }
  return names;
}

std::string FlagHelp(bool full) {
  std::map<std::string, std::string> below;
  std::string named;
  const auto add = [&below](const std::string& heading, const std::string& name,
                            const std::string& text) {
    below[heading] += "  " + name + "\n      " + text + "\n";
  };
  for (const FlagInfo& flag : OwnFlags()) {
    const std::string heading = HeadingOf(flag);
    if (heading == kRarelyChanged && !full) {
      named += (named.empty() ? "--" : " --") + flag.name;
      continue;
    }
    const std::string value =
        flag.default_value.empty() ? "" : "=" + WithoutDust(flag, flag.default_value);
    add(heading, "--" + flag.name + value, flag.description);
  }
  add("general", "--flagfile=FILE", "read flags from a file, one per line");
  add("general", "--help, -h, --helpfull", "print this");
  add("general", "--version", "print the version");
  if (!named.empty()) add(kRarelyChanged, named, "--helpfull describes them");
  std::string text;
  for (const Heading& heading : Headings()) {
    const auto flags = below.find(heading.title);
    if (flags != below.end()) text += "\n" + std::string(heading.title) + ":\n" + flags->second;
  }
  return text;
}

Error NoSuchFlag(const std::string& name) {
  std::vector<std::string> known;
  for (const FlagInfo& flag : OwnFlags()) known.push_back(flag.name);
  std::string meant = MeantBy(name, known);
  // "out", where several things can be written.
  for (const std::string& one : known) {
    if (!meant.empty() && !EndsWith(meant, "_" + name)) break;
    if (EndsWith(one, "_" + name)) meant += (meant.empty() ? "" : " or --") + one;
  }
  return Error{"there is no flag --" + name + "; " +
               (meant.empty() ? "see " : "did you mean --" + meant + "? Or see ") + ProgramName() +
               " --help"};
}

}  // namespace pushid
