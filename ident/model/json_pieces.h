// ident: what several writers and readers of result JSON share.
#pragma once

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "ident/uncertainty/uncertainty.h"

namespace pushid {

// JSON knows neither infinity nor NaN, and would have a null that no reader takes: they are written
// as the texts "infinity", "-infinity" and "nan". NumberFrom throws on any other text.
nlohmann::ordered_json NumberJson(double value);
double NumberFrom(const nlohmann::ordered_json& json);

nlohmann::ordered_json NumberOrNull(const std::optional<double>& value);

nlohmann::ordered_json NumbersJson(const std::vector<double>& values);
std::vector<double> NumbersFrom(const nlohmann::ordered_json& json);
nlohmann::ordered_json RowsJson(const std::vector<std::vector<double>>& rows);
std::vector<std::vector<double>> RowsFrom(const nlohmann::ordered_json& json);

nlohmann::ordered_json MatrixJson(const Eigen::MatrixXd& matrix);  // rows
Eigen::MatrixXd MatrixFrom(const nlohmann::ordered_json& json);

nlohmann::ordered_json EstimateJson(const Estimate& estimate);
Estimate EstimateFrom(const nlohmann::ordered_json& json);

nlohmann::ordered_json CombinationJson(const Combination& combination);
Combination CombinationFrom(const nlohmann::ordered_json& json);

nlohmann::ordered_json NullDirectionsJson(const std::vector<NullDirection>& directions);
std::vector<NullDirection> NullDirectionsFrom(const nlohmann::ordered_json& json);

}  // namespace pushid
