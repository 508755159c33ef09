// ident: errors of forecasts, their files and tables.
#include "ident/forecasts/forecast_errors.h"

#include <nlohmann/json.hpp>

#include "datasets/files/number_text.h"
#include "datasets/formats/units.h"
#include "ident/figures/text_table.h"

namespace pushid {
namespace {

constexpr Metric kMpjpeMm = {"MPJPE", "mm"};

nlohmann::ordered_json HorizonsJson(const HorizonErrors& errors) {
  nlohmann::ordered_json json;
  for (size_t k = 0; k < kHorizonFrames.size(); ++k) {
    json[std::to_string(HorizonMs(kHorizonFrames[k]))] = kMillimetres * errors[k];
  }
  return json;
}

}  // namespace

ForecastErrors ErrorsOf(const std::vector<ForecastWindow>& windows,
                        const std::vector<Trajectories>& forecasts, const ParticleLayout& layout) {
  ForecastErrors errors;
  for (size_t i = 0; i < windows.size(); ++i) {
    const Eigen::VectorXf distance = MeanDistance(forecasts[i], windows[i].future, layout);
    ActionErrors& action = errors.actions[windows[i].action];
    ++action.windows;
    for (size_t k = 0; k < kHorizonFrames.size(); ++k) {
      action.mpjpe[k] += distance(kHorizonFrames[k]);
    }
  }
  errors.mean.windows = static_cast<int>(windows.size());
  for (auto& [name, action] : errors.actions) {
    for (size_t k = 0; k < kHorizonFrames.size(); ++k) {
      action.mpjpe[k] /= action.windows;
      errors.mean.mpjpe[k] += action.mpjpe[k] / static_cast<double>(errors.actions.size());
    }
  }
  return errors;
}

std::vector<Trajectories> ZeroVelocity(const std::vector<ForecastWindow>& windows) {
  std::vector<Trajectories> forecasts;
  for (const ForecastWindow& window : windows) {
    forecasts.push_back(window.observed.rightCols(1).replicate(1, window.future.cols()));
  }
  return forecasts;
}

nlohmann::ordered_json ToJson(const ForecastErrors& errors) {
  const auto of = [](const ActionErrors& action) {
    return nlohmann::ordered_json{{"windows", action.windows},
                                  {kMpjpeMm.Key(), HorizonsJson(action.mpjpe)}};
  };
  nlohmann::ordered_json json;
  json["mean"] = of(errors.mean);
  for (const auto& [name, action] : errors.actions) json["actions"][name] = of(action);
  return json;
}

std::string ForecastErrorsText(const ForecastErrors& errors) {
  std::vector<std::string> head = {kMpjpeMm.Title(), "windows"};
  for (int frame : kHorizonFrames) head.push_back(std::to_string(HorizonMs(frame)) + " ms");
  std::vector<bool> left(head.size(), false);
  left[0] = true;
  TextTable table(head, left);
  const auto add = [&table](const std::string& name, const ActionErrors& action) {
    std::vector<std::string> row = {name, std::to_string(action.windows)};
    for (double error : action.mpjpe) row.push_back(Rounded(kMillimetres * error, 4));
    table.Add(row);
  };
  for (const auto& [name, action] : errors.actions) add(name, action);
  add("mean of actions", errors.mean);
  return table.ToString();
}

}  // namespace pushid
