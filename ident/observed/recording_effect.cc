// ident: spread and error scale by expectation maximization.

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "ident/observed/recording_filter.h"
#include "ident/problem/parallel.h"
#include "ident/uncertainty/clusters.h"

namespace pushid {
namespace {

constexpr double kFirstSpread = 0.5;
constexpr double kLeastSpread = 1e-3;  // less than this is none: all weight is on b = 0
constexpr int kMostPopulationRounds = 500;
constexpr double kSettledRound = 1e-7;

// Of one recording, all of whose frames were seen.
struct Misfits {
  std::vector<double> of_node;
  int residuals = 0;
  bool acts = false;
  double unit = 1.0;  // g
};

struct Population {
  double spread = 0.0, scale = 0.0;
};

double Least(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

// Those of `left_out` do not count. first_spread: where the rounds begin.
Population MostLikelyPopulation(const std::vector<Misfits>& recordings,
                                const std::vector<int>& cluster, int left_out = -1,
                                double first_spread = kFirstSpread) {
  double squares = 0.0, residuals = 0.0;
  int acting = 0;
  for (size_t i = 0; i < recordings.size(); ++i) {
    if (cluster[i] == left_out) continue;
    squares += Least(recordings[i].of_node);
    residuals += recordings[i].residuals;
    acting += recordings[i].acts;
  }
  Population p{acting > 0 ? first_spread : 0.0, std::sqrt(squares / residuals)};
  for (int round = 0; round < kMostPopulationRounds && acting > 0; ++round) {
    double spread = 0.0;
    squares = 0.0;
    for (size_t i = 0; i < recordings.size(); ++i) {
      if (cluster[i] == left_out) continue;
      const Misfits& m = recordings[i];
      if (!m.acts) {
        squares += m.of_node[0];
        continue;
      }
      const std::vector<double> weights = EffectWeights(m.of_node, p.spread, p.scale);
      for (int j = 0; j < kEffectNodes; ++j) {
        if (weights[j] == 0.0) continue;  // also where the misfit is infinite
        spread += weights[j] * EffectNode(j) * EffectNode(j);
        squares += weights[j] * m.of_node[j];
      }
    }
    const Population next{std::sqrt(spread / acting), std::sqrt(squares / residuals)};
    const bool settled = std::abs(next.spread - p.spread) < kSettledRound;
    p = next;
    if (settled) break;
  }
  return p;
}

// Leaving out one cluster after the other.
double JackknifeError(const std::vector<Misfits>& recordings, const std::vector<int>& cluster,
                      int clusters, double spread_of_all) {
  if (clusters < 2) return 0.0;
  // Nearby; but from none at all the rounds do not get away.
  const double first = std::max(spread_of_all, EffectNode(1) - EffectNode(0));
  std::vector<double> spreads;
  double mean = 0.0, squares = 0.0;
  for (int g = 0; g < clusters; ++g) {
    spreads.push_back(MostLikelyPopulation(recordings, cluster, g, first).spread);
    mean += spreads.back() / clusters;
  }
  for (double spread : spreads) squares += (spread - mean) * (spread - mean);
  return std::sqrt(squares * (clusters - 1.0) / clusters);
}

// By person, or by recording where one person alone was pushed.
std::vector<int> ClustersOfPeople(const std::vector<std::string>& people, int* count) {
  std::vector<int> clusters;
  std::map<std::string, int> index;
  for (const std::string& person : people) {
    clusters.push_back(index.emplace(person, static_cast<int>(index.size())).first->second);
  }
  *count = static_cast<int>(index.size());
  if (*count > 1) return clusters;
  std::iota(clusters.begin(), clusters.end(), 0);
  *count = static_cast<int>(people.size());
  return clusters;
}

// Of the recording alone: the node of least misfit, and from there to the bottom of the parabola
// through its neighbours.
double LikeliestEffect(const std::vector<double>& misfit) {
  const int node =
      static_cast<int>(std::min_element(misfit.begin(), misfit.end()) - misfit.begin());
  if (node == 0 || node + 1 == kEffectNodes) return EffectNode(node);
  const double left = misfit[node - 1], here = misfit[node], right = misfit[node + 1];
  const double bend = left - 2.0 * here + right;
  const double spacing = EffectNode(1) - EffectNode(0);
  const bool known = std::isfinite(bend) && bend > 0.0;
  return EffectNode(node) + (known ? 0.5 * spacing * (left - right) / bend : 0.0);
}

}  // namespace

std::vector<double> EffectWeights(const std::vector<double>& misfit, double spread,
                                  double error_scale) {
  std::vector<double> weights(misfit.size());
  const double precision = 1.0 / (std::max(spread, kLeastSpread) * std::max(spread, kLeastSpread));
  const double inverse_variance = 1.0 / (error_scale * error_scale);
  for (size_t j = 0; j < misfit.size(); ++j) {
    const double b = EffectNode(static_cast<int>(j));
    weights[j] = -0.5 * (precision * b * b + misfit[j] * inverse_variance);
  }
  const double most = *std::max_element(weights.begin(), weights.end());
  double sum = 0.0;
  constexpr double kNothing = -40.0;  // its exponential is below the rounding of 1
  for (double& weight : weights) {
    sum += weight = weight - most > kNothing ? std::exp(weight - most) : 0.0;
  }
  for (double& weight : weights) weight *= 1.0 / sum;
  return weights;
}

EffectEstimate MeanEffect(const std::vector<double>& weights) {
  EffectEstimate estimate;
  for (int j = 0; j < kEffectNodes; ++j) estimate.mean += weights[j] * EffectNode(j);
  double variance = 0.0;
  for (int j = 0; j < kEffectNodes; ++j) {
    const double off = EffectNode(j) - estimate.mean;
    variance += weights[j] * off * off;
  }
  estimate.error = std::sqrt(variance);
  return estimate;
}

bool EffectActs(const ModelOptions& model, const PendulumRecording& recording) {
  return model.push_tail != PushTail::kNone && recording.scene.num_people() == 1 &&
         std::any_of(recording.scene.pushes.begin(), recording.scene.pushes.end(),
                     [](const ScenePush& push) {
                       return push.kind != PushKind::kExternal && !push.force.empty();
                     });
}

namespace {

double MeanSquare(const PendulumRecording& recording, const HipPaths& hips) {
  double sum = 0.0, frames = 0.0;
  for (size_t n = 0; n < hips.size(); ++n) {
    for (size_t t = 1; t < hips[n].size(); ++t, ++frames) {
      sum += (recording.hip[n][t] - hips[n][t]).squaredNorm();
    }
  }
  return frames > 0.0 ? sum / frames : 0.0;
}

// What the recording's own effect leaves of the squared error, over that without; each over g^2.
struct Squares {
  double left = 0.0, without = 0.0;
};
Squares SquaresOf(const IdentifiedModel& model, const PendulumRecording& recording, double effect,
                  double unit) {
  const auto hips = HipsOfRollouts(model, recording, {effect, 0.0}, recording.num_frames());
  return {MeanSquare(recording, hips[0]) / (unit * unit),
          MeanSquare(recording, hips[1]) / (unit * unit)};
}

}  // namespace

std::optional<RecordingEffect> FitRecordingEffect(const IdentifiedModel& model,
                                                  const std::vector<PendulumRecording>& recordings,
                                                  int num_threads) {
  if (model.options.push_tail == PushTail::kNone) return std::nullopt;
  const int total = static_cast<int>(recordings.size());
  std::vector<Misfits> all(total);
  ParallelFor(total, num_threads, [&](int i) {
    const PendulumRecording& recording = recordings[i];
    RecordingFilter filter(model, recording, recording.num_frames());
    if (!filter.ok()) return;
    for (int t = 1; t < recording.num_frames(); ++t) filter.Observe(HipsAt(recording, t));
    all[i] = {filter.misfit(), filter.residuals(), filter.acts(), filter.error_unit()};
  });
  std::vector<const PendulumRecording*> kept;
  std::vector<Misfits> misfits;
  std::vector<std::string> people;
  for (int i = 0; i < total; ++i) {
    if (all[i].residuals == 0) continue;
    people.push_back(recordings[i].subject_ids[recordings[i].pushed_person]);
    kept.push_back(&recordings[i]);
    misfits.push_back(std::move(all[i]));
  }
  if (kept.empty()) return std::nullopt;
  RecordingEffect effect;
  const std::vector<int> cluster = ClustersOfPeople(people, &effect.clusters);
  const Population p = MostLikelyPopulation(misfits, cluster);
  effect.spread = p.spread;
  effect.error_scale = p.scale;
  if (p.spread > 0.0)
    effect.spread_error = JackknifeError(misfits, cluster, effect.clusters, p.spread);
  Squares sum;
  for (size_t i = 0; i < kept.size(); ++i) {
    if (!misfits[i].acts) continue;
    const PendulumRecording& r = *kept[i];
    const EffectEstimate b = MeanEffect(EffectWeights(misfits[i].of_node, p.spread, p.scale));
    effect.recordings.push_back({r.id, r.subject_ids[r.pushed_person], r.labels.condition(), b.mean,
                                 b.error, LikeliestEffect(misfits[i].of_node)});
    const Squares squares = SquaresOf(model, r, b.mean, misfits[i].unit);
    sum.left += squares.left;
    sum.without += squares.without;
  }
  effect.explained = sum.without > 0.0 ? 1.0 - sum.left / sum.without : 0.0;
  return effect;
}

}  // namespace pushid
