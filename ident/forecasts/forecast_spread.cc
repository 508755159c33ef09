// ident: scores of forecasts and of sampled futures.
#include "ident/forecasts/forecast_spread.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/files/number_text.h"
#include "datasets/formats/units.h"
#include "ident/figures/text_table.h"
#include "ident/problem/statistics.h"

namespace pushid {
namespace {

struct ScoreRow {
  const char* key;
  const char* title;
  HorizonErrors WindowScores::*values;
  double unit;
};

// The first row is that of forecasts, the others are of sampled futures.
constexpr ScoreRow kScoreRows[] = {
    {"MPJPE_mm", "MPJPE mm", &WindowScores::mpjpe, kMillimetres},
    {"coverage_90", "coverage of 90 %", &WindowScores::coverage, 1.0},
    {"CRPS_mm", "CRPS mm", &WindowScores::crps, kMillimetres},
    {"energy_score_mm", "energy score mm", &WindowScores::energy, kMillimetres},
    {"most_probable_MPJPE_mm", "most probable of n, MPJPE mm", &WindowScores::probable,
     kMillimetres},
    {"best_of_n_MPJPE_mm", "best of n, MPJPE mm", &WindowScores::best, kMillimetres},
};
constexpr size_t kHorizons = kHorizonFrames.size();

// Scores one window at the k-th horizon.
void ScoreSamples(const std::vector<SampledFuture>& samples, const ForecastWindow& window,
                  const ParticleLayout& layout, size_t k, WindowScores* scores) {
  const int frame = kHorizonFrames[k];
  const Eigen::VectorXf truth = window.future.col(frame);
  const double share = 1.0 / static_cast<double>(truth.size());
  std::vector<double> values(samples.size());
  for (Eigen::Index c = 0; c < truth.size(); ++c) {
    for (size_t i = 0; i < samples.size(); ++i) values[i] = samples[i].motion(c, frame);
    scores->coverage[k] += Within(values, truth(c), 0.9) ? share : 0.0;
    scores->crps[k] += share * Crps(values, truth(c));
  }
  std::vector<Eigen::VectorXf> poses;
  double best = HUGE_VAL;
  for (const SampledFuture& sample : samples) {
    poses.emplace_back(sample.motion.col(frame));
    best = std::min<double>(best, MeanDistance(poses.back(), truth, layout)(0));
  }
  scores->energy[k] = EnergyScore(poses, truth);
  scores->best[k] = best;
  const auto less = [](const SampledFuture& a, const SampledFuture& b) {
    return a.log_likelihood < b.log_likelihood;
  };
  const auto probable = std::max_element(samples.begin(), samples.end(), less);
  scores->probable[k] = MeanDistance(probable->motion.col(frame), truth, layout)(0);
}

void AddTo(const WindowScores& scores, double share, WindowScores* sum) {
  sum->windows += scores.windows;
  for (const ScoreRow& row : kScoreRows) {
    for (size_t k = 0; k < kHorizons; ++k) (sum->*row.values)[k] += share * (scores.*row.values)[k];
  }
}

}  // namespace

ForecastScores ScoresOf(const std::vector<ForecastWindow>& windows,
                        const std::vector<Trajectories>& forecasts, const ParticleLayout& layout,
                        const std::vector<std::vector<SampledFuture>>& samples) {
  ForecastScores all;
  all.sampled = !samples.empty();
  std::map<std::string, int> count;
  for (const ForecastWindow& window : windows) ++count[window.action];
  for (size_t i = 0; i < windows.size(); ++i) {
    const Eigen::VectorXf distance = MeanDistance(forecasts[i], windows[i].future, layout);
    WindowScores scores;
    scores.windows = 1;
    for (size_t k = 0; k < kHorizons; ++k) {
      scores.mpjpe[k] = distance(kHorizonFrames[k]);
      if (all.sampled) ScoreSamples(samples[i], windows[i], layout, k, &scores);
    }
    const std::string& action = windows[i].action;
    AddTo(scores, 1.0 / count[action], &all.actions[action]);
  }
  for (const auto& [name, scores] : all.actions) {
    AddTo(scores, 1.0 / static_cast<double>(all.actions.size()), &all.mean);
  }
  return all;
}

std::vector<Trajectories> ZeroVelocity(const std::vector<ForecastWindow>& windows) {
  std::vector<Trajectories> forecasts;
  for (const ForecastWindow& window : windows) {
    forecasts.push_back(window.observed.rightCols(1).replicate(1, window.future.cols()));
  }
  return forecasts;
}

nlohmann::ordered_json ToJson(const ForecastScores& all) {
  const auto of = [&all](const WindowScores& scores) {
    nlohmann::ordered_json json = {{"windows", scores.windows}};
    for (const ScoreRow& row : kScoreRows) {
      for (size_t k = 0; k < kHorizons; ++k) {
        json[row.key][std::to_string(HorizonMs(kHorizonFrames[k]))] =
            row.unit * (scores.*row.values)[k];
      }
      if (!all.sampled) break;
    }
    return json;
  };
  nlohmann::ordered_json json;
  json["mean"] = of(all.mean);
  for (const auto& [name, scores] : all.actions) json["actions"][name] = of(scores);
  return json;
}

std::string ForecastScoresText(const ForecastScores& all) {
  const auto table = [](const char* first, const char* second) {
    std::vector<std::string> head = {first, second};
    for (int frame : kHorizonFrames) head.push_back(std::to_string(HorizonMs(frame)) + " ms");
    return TextTable::OfNumbers(head);
  };
  const auto add = [](const std::string& first, const std::string& second, const ScoreRow& row,
                      const WindowScores& scores, TextTable* to) {
    std::vector<std::string> cells = {first, second};
    for (double v : scores.*row.values) cells.push_back(Rounded(row.unit * v, 4));
    to->Add(cells);
  };
  const char* const mean = "mean of actions";
  TextTable errors = table(kScoreRows[0].title, "windows");
  for (const auto& [name, scores] : all.actions) {
    add(name, std::to_string(scores.windows), kScoreRows[0], scores, &errors);
  }
  add(mean, std::to_string(all.mean.windows), kScoreRows[0], all.mean, &errors);
  if (!all.sampled) return errors.ToString();
  TextTable futures = table("sampled futures", "of");
  for (const auto& [name, scores] : all.actions) {
    add(kScoreRows[1].title, name, kScoreRows[1], scores, &futures);
  }
  for (size_t i = 1; i < std::size(kScoreRows); ++i) {
    add(kScoreRows[i].title, mean, kScoreRows[i], all.mean, &futures);
  }
  return errors.ToString() + "\n" + futures.ToString();
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
