// ident: the options of a fit, one row each: the flag, its check, and its entry in a model's JSON
// are made from the row.
//
//   {"settling_weight", "weight of ...", "/settling_weight", ...}
//   -> --settling_weight=10, FitOptions::IsValid, {"settling_weight": 10.0}
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ident/parameters/fit_options.h"

namespace pushid {

// When a row is applied (fit/fit_setup.h).
enum class OptionStage {
  kPreset,  // first, and before anything else is known
  kModel,   // before the parameters of the chosen terms are freed
  kTable    // last: edits single parameters
};

// The heading of what most users leave alone.
inline constexpr char kRarelyChanged[] = "rarely changed";

struct FitOptionRow {
  std::string name;  // of the flag, without its dashes
  std::string help;
  std::string heading;  // of --help: model, fit, kRarelyChanged
  OptionStage stage = OptionStage::kModel;
  bool is_bool = false;         // --name, --noname; the others take --name=value
  bool is_flag = true;          // otherwise it stands in files alone
  bool preset_decides = false;  // without it the preset's value holds
  // Its value in words: the default of the flag when asked of FitOptions(). Null where there is no
  // such value (an edit of the table, a file).
  std::function<std::string(const FitOptions&)> text;
  // Errors name the flag and the value. Null for kPreset.
  std::function<MaybeError(const std::string&, FitOptions*)> apply;
  // The rule that the value violates, "must be positive"; empty: none. Null: any value will do.
  std::function<std::string(const FitOptions&)> violation;

  std::string json;  // where it stands in a model's "model"; empty: nowhere
  std::function<nlohmann::ordered_json(const FitOptions&)> write;
  // Throws what nlohmann's JSON throws, and std::runtime_error for unknown names.
  std::function<void(const nlohmann::ordered_json&, FitOptions*)> read;
};

// All, and those that are flags; in the order in which they are applied and written.
const std::vector<FitOptionRow>& AllOptionRows();
const std::vector<FitOptionRow>& FitOptionRows();
// nullptr when there is none of that name.
const FitOptionRow* FindFitOption(const std::string& name);

}  // namespace pushid
