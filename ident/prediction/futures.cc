// ident: draws, proper scores of them, and words.
#include "ident/prediction/futures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "datasets/files/number_text.h"
#include "datasets/files/random.h"
#include "ident/figures/text_table.h"
#include "ident/fit/step_probability.h"
#include "ident/model/model_rollout.h"
#include "ident/prediction/predicted_steps.h"
#include "ident/problem/own_axes.h"
#include "ident/uncertainty/bootstrap.h"
#include "models/rollout.h"
#include "residuals/cost_functions/likelihood_residual.h"

namespace pushid {
namespace {

// Rows of BandPoint that are scored: hip x, hip y, theta, phi.
constexpr int kScored[] = {0, 1, 3, 4};

bool Within(const std::vector<double>& draws, double value, double share) {
  const double outside = 0.5 * (1.0 - share);
  return Quantile(draws, outside) <= value && value <= Quantile(draws, 1.0 - outside);
}

double Energy(const std::vector<Eigen::Vector2d>& draws, const Eigen::Vector2d& value) {
  double to_value = 0.0, apart = 0.0;
  for (size_t i = 0; i < draws.size(); ++i) {
    to_value += (draws[i] - value).norm();
    for (size_t j = 0; j < i; ++j) apart += (draws[i] - draws[j]).norm();
  }
  const double n = static_cast<double>(draws.size());
  return to_value / n - apart / (n * (n - 1.0));
}

bool StepsAreSpread(const IdentifiedModel& model) {
  return model.options.stance == Stance::kSteps && model.step_probability &&
         model.step_probability->coefficients[1] > 0.0;
}

// A person steps if the support is smaller than f b, which has the probability At(margin).
void DrawSupport(const StepProbability& p, Random* random, ParameterSet<double>* own) {
  const double u = random->Unit();
  const double margin = (std::log(u / (1.0 - u)) - p.coefficients[0]) / p.coefficients[1];
  const double factor = FactorAtMargin((*own)[kSupportFront], margin);
  for (Parameter id : {kSupportFront, kSupportBack, kSupportSide}) (*own)[id] *= factor;
}

// By the drawn parameters until a foot leaves the ground, then by the person's own: what is drawn
// is whether there is a first step, and who went on with a support of millimetres would march.
RolloutStatus RollDrawn(const Scene& scene, const ModelOptions& options,
                        std::vector<ParameterSet<double>> now,
                        const std::vector<ParameterSet<double>>& own,
                        const FrameTable<Vector4<double>>* noise, RolloutPath<double>* path) {
  SceneForces<double> forces(scene, options, now);
  StartPath(scene, InitialVelocities(scene), path);
  for (int t = 0; t + 1 < path->num_frames(); ++t) {
    const RolloutStatus status = StepOn<double>(scene, &forces, t, path, nullptr, noise);
    if (!status.ok) return status;
    for (int n = 0; n < scene.num_people(); ++n) {
      if (path->At(t + 1, n).feet.swings != 0) now[n] = own[n];
    }
  }
  return {};
}

}  // namespace

double Crps(std::vector<double> draws, double value) {
  std::sort(draws.begin(), draws.end());
  const double n = static_cast<double>(draws.size());
  double to_value = 0.0, apart = 0.0;
  for (size_t i = 0; i < draws.size(); ++i) {
    to_value += std::abs(draws[i] - value);
    apart += draws[i] * (2.0 * static_cast<double>(i) + 1.0 - n);  // sum over pairs, sorted
  }
  return to_value / n - apart / (n * (n - 1.0));
}

uint64_t SeedOfRecording(uint64_t seed, int recording) {
  return seed * 1000003u + static_cast<uint64_t>(recording);
}

MaybeError CheckDrawsFrom(const IdentifiedModel& model) {
  if (model.options.process_noise != ProcessNoise::kNone || StepsAreSpread(model))
    return std::nullopt;
  return Error{(model.source.empty() ? "the model" : model.source) +
               " has no process noise to draw futures from; fit it with "
               "--likelihood=innovation, or, where it is known who "
               "steps, with --stance=steps"};
}

Result<Futures> DrawFutures(const IdentifiedModel& model, const PendulumRecording& recording,
                            int draws, uint64_t seed, int num_frames) {
  if (MaybeError error = CheckDrawsFrom(model)) return *error;
  const int frames = num_frames > 0 ? num_frames : recording.num_frames();
  const Scene& scene = recording.scene;
  const std::vector<ParameterSet<double>> parameters = PeoplesParameters(model, recording);
  Futures futures;
  futures.id = recording.id;
  Random random(seed);
  const bool noisy = model.options.process_noise != ProcessNoise::kNone,
             spread = StepsAreSpread(model);
  for (int draw = 0; draw < draws; ++draw) {
    std::vector<ParameterSet<double>> drawn = parameters;
    for (size_t n = 0; spread && n < drawn.size(); ++n) {
      DrawSupport(*model.step_probability, &random, &drawn[n]);
    }
    FrameTable<Vector4<double>> noise(frames, scene.num_people());
    for (int t = 0; noisy && t < frames; ++t) {
      for (int n = 0; n < scene.num_people(); ++n) {
        for (double& w : noise.At(t, n)) w = random.Normal();
      }
    }
    RolloutPath<double> path(frames, scene.num_people());
    const auto roll = [&](const Scene& turned) {
      return RollDrawn(turned, model.options, drawn, parameters, noisy ? &noise : nullptr, &path);
    };
    if (!RollInOwnAxes(recording, model.options, roll, frames, &path).ok) {
      ++futures.failed;
      continue;
    }
    std::vector<std::vector<BandPoint>> people(scene.num_people());
    if (spread) futures.steps.emplace_back();
    for (int n = 0; n < scene.num_people(); ++n) {
      for (int t = 0; t < frames; ++t) {
        const PendulumState<double>& state = path.At(t, n);
        BandPoint point;
        point << HipPosition(scene.people[n].body, state.q), state.q.tail<2>();
        people[n].push_back(point);
      }
      if (spread) {
        futures.steps.back().push_back(static_cast<int>(PredictedSteps(path, n).size()));
      }
    }
    futures.paths.push_back(std::move(people));
  }
  return futures;
}

std::vector<double> FuturesScore::Values() const {
  std::vector<double> values;
  for (const FuturesMetric& metric : kFuturesMetrics) values.push_back(metric.value(*this));
  return values;
}

FuturesScore ScoreFutures(const IdentifiedModel& model, const PendulumRecording& recording,
                          const Futures& futures) {
  FuturesScore score;
  const int people = recording.num_people();
  double counted = 0.0;
  for (int n = 0; n < people; ++n) {
    for (int t = 1; t < recording.num_frames(); ++t) counted += recording.Weight(n, t) > 0.0;
  }
  const double share = 1.0 / std::max(1.0, counted);
  std::vector<double> values(futures.paths.size());
  std::vector<Eigen::Vector2d> places(futures.paths.size());
  for (int n = 0; n < people; ++n) {
    for (int t = 1; t < recording.num_frames(); ++t) {
      if (recording.Weight(n, t) <= 0.0) continue;
      BandPoint measured;
      measured << recording.hip[n][t], recording.states[n][t].q.tail<2>();
      for (int i = 0; i < 4; ++i) {
        const int row = kScored[i];
        for (size_t d = 0; d < values.size(); ++d) values[d] = futures.paths[d][n][t][row];
        score.inside50[i] += share * Within(values, measured[row], 0.5);
        score.inside90[i] += share * Within(values, measured[row], 0.9);
        score.crps[i] += share * Crps(values, measured[row]);
      }
      for (size_t d = 0; d < places.size(); ++d) places[d] = futures.paths[d][n][t].head<2>();
      score.energy += share * Energy(places, measured.head<2>());
    }
  }
  score.deviance = std::numeric_limits<double>::quiet_NaN();
  if (model.options.process_noise == ProcessNoise::kNone) return score;
  ParameterMap map;
  map.pool_by = model.pool_by;
  const Deviance deviance =
      DevianceOf(MakeLikelihoodProblem(Likelihood::kInnovation, recording, model.options, map, 1.0),
                 PeoplesParameters(model, recording));
  score.deviance = deviance.value / std::max(1, deviance.measured);
  return score;
}

FuturesSummary SummarizeFutures(const std::string& name,
                                const std::vector<PendulumRecording>& recordings,
                                const std::vector<std::vector<double>>& values, int draws,
                                int failed) {
  FuturesSummary summary;
  summary.name = name;
  summary.recordings = static_cast<int>(values.size());
  summary.draws = draws;
  summary.failed = failed;
  const ScoreClusters clusters = ClustersOf(recordings);
  summary.clusters = ClustersText(clusters.by, clusters.count);
  for (size_t k = 0; k < std::size(kFuturesMetrics); ++k) {
    std::vector<double> column;
    for (const std::vector<double>& of_recording : values) column.push_back(of_recording[k]);
    summary.mean.push_back(clusters.Mean(column));
  }
  return summary;
}

Result<FuturesSummary> EvaluateFutures(const IdentifiedModel& model,
                                       const std::vector<PendulumRecording>& recordings, int draws,
                                       uint64_t seed) {
  std::vector<PendulumRecording> scored;
  std::vector<std::vector<double>> values;
  int failed = 0;
  for (size_t i = 0; i < recordings.size(); ++i) {
    const PendulumRecording& recording = recordings[i];
    const Result<Futures> futures =
        DrawFutures(model, recording, draws, SeedOfRecording(seed, static_cast<int>(i)));
    if (!futures.ok()) return futures.error();
    failed += futures.value().failed;
    if (futures.value().paths.size() < 2) continue;
    scored.push_back(recording);
    values.push_back(ScoreFutures(model, recording, futures.value()).Values());
  }
  if (values.empty()) return Error{"every drawn future leaves the model's domain"};
  FuturesSummary summary = SummarizeFutures("", scored, values, draws, failed);
  summary.without = static_cast<int>(recordings.size() - scored.size());
  return summary;
}

namespace {

// "0: 0.05, 1: 0.62, 2: 0.33"
std::string StepShares(const Futures& futures, size_t person) {
  std::map<int, int> counts;
  for (const std::vector<int>& draw : futures.steps) ++counts[draw[person]];
  std::string text;
  for (const auto& [steps, count] : counts) {
    text += (text.empty() ? "" : ", ") + std::to_string(steps) + ": " +
            Rounded(count / static_cast<double>(futures.steps.size()), 2);
  }
  return text;
}

}  // namespace

std::string LastFrameText(const Futures& futures) {
  std::vector<std::string> titles = {"person", "x m", "5 %", "95 %", "y m", "5 %", "95 %"};
  std::vector<bool> left(titles.size(), false);
  if (!futures.steps.empty()) titles.push_back("steps: share"), left.push_back(true);
  TextTable table(titles, left);
  if (futures.paths.empty()) return "";
  for (size_t n = 0; n < futures.paths[0].size(); ++n) {
    std::vector<std::string> row = {std::to_string(n)};
    for (int axis : {0, 1}) {
      std::vector<double> values;
      for (const auto& draw : futures.paths) values.push_back(draw[n].back()[axis]);
      for (double share : {0.5, 0.05, 0.95}) row.push_back(Rounded(Quantile(values, share), 3));
    }
    if (!futures.steps.empty()) row.push_back(StepShares(futures, n));
    table.Add(row);
  }
  return table.ToString();
}

std::string FuturesText(const std::vector<FuturesSummary>& summaries) {
  std::vector<std::string> titles = {"drawn futures"};
  std::vector<bool> left = {true};
  for (const FuturesSummary& summary : summaries) {
    titles.push_back(summary.name);
    titles.push_back("+-");
    left.insert(left.end(), 2, false);
  }
  TextTable table(titles, left);
  for (size_t i = 0; i < std::size(kFuturesMetrics); ++i) {
    const bool known = std::any_of(
        summaries.begin(), summaries.end(),
        [i](const FuturesSummary& summary) { return !std::isnan(summary.mean[i].mean); });
    if (!known) continue;  // the deviance of who draws nothing but supports
    std::vector<std::string> row = {kFuturesMetrics[i].Title()};
    for (const FuturesSummary& summary : summaries) {
      row.push_back(Rounded(summary.mean[i].mean, 3));
      row.push_back(Rounded(summary.mean[i].error, 2));
    }
    table.Add(row);
  }
  std::string text = table.ToString();
  for (const FuturesSummary& summary : summaries) {
    text += (summary.name.empty() ? "" : summary.name + ": ") + std::to_string(summary.draws) +
            " draws for each of " + std::to_string(summary.recordings) + " recordings, errors by " +
            summary.clusters;
    if (summary.failed > 0) {
      text += "; " + std::to_string(summary.failed) + " draws left the model's domain";
    }
    if (summary.without > 0) {
      text += "; " + std::to_string(summary.without) +
              " recordings have fewer than two draws that stay in it, and are left out";
    }
    text += "\n";
  }
  return text +
         "inside: share of frames within the central 50 or 90 %; crps, energy: the less the "
         "better;\ndeviance: -2 log innovation likelihood of one measured number\n";
}

}  // namespace pushid
