// ident: rows of the option table by the kind of their value.
#pragma once

#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "ident/parameters/option_names.h"
#include "ident/parameters/option_table.h"

namespace pushid {

// Where a row's value stands: among the options of the fit, those of the model, or the sigmas.
template <typename T>
class OptionField {
 public:
  OptionField(T FitOptions::*of_fit) : of_fit_(of_fit) {}               // NOLINT: stands for it
  OptionField(T ModelOptions::*of_model) : of_model_(of_model) {}       // NOLINT
  OptionField(T ResidualSigmas::*of_sigmas) : of_sigmas_(of_sigmas) {}  // NOLINT
  T& operator()(FitOptions& o) const {
    return of_fit_ ? o.*of_fit_ : of_model_ ? o.model.*of_model_ : o.sigmas.*of_sigmas_;
  }

 private:
  T FitOptions::*of_fit_ = nullptr;
  T ModelOptions::*of_model_ = nullptr;
  T ResidualSigmas::*of_sigmas_ = nullptr;
};

template <typename T>
const T& OptionValue(OptionField<T> field, const FitOptions& options) {
  return field(const_cast<FitOptions&>(options));  // only read
}

struct OptionRange {
  double lower, upper;
  bool open = false;  // without its lower end
  const char* words;  // "must be positive"
};
inline constexpr double kAnyNumber = std::numeric_limits<double>::max();
inline constexpr OptionRange kPositive = {0.0, kAnyNumber, true, "must be positive"};
inline constexpr OptionRange kNotNegative = {0.0, kAnyNumber, false,
                                             "must be a number of at least 0"};

// "--sigma_hip is 'abc'; it must be positive".
Error BadOption(const std::string& name, const std::string& value, const std::string& must);

FitOptionRow NumberRow(const char* name, const char* json, OptionField<double> field,
                       OptionRange range, const char* help);
// A whole number of at least 1.
FitOptionRow CountRow(const char* name, const char* json, OptionField<int> field, const char* help);
// A row that stands in no model, with a way to apply its words.
FitOptionRow WordsRow(const char* name, OptionStage stage, const char* help,
                      std::function<MaybeError(const std::string&, FitOptions*)> apply);
FitOptionRow BoolRow(const char* name, const char* help,
                     std::function<bool(const FitOptions&)> value,
                     std::function<void(bool, FitOptions*)> set);

FitOptionRow Decided(FitOptionRow row);      // by the preset
FitOptionRow MayBeAbsent(FitOptionRow row);  // in older files

// An enum, or the interaction terms, by name.
template <typename E>
FitOptionRow NameRow(const char* name, const char* json, OptionField<E> field, const char* help) {
  FitOptionRow row =
      WordsRow(name, OptionStage::kModel, help, [=](const std::string& text, FitOptions* o) {
        return ParseName("--" + std::string(name), text, &field(*o));
      });
  row.json = json;
  row.text = [field](const FitOptions& o) { return NameOf(OptionValue(field, o)); };
  row.write = [text = row.text](const FitOptions& o) { return nlohmann::ordered_json(text(o)); };
  row.read = [=](const nlohmann::ordered_json& value, FitOptions* o) {
    if (MaybeError error = ParseName(name, value.get<std::string>(), &field(*o))) {
      throw std::runtime_error(error->ToString());
    }
  };
  return row;
}

// An enum that other options depend on, which `set` sets with it; absent in older files.
template <typename E>
FitOptionRow NameRowWith(void (*set)(E, FitOptions*), const char* name, const char* json,
                         OptionField<E> field, const char* help) {
  FitOptionRow row = NameRow<E>(name, json, field, help);
  row.apply = [=](const std::string& text, FitOptions* o) -> MaybeError {
    E value{};
    if (MaybeError error = ParseName("--" + std::string(name), text, &value)) return error;
    set(value, o);
    return std::nullopt;
  };
  return MayBeAbsent(row);
}

// What the model is: the rows with rules of their own.
std::vector<FitOptionRow> ModelOptionRows();
// How networks are trained.
std::vector<FitOptionRow> NetworkOptionRows();
// Edits of the parameter table.
std::vector<FitOptionRow> TableOptionRows();

}  // namespace pushid
