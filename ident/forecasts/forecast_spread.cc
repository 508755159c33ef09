// ident: scores of sampled futures.
#include "ident/forecasts/forecast_spread.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/files/number_text.h"
#include "datasets/formats/units.h"
#include "ident/figures/text_table.h"

namespace pushid {
namespace {

struct SpreadRow {
  const char* key;
  const char* title;
  HorizonErrors SpreadScores::*values;
  double unit;
};

constexpr SpreadRow kSpreadRows[] = {
    {"coverage_90", "coverage of 90 %", &SpreadScores::coverage, 1.0},
    {"CRPS_mm", "CRPS mm", &SpreadScores::crps, kMillimetres},
    {"energy_score_mm", "energy score mm", &SpreadScores::energy, kMillimetres},
    {"most_probable_MPJPE_mm", "most probable of n, MPJPE mm", &SpreadScores::probable,
     kMillimetres},
    {"best_of_n_MPJPE_mm", "best of n, MPJPE mm", &SpreadScores::best, kMillimetres},
};

// Of one coordinate at one frame; values are sorted by it.
void ScoreCoordinate(double truth, std::vector<double>* values, double* covered, double* crps) {
  std::sort(values->begin(), values->end());
  const double n = static_cast<double>(values->size());
  const double tail = 0.5 * (1.0 - kSpreadLevel);
  const bool inside =
      truth >= SampleQuantile(*values, tail) && truth <= SampleQuantile(*values, 1.0 - tail);
  *covered += inside ? 1.0 : 0.0;
  double from_truth = 0.0, among = 0.0;
  for (size_t i = 0; i < values->size(); ++i) {
    from_truth += std::abs((*values)[i] - truth);
    // Sorted, sum_ij |x_i - x_j| / 2 = sum_i x_i (2 i + 1 - n).
    among += (*values)[i] * (2.0 * static_cast<double>(i) + 1.0 - n);
  }
  *crps += from_truth / n - among / (n * (n - 1.0));
}

// Of one window at one frame, into the k-th horizon.
void ScoreFrame(const std::vector<SampledFuture>& samples, const ForecastWindow& window,
                const ParticleLayout& layout, size_t k, SpreadScores* scores) {
  const int frame = kHorizonFrames[k];
  const Eigen::VectorXf truth = window.future.col(frame);
  const double n = static_cast<double>(samples.size());
  double covered = 0.0, crps = 0.0, from_truth = 0.0, among = 0.0, best = HUGE_VAL;
  std::vector<double> values(samples.size());
  for (Eigen::Index c = 0; c < truth.size(); ++c) {
    for (size_t i = 0; i < samples.size(); ++i) values[i] = samples[i].motion(c, frame);
    ScoreCoordinate(truth(c), &values, &covered, &crps);
  }
  for (size_t i = 0; i < samples.size(); ++i) {
    const auto pose = samples[i].motion.col(frame);
    from_truth += (pose - truth).norm();
    for (size_t j = 0; j < i; ++j) among += (pose - samples[j].motion.col(frame)).norm();
    best = std::min<double>(best, MeanDistance(pose, truth, layout)(0));
  }
  scores->coverage[k] += covered / static_cast<double>(truth.size());
  scores->crps[k] += crps / static_cast<double>(truth.size());
  scores->energy[k] += from_truth / n - among / (n * (n - 1.0));
  scores->best[k] += best;
  const auto less = [](const SampledFuture& a, const SampledFuture& b) {
    return a.log_likelihood < b.log_likelihood;
  };
  const auto probable = std::max_element(samples.begin(), samples.end(), less);
  scores->probable[k] += MeanDistance(probable->motion.col(frame), truth, layout)(0);
}

void AddTo(const SpreadScores& scores, double share, SpreadScores* sum) {
  for (const SpreadRow& row : kSpreadRows) {
    for (size_t k = 0; k < kHorizonFrames.size(); ++k) {
      (sum->*row.values)[k] += share * (scores.*row.values)[k];
    }
  }
}

nlohmann::ordered_json ByHorizon(const HorizonErrors& values, double unit) {
  nlohmann::ordered_json json;
  for (size_t k = 0; k < kHorizonFrames.size(); ++k) {
    json[std::to_string(HorizonMs(kHorizonFrames[k]))] = unit * values[k];
  }
  return json;
}

constexpr Metric kMpjpeMm = {"MPJPE", "mm"};

}  // namespace

double SampleQuantile(const std::vector<double>& sorted, double p) {
  const double last = static_cast<double>(sorted.size()) - 1.0;
  const double place = std::clamp(p * (static_cast<double>(sorted.size()) + 1.0) - 1.0, 0.0, last);
  const size_t below = static_cast<size_t>(place);
  const size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

ForecastSpread SpreadOf(const std::vector<ForecastWindow>& windows,
                        const std::vector<std::vector<SampledFuture>>& samples,
                        const ParticleLayout& layout) {
  ForecastSpread spread;
  std::map<std::string, int> count;
  for (const ForecastWindow& window : windows) ++count[window.action];
  for (size_t i = 0; i < windows.size(); ++i) {
    SpreadScores scores;
    for (size_t k = 0; k < kHorizonFrames.size(); ++k) {
      ScoreFrame(samples[i], windows[i], layout, k, &scores);
    }
    const std::string& action = windows[i].action;
    AddTo(scores, 1.0 / count[action], &spread.actions[action]);
  }
  for (const auto& [name, scores] : spread.actions) {
    AddTo(scores, 1.0 / static_cast<double>(spread.actions.size()), &spread.mean);
  }
  return spread;
}

void AddSpreadJson(const ForecastSpread& spread, nlohmann::ordered_json* json) {
  const auto add = [](const SpreadScores& scores, nlohmann::ordered_json* to) {
    for (const SpreadRow& row : kSpreadRows) {
      (*to)[row.key] = ByHorizon(scores.*row.values, row.unit);
    }
  };
  add(spread.mean, &(*json)["mean"]);
  for (const auto& [name, scores] : spread.actions) add(scores, &(*json)["actions"][name]);
}

std::string ForecastSpreadText(const ForecastSpread& spread) {
  std::vector<std::string> head = {"sampled futures", "of"};
  for (int frame : kHorizonFrames) head.push_back(std::to_string(HorizonMs(frame)) + " ms");
  std::vector<bool> left(head.size(), false);
  left[0] = left[1] = true;
  TextTable table(head, left);
  const auto add = [&table](const SpreadRow& row, const std::string& name,
                            const SpreadScores& scores) {
    std::vector<std::string> cells = {row.title, name};
    for (double value : scores.*row.values) cells.push_back(Rounded(row.unit * value, 3));
    table.Add(cells);
  };
  for (const auto& [name, scores] : spread.actions) add(kSpreadRows[0], name, scores);
  for (const SpreadRow& row : kSpreadRows) add(row, "mean of actions", spread.mean);
  return table.ToString();
}

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
                                  {kMpjpeMm.Key(), ByHorizon(action.mpjpe, kMillimetres)}};
  };
  nlohmann::ordered_json json;
  json["mean"] = of(errors.mean);
  for (const auto& [name, action] : errors.actions) json["actions"][name] = of(action);
  return json;
}

