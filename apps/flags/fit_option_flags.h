// apps: the flags that say what to fit and how: the rows of the option table
// (ident/parameters/option_table.h) as gflags; shared by pushid-fit and pushid-crossvalidate.
#pragma once

#include <list>

#include "apps/flags/command_line.h"
#include "ident/fit/fit_setup.h"
#include "ident/parameters/option_table.h"

namespace pushid {

// gflags keeps pointers to names, helps and values until the program ends.
template <typename T>
void RegisterFitFlag(const FitOptionRow& row, const std::string& help, const T& value) {
  static std::list<std::string> words;
  static std::list<T> values;
  words.push_back(help);
  values.push_back(value);
  T* const current = &values.back();
  values.push_back(value);
  gflags::FlagRegisterer(row.name.c_str(), words.back().c_str(), __FILE__, current, &values.back());
}

// Rows parse the values, because their errors say more than those of gflags.
inline bool RegisterFitFlags() {
  const FitOptions defaults;
  for (const FitOptionRow& row : FitOptionRows()) {
    if (row.is_bool) {
      RegisterFitFlag<bool>(row, row.help, row.text(defaults) == "true");
    } else if (row.preset_decides) {
      RegisterFitFlag<std::string>(row, row.help + " (default: the preset's)", "");
    } else {
      RegisterFitFlag<std::string>(row, row.help, row.text ? row.text(defaults) : "");
    }
  }
  return true;
}

inline const bool kFitFlagsRegistered = RegisterFitFlags();

// Flags that the command line gave, even with their defaults' values.
inline GivenOptions GivenFitFlags() {
  GivenOptions given;
  for (const FitOptionRow& row : FitOptionRows()) {
    const gflags::CommandLineFlagInfo flag = gflags::GetCommandLineFlagInfoOrDie(row.name.c_str());
    // An empty value, as --fix= gives it, is the default of an option that has none of its own.
    const bool nothing = flag.current_value.empty() && flag.default_value.empty();
    if (!flag.is_default && !nothing) given.emplace_back(row.name, flag.current_value);
  }
  return given;
}

// The given flags over the preset's settings; once in a program. Errors also where a given flag
// acts on nothing.
inline FitSetup FitSetupFromFlags() {
  const GivenOptions given = GivenFitFlags();
  return OrFail(FitSetup::Make(given, given));
}

// The value of a flag that was checked with all others.
inline std::int64_t WholeNumber(const char* flag) {
  return std::stoll(gflags::GetCommandLineFlagInfoOrDie(flag).current_value);
}

inline int NumThreads() { return static_cast<int>(WholeNumber("num_threads")); }

inline uint64_t Seed() { return static_cast<uint64_t>(WholeNumber("seed")); }

}  // namespace pushid
