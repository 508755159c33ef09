// ident: refits to JSON and back.
#include "ident/model/refit_json.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "ident/model/json_pieces.h"

namespace pushid {

namespace {
using Json = nlohmann::ordered_json;
}  // namespace

Json ToJson(const RefitTable& table) {
  Json parameters = Json::array(), rows = Json::array();
  for (size_t i = 0; i < table.parameters.size(); ++i) {
    parameters.push_back({{"name", table.parameters[i]},
                          {"unit", table.units[i]},
                          {"value", NumberJson(table.value[i])},
                          {"standard_error", NumberJson(table.standard_error[i])}});
  }
  for (const RefitRow& row : table.rows) {
    rows.push_back({{"source", row.source},
                    {"name", row.name},
                    {"values", NumbersJson(row.value)},
                    {"standard_errors", NumbersJson(row.standard_error)},
                    {"failure", row.failure},
                    {"frames", row.frames}});
  }
  return {{"parameters", parameters}, {"refits", rows}};
}

RefitTable RefitTableFromJson(const Json& json) {
  RefitTable table;
  for (const Json& p : json.at("parameters")) {
    table.parameters.push_back(p.at("name"));
    table.units.push_back(p.at("unit"));
    table.value.push_back(NumberFrom(p.at("value")));
    table.standard_error.push_back(NumberFrom(p.at("standard_error")));
  }
  for (const Json& r : json.at("refits")) {
    RefitRow row{r.at("source"),
                 r.at("name"),
                 NumbersFrom(r.at("values")),
                 NumbersFrom(r.at("standard_errors")),
                 r.at("failure"),
                 r.at("frames")};
    const auto whole = [&table](const std::vector<double>& numbers) {
      return numbers.empty() || numbers.size() == table.parameters.size();
    };
    if (!whole(row.value) || !whole(row.standard_error)) {
      throw std::runtime_error("refits of different lengths");
    }
    table.rows.push_back(row);
  }
  return table;
}

}  // namespace pushid
