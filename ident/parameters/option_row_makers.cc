// ident: numbers, counts and words as rows.
#include "ident/parameters/option_row_makers.h"

#include <nlohmann/json.hpp>

#include "datasets/files/number_text.h"

namespace pushid {

namespace {

using Json = nlohmann::ordered_json;
using Row = FitOptionRow;

// Written so that NaN and infinity lie outside.
std::string RangeViolation(const OptionRange& range, double value) {
  const bool inside =
      (range.open ? value > range.lower : value >= range.lower) && value <= range.upper;
  return inside ? "" : range.words;
}

}  // namespace

Error BadOption(const std::string& name, const std::string& value, const std::string& must) {
  return Error{"--" + name + " is '" + value + "'; it " + must};
}

Row NumberRow(const char* name, const char* json, OptionField<double> field, OptionRange range,
              const char* help) {
  Row row;
  row.name = name;
  row.json = json;
  row.help = help;
  row.text = [field](const FitOptions& o) { return DoubleText(OptionValue(field, o)); };
  row.apply = [=](const std::string& text, FitOptions* o) -> MaybeError {
    if (ParseDouble(text, &field(*o))) return std::nullopt;
    return BadOption(name, text, range.words);
  };
  row.violation = [=](const FitOptions& o) { return RangeViolation(range, OptionValue(field, o)); };
  row.write = [field](const FitOptions& o) { return Json(OptionValue(field, o)); };
  row.read = [field](const Json& json_value, FitOptions* o) { field(*o) = json_value; };
  return row;
}

Row CountRow(const char* name, const char* json, OptionField<int> field, const char* help) {
  Row row;
  row.name = name;
  row.json = json;
  row.help = help;
  row.text = [field](const FitOptions& o) { return std::to_string(OptionValue(field, o)); };
  row.apply = [=](const std::string& text, FitOptions* o) -> MaybeError {
    std::int64_t value = 0;
    const bool whole = ParseInteger(text, &value) && value <= std::numeric_limits<int>::max() &&
                       value >= std::numeric_limits<int>::min();
    if (!whole) return BadOption(name, text, "must be a whole number of at least 1");
    field(*o) = static_cast<int>(value);
    return std::nullopt;
  };
  row.violation = [field](const FitOptions& o) {
    return OptionValue(field, o) >= 1 ? "" : "must be positive";
  };
  row.write = [field](const FitOptions& o) { return Json(OptionValue(field, o)); };
  row.read = [field](const Json& json_value, FitOptions* o) { field(*o) = json_value; };
  return row;
}

Row Decided(Row row) {
  row.preset_decides = true;
  return row;
}

Row MayBeAbsent(Row row) {
  row.may_be_absent = true;
  return row;
}

Row WordsRow(const char* name, OptionStage stage, const char* help,
             std::function<MaybeError(const std::string&, FitOptions*)> apply) {
  Row row;
  row.name = name;
  row.help = help;
  row.stage = stage;
  row.apply = std::move(apply);
  return row;
}

Row BoolRow(const char* name, const char* help, std::function<bool(const FitOptions&)> value,
            std::function<void(bool, FitOptions*)> set) {
  Row row = WordsRow(
      name, OptionStage::kModel, help, [=](const std::string& text, FitOptions* o) -> MaybeError {
        for (const auto& [yes, no] :
             {std::pair("true", "false"), std::pair("1", "0"), std::pair("yes", "no")}) {
          if (text != yes && text != no) continue;
          set(text == yes, o);
          return std::nullopt;
        }
        return BadOption(name, text, "must be true or false");
      });
  row.is_bool = true;
  row.text = [value](const FitOptions& o) { return value(o) ? "true" : "false"; };
  return row;
}

}  // namespace pushid
