// ident: pieces of result JSON.
#include "ident/model/json_pieces.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "ident/parameters/fit_options_json.h"

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

Json NumbersJson(const std::vector<double>& values) {
  Json row = Json::array();
  for (double value : values) row.push_back(NumberJson(value));
  return row;
}

std::vector<double> NumbersFrom(const Json& json) {
  std::vector<double> values;
  for (const Json& value : json) values.push_back(NumberFrom(value));
  return values;
}

Json RowsJson(const std::vector<std::vector<double>>& rows) {
  Json all = Json::array();
  for (const std::vector<double>& row : rows) all.push_back(NumbersJson(row));
  return all;
}

std::vector<std::vector<double>> RowsFrom(const Json& json) {
  std::vector<std::vector<double>> rows;
  for (const Json& row : json) rows.push_back(NumbersFrom(row));
  return rows;
}

Json MatrixJson(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (int i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (int j = 0; j < matrix.cols(); ++j) row.push_back(NumberJson(matrix(i, j)));
    rows.push_back(row);
  }
  return rows;
}

Eigen::MatrixXd MatrixFrom(const Json& json) {
  Eigen::MatrixXd matrix(json.size(), json.empty() ? 0 : json[0].size());
  for (int i = 0; i < matrix.rows(); ++i) {
    for (int j = 0; j < matrix.cols(); ++j) matrix(i, j) = NumberFrom(json.at(i).at(j));
  }
  return matrix;
}

Json EstimateJson(const Estimate& e) {
  return {{"name", e.name},
          {"value", NumberJson(e.value)},
          {"standard_error", NumberJson(e.standard_error)},
          {"standard_error_naive", NumberJson(e.standard_error_naive)},
          {"interval_95", {NumberJson(e.lower95), NumberJson(e.upper95)}},
          {"freedom", NumberJson(e.freedom)},
          {"shares",
           {{"data", NumberJson(e.shares.data)},
            {"prior", NumberJson(e.shares.prior)},
            {"settling", NumberJson(e.shares.settling)}}},
          {"pull",
           {{"prior", NumberJson(e.shares.prior_pull)},
            {"settling", NumberJson(e.shares.settling_pull)}}},
          {"unit", e.unit},
          {"status", NameOf(e.status)}};
}

Estimate EstimateFrom(const Json& json) {
  Estimate e;
  e.name = json.at("name");
  e.value = NumberFrom(json.at("value"));
  e.standard_error = NumberFrom(json.at("standard_error"));
  e.standard_error_naive = NumberFrom(json.at("standard_error_naive"));
  e.lower95 = NumberFrom(json.at("interval_95").at(0));
  e.upper95 = NumberFrom(json.at("interval_95").at(1));
  e.unit = json.at("unit");
  e.status = EnumFrom<EstimateStatus>(json, "status");
  // Models written before shares were computed say nothing of them.
  if (!json.contains("shares")) return e;
  e.freedom = NumberFrom(json.at("freedom"));
  const Json &shares = json.at("shares"), &pull = json.at("pull");
  e.shares = {NumberFrom(shares.at("data")), NumberFrom(shares.at("prior")),
              NumberFrom(shares.at("settling")), NumberFrom(pull.at("prior")),
              NumberFrom(pull.at("settling"))};
  return e;
}

Json CombinationJson(const Combination& c) {
  return {{"name", c.name},
          {"value", NumberJson(c.value)},
          {"standard_error", NumberJson(c.standard_error)},
          {"interval_95", {NumberJson(c.lower95), NumberJson(c.upper95)}},
          {"freedom", NumberJson(c.freedom)},
          {"unit", c.unit}};
}

Combination CombinationFrom(const Json& json) {
  const auto& interval = json.at("interval_95");
  return {json.at("name"),
          json.at("unit"),
          NumberFrom(json.at("value")),
          NumberFrom(json.at("standard_error")),
          NumberFrom(interval.at(0)),
          NumberFrom(interval.at(1)),
          NumberFrom(json.value("freedom", Json(1.0)))};
}

Json NullDirectionsJson(const std::vector<NullDirection>& directions) {
  Json rows = Json::array();
  for (const NullDirection& n : directions) {
    Json identified = Json::array();
    for (const Combination& c : n.identified) identified.push_back(CombinationJson(c));
    rows.push_back({{"parameters", n.parameters},
                    {"coefficients", NumbersJson(n.coefficients)},
                    {"identified", identified},
                    {"sentence", n.sentence}});
  }
  return rows;
}

std::vector<NullDirection> NullDirectionsFrom(const Json& json) {
  std::vector<NullDirection> directions;
  for (const Json& n : json) {
    NullDirection direction;
    direction.parameters = n.at("parameters").get<std::vector<std::string>>();
    direction.coefficients = NumbersFrom(n.at("coefficients"));
    for (const Json& c : n.at("identified")) direction.identified.push_back(CombinationFrom(c));
    direction.sentence = n.at("sentence");
    directions.push_back(direction);
  }
  return directions;
}

}  // namespace pushid
