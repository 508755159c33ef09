// apps: fit flags, registered from the option table.
#include "apps/flags/fit_option_flags.h"

#include <gflags/gflags.h>

#include <list>
#include <string>

#include "apps/support/app_support.h"
#include "ident/parameters/option_table.h"

namespace pushid {
namespace {

// gflags keeps pointers to names, helps and values until the program ends.
template <typename T>
void Register(const FitOptionRow& row, const std::string& help, const T& value) {
  static std::list<std::string> words;
  static std::list<T> values;
  words.push_back(help);
  values.push_back(value);
  T* const current = &values.back();
  values.push_back(value);
  gflags::FlagRegisterer(row.name.c_str(), words.back().c_str(), __FILE__, current, &values.back());
}

// Rows parse the values, because their errors say more than those of gflags.
bool RegisterFitFlags() {
  const FitOptions defaults;
  for (const FitOptionRow& row : FitOptionRows()) {
    if (row.is_bool) {
      Register<bool>(row, row.help, row.text(defaults) == "true");
    } else if (row.preset_decides) {
      Register<std::string>(row, row.help + " (default: the preset's)", "");
    } else {
      Register<std::string>(row, row.help, row.text ? row.text(defaults) : "");
    }
  }
  return true;
}

const bool registered = RegisterFitFlags();

}  // namespace

GivenOptions GivenFitFlags() {
  GivenOptions given;
  for (const FitOptionRow& row : FitOptionRows()) {
    const gflags::CommandLineFlagInfo flag = gflags::GetCommandLineFlagInfoOrDie(row.name.c_str());
    // An empty value, as --fix= gives it, is the default of an option that has none of its own.
    const bool nothing = flag.current_value.empty() && flag.default_value.empty();
    if (!flag.is_default && !nothing) given.emplace_back(row.name, flag.current_value);
  }
  return given;
}

FitSetup FitSetupFromFlags() {
  const GivenOptions given = GivenFitFlags();
  return OrFail(FitSetup::Make(given, given));
}

namespace {

// The value of a flag that was checked with all others.
std::int64_t WholeNumber(const char* flag) {
  return std::stoll(gflags::GetCommandLineFlagInfoOrDie(flag).current_value);
}

}  // namespace

int NumThreads() { return static_cast<int>(WholeNumber("num_threads")); }

uint64_t Seed() { return static_cast<uint64_t>(WholeNumber("seed")); }

}  // namespace pushid
