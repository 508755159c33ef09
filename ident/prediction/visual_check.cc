// ident: percentiles of recorded and simulated motions, and their probability integral transform.
#include "ident/prediction/visual_check.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <unsupported/Eigen/SpecialFunctions>

#include "datasets/files/random.h"
#include "ident/model/push_range.h"
#include "ident/prediction/online_predictor.h"
#include "ident/uncertainty/bootstrap.h"
#include "models/decompositions.h"

namespace pushid {
namespace {

constexpr int kBins = 5;
constexpr int kReplicas = 200;
constexpr size_t kFewest = 3, kFewestForAll = 10;     // recordings
constexpr double kSpacing = 0.05;                     // s, of the percentiles
constexpr double kPitSpacing = 0.25, kLastPit = 1.0;  // s

double NormalCdf(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

// One recording as far as it is looked at.
struct Checked {
  const PendulumRecording* recording = nullptr;
  double speed = 1.0;
  std::vector<double> observed;              // along the push over the speed, from frame 1 on
  std::vector<std::vector<double>> replica;  // the same of each simulated recording
};

int Spaced(double seconds, double dt) {
  return std::max(1, static_cast<int>(std::lround(seconds / dt)));
}

Checked Check(const IdentifiedModel& model, const PendulumRecording& recording,
              const RecordingFilter& filter, Random* random) {
  Checked checked;
  checked.recording = &recording;
  const int person = recording.pushed_person;
  checked.speed = std::max(1e-3, PushSpeed(recording));
  const Vector3<double> along = filter.Axes().col(0);
  const double start = along.dot(recording.hip[person][0]);
  for (int t = 1; t < recording.num_frames(); ++t) {
    checked.observed.push_back((along.dot(recording.hip[person][t]) - start) / checked.speed);
  }
  std::vector<double> weights;
  const auto mixture = filter.Mixture(*model.recording_effect, &weights);
  for (int r = 0; r < kReplicas; ++r) {
    double left = random->Unit();
    size_t node = 0;
    while (node + 1 < weights.size() && left > weights[node]) left -= weights[node++];
    const double z = random->Normal();
    std::vector<double> path;
    for (const MixturePoint& point : mixture[person]) {
      path.push_back((point.mean[node][0] + z * point.deviation[0] - start) / checked.speed);
    }
    checked.replica.push_back(std::move(path));
  }
  return checked;
}

CheckedFrame FrameOf(const std::vector<const Checked*>& stratum, int t, double dt) {
  CheckedFrame frame;
  frame.seconds = t * dt;
  std::vector<const Checked*> last_so_long;
  for (const Checked* c : stratum) {
    if (t <= static_cast<int>(c->observed.size())) last_so_long.push_back(c);
  }
  frame.recordings = static_cast<int>(last_so_long.size());
  if (last_so_long.size() < kFewest) return frame;
  std::vector<double> values;
  for (const Checked* c : last_so_long) values.push_back(c->observed[t - 1]);
  for (int q = 0; q < kNumCheckedShares; ++q) {
    frame.observed[q] = Quantile(values, kCheckedShares[q]);
    std::vector<double> simulated;
    for (int r = 0; r < kReplicas; ++r) {
      for (size_t i = 0; i < last_so_long.size(); ++i) {
        values[i] = last_so_long[i]->replica[r][t - 1];
      }
      simulated.push_back(Quantile(values, kCheckedShares[q]));
    }
    for (size_t i = 0; i < last_so_long.size(); ++i) values[i] = last_so_long[i]->observed[t - 1];
    frame.lower90[q] = Quantile(simulated, 0.05);
    frame.upper90[q] = Quantile(simulated, 0.95);
  }
  return frame;
}

std::vector<CheckedStratum> Strata(const std::vector<Checked>& all) {
  std::map<std::string, std::vector<const Checked*>> groups;
  for (const Checked& c : all) {
    const PendulumRecording& r = *c.recording;
    if (!r.labels.condition().empty()) groups["condition " + r.labels.condition()].push_back(&c);
    if (!r.labels.magnitude().empty()) groups["strength " + r.labels.magnitude()].push_back(&c);
  }
  std::vector<CheckedStratum> strata;
  for (const auto& [name, group] : groups) {
    if (group.size() < kFewest) continue;
    CheckedStratum stratum{name, static_cast<int>(group.size()), {}};
    const double dt = group[0]->recording->scene.dt;
    for (int t = Spaced(kSpacing, dt);; t += Spaced(kSpacing, dt)) {
      const CheckedFrame frame = FrameOf(group, t, dt);
      if (frame.recordings < static_cast<int>(kFewest)) break;
      stratum.frames.push_back(frame);
    }
    strata.push_back(std::move(stratum));
  }
  return strata;
}

// Of one recording, on one axis of the push.
std::vector<double> PitsOf(const IdentifiedModel& model, const PendulumRecording& recording,
                           const RecordingFilter& filter, int axis) {
  std::vector<double> weights, pits;
  const auto mixture = filter.Mixture(*model.recording_effect, &weights);
  const int person = recording.pushed_person;
  const Vector3<double> direction = filter.Axes().col(axis);
  for (double s = kPitSpacing; s <= kLastPit + 1e-9; s += kPitSpacing) {
    const int t = static_cast<int>(std::lround(s / recording.scene.dt));
    if (t >= recording.num_frames()) break;
    if (recording.Weight(person, t) == 0.0) continue;
    const MixturePoint& point = mixture[person][t - 1];
    const double value = direction.dot(recording.hip[person][t]);
    double below = 0.0;
    for (size_t j = 0; j < weights.size(); ++j) {
      below += weights[j] * NormalCdf((value - point.mean[j][axis]) / point.deviation[axis]);
    }
    pits.push_back(below);
  }
  return pits;
}

std::vector<std::vector<ParameterSet<double>>> OfEverybody(
    const IdentifiedModel& model, const std::vector<PendulumRecording>& recordings) {
  std::vector<std::vector<ParameterSet<double>>> sets;
  for (const PendulumRecording& recording : recordings) {
    sets.push_back(PeoplesParameters(model, recording));
  }
  return sets;
}

}  // namespace

double CheckedStratum::Inside() const {
  double inside = 0.0, all = 0.0;
  for (const CheckedFrame& frame : frames) {
    for (int q = 0; q < kNumCheckedShares; ++q, all += 1.0) {
      inside += frame.lower90[q] <= frame.observed[q] && frame.observed[q] <= frame.upper90[q];
    }
  }
  return all > 0.0 ? inside / all : 0.0;
}

UniformityTest TestUniformity(const std::vector<std::vector<double>>& values) {
  UniformityTest test;
  std::vector<Eigen::Matrix<double, kBins, 1>> counts;
  double total = 0.0;
  Eigen::Matrix<double, kBins, 1> shares = Eigen::Matrix<double, kBins, 1>::Zero();
  for (const std::vector<double>& cluster : values) {
    if (cluster.empty()) continue;
    counts.push_back(Eigen::Matrix<double, kBins, 1>::Zero());
    for (double value : cluster) {
      counts.back()[std::clamp(static_cast<int>(value * kBins), 0, kBins - 1)] += 1.0;
      test.values.push_back(value);
    }
    total += static_cast<double>(cluster.size());
    shares += counts.back();
  }
  test.recordings = static_cast<int>(counts.size());
  const double clusters = static_cast<double>(counts.size());
  if (counts.size() <= static_cast<size_t>(kBins)) return test;
  shares /= total;
  Eigen::Matrix<double, kBins, kBins> covariance = Eigen::Matrix<double, kBins, kBins>::Zero();
  for (const auto& count : counts) {
    const Eigen::Matrix<double, kBins, 1> off = (count - count.sum() * shares) / total;
    covariance += clusters / (clusters - 1.0) * off * off.transpose();
  }
  for (int b = 0; b < kBins; ++b) {
    test.shares[b] = shares[b];
    test.errors[b] = std::sqrt(covariance(b, b));
  }
  // The last share follows from the others. Bins that nobody is in have no variance of their own:
  // a little of what independent values would have keeps the test defined.
  constexpr int kFree = kBins - 1;
  const Eigen::Matrix<double, kFree, 1> off = shares.head<kFree>().array() - 1.0 / kBins;
  Eigen::Matrix<double, kFree, kFree> c = covariance.topLeftCorner<kFree, kFree>();
  c.diagonal().array() += 0.05 * (1.0 / kBins) * (1.0 - 1.0 / kBins) / total;
  const double t2 = off.dot(SolveSymmetric(Eigen::MatrixXd(c), Eigen::VectorXd(off)));
  const double freedom = clusters - kFree;
  test.f = t2 * freedom / ((clusters - 1.0) * kFree);
  test.p = Eigen::numext::betainc(0.5 * freedom, 0.5 * kFree, freedom / (freedom + kFree * test.f));
  return test;
}

VisualCheck CheckVisually(const IdentifiedModel& model,
                          const std::vector<PendulumRecording>& recordings, uint64_t seed) {
  VisualCheck check;
  if (!model.recording_effect) return check;
  Random random(seed);
  std::vector<Checked> all;
  std::vector<std::vector<double>> along, across;
  for (const PendulumRecording& recording : recordings) {
    const RecordingFilter filter(model, recording, recording.num_frames());
    if (!filter.ok() || PushSpeed(recording) <= 0.0) continue;
    all.push_back(Check(model, recording, filter, &random));
    along.push_back(PitsOf(model, recording, filter, 0));
    across.push_back(PitsOf(model, recording, filter, 1));
  }
  if (all.size() < kFewestForAll) return check;
  check.strata = Strata(all);
  check.along = TestUniformity(along);
  check.across = TestUniformity(across);
  return check;
}

std::vector<FrequencyResponse> FrequencyResponses(
    const IdentifiedModel& model, const std::vector<PendulumRecording>& recordings) {
  return FrequencyResponses(recordings, model.options, OfEverybody(model, recordings));
}

std::vector<PersonSway> SwayOfPeople(const IdentifiedModel& model,
                                     const std::vector<PendulumRecording>& recordings, int repeats,
                                     uint64_t seed) {
  return SwayOfPeople(recordings, model.options, OfEverybody(model, recordings), repeats, seed);
}

}  // namespace pushid
