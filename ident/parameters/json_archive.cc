// ident: numbers in JSON.
#include "ident/parameters/json_archive.h"

#include <cmath>
#include <limits>

namespace pushid {

namespace {
using Json = nlohmann::ordered_json;
}  // namespace

Json NumberJson(double value) {
  if (std::isfinite(value)) return value;
  if (std::isnan(value)) return "nan";
  return value > 0 ? "infinity" : "-infinity";
}

double NumberFrom(const Json& json) {
  if (json.is_number()) return json.get<double>();
  const std::string text = json.get<std::string>();
  if (text == "infinity") return std::numeric_limits<double>::infinity();
  if (text == "-infinity") return -std::numeric_limits<double>::infinity();
  if (text == "nan") return std::numeric_limits<double>::quiet_NaN();
  throw std::runtime_error("'" + text + "' is not a number");
}

Json NumberOrNull(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

}  // namespace pushid