std::string ForecastErrorsText(const ForecastErrors& errors) {
  std::vector<std::string> head = {kMpjpeMm.Title(), "windows"};
  for (int frame : kHorizonFrames) head.push_back(std::to_string(HorizonMs(frame)) + " ms");
  TextTable table = TextTable::OfNumbers(head);
  const auto add = [&table](const std::string& name, const ActionErrors& action) {
    std::vector<std::string> row = {name, std::to_string(action.windows)};
    for (double error : action.mpjpe) row.push_back(Rounded(kMillimetres * error, 4));
    table.Add(row);
  };
  for (const auto& [name, action] : errors.actions) add(name, action);
  add("mean of actions", errors.mean);
  return table.ToString();
}

Result<PathChoice> MostProbablePath(const std::vector<SampledFuture>& futures,
                                    const Eigen::VectorXf& target, double distance,
                                    const ParticleLayout& layout) {
  PathChoice choice;
  double nearest = HUGE_VAL;
  for (size_t i = 0; i < futures.size(); ++i) {
    const double away = MeanDistance(futures[i].motion.rightCols(1), target, layout)(0);
    nearest = std::min(nearest, away);
    if (away > distance) continue;
    ++choice.near;
    if (choice.near > 1 && futures[i].log_likelihood <= choice.log_likelihood) continue;
    choice.future = static_cast<int>(i);
    choice.distance = away;
    choice.log_likelihood = futures[i].log_likelihood;
  }
  if (choice.near > 0) return choice;
  return Error{"none of " + std::to_string(futures.size()) + " sampled futures ends within " +
               Rounded(distance, 3) + " m of the target; the nearest is " + Rounded(nearest, 3) +
               " m away: raise --samples"};
}

}  // namespace pushid
