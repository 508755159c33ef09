// ident: recorded against fitted motion, by the residuals: predicted = recorded + sigma r.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

#include "ident/problem/fit_problem.h"
#include "ident/problem/residual_rows.h"
#include "ident/problem/statistics.h"
#include "ident/uncertainty/assumptions.h"
#include "ident/uncertainty/model_verdict.h"
#include "residuals/frame_residual.h"

namespace pushid {
namespace {

constexpr double kDrop = 0.03;     // m: more than what markers' noise does
constexpr double kSmoothed = 0.1;  // s: of the paths whose turns are looked for

// Along the push, m, from where the first frame has them.
struct Motion {
  std::vector<double> hip, feet;
};

struct Compared {
  Motion recorded, predicted;
  double way = 0.0, error = 0.0;  // of the hip, squared, m^2, without the markers' white noise
  bool whole = true;              // every frame was seen
};

Compared MotionOf(const PendulumRecording& r, const std::vector<double>& raw,
                  const ResidualSigmas& sigmas) {
  const Eigen::Vector2d along = PushDirection(r);
  const int n = r.pushed_person;
  Compared c;
  double feet = 0.0;  // predicted less recorded
  double noise =
      0.0;  // half the squared changes from frame to frame of errors: what is white of them
  Eigen::Vector2d before = Eigen::Vector2d::Zero();
  for (int t = 0; t < r.num_frames(); ++t) {
    const Eigen::Vector2d hip = (r.hip[n][t] - r.hip[n][0]).head<2>();
    const Eigen::Vector2d at = (r.states[n][t].q - r.states[n][0].q).head<2>();
    Eigen::Vector2d error = Eigen::Vector2d::Zero();
    const double seen = t > 0 ? r.Weight(n, t) : 1.0;
    c.whole = c.whole && seen > 0.0;
    if (t > 0 && seen > 0.0) {
      const int row = ((t - 1) * r.num_people() + n) * kFrameResiduals;
      const Eigen::Map<const FrameVector<double>> residual(raw.data() + row);
      error = sigmas.hip / seen * residual.head<2>();
      feet += r.scene.dt * sigmas.velocity / seen * along.dot(residual.segment<2>(3));
    }
    c.recorded.hip.push_back(along.dot(hip));
    c.predicted.hip.push_back(along.dot(hip + error));
    c.recorded.feet.push_back(along.dot(at));
    c.predicted.feet.push_back(along.dot(at) + feet);
    if (seen > 0.0) c.way += hip.squaredNorm();
    c.error += error.squaredNorm();
    if (t > 1 && seen > 0.0) noise += 0.5 * (error - before).squaredNorm();
    before = error;
  }
  c.error = std::max(0.0, c.error - noise);
  c.way -= noise;
  return c;
}

std::vector<double> Smoothed(const std::vector<double>& path, double dt) {
  const int half = static_cast<int>(std::lround(0.5 * kSmoothed / dt));
  const int frames = static_cast<int>(path.size());
  std::vector<double> smooth;
  for (int t = 0; t < frames; ++t) {
    const int from = std::max(0, t - half), to = std::min(frames - 1, t + half);
    double sum = 0.0;
    for (int k = from; k <= to; ++k) sum += path[k];
    smooth.push_back(sum / (to - from + 1));
  }
  return smooth;
}

// The means of the clusters.
class Differences {
 public:
  void Add(int cluster, double difference) {
    sum_[cluster] += difference;
    count_[cluster] += 1;
  }

  // stated: an error that all have in common.
  std::optional<MotionTest> Test(const char* quantity, const char* unit, double stated) const {
    const double n = static_cast<double>(sum_.size());
    if (n < 3.0) return std::nullopt;
    std::vector<double> means;
    for (const auto& [cluster, sum] : sum_) means.push_back(sum / count_.at(cluster));
    const double mean = std::accumulate(means.begin(), means.end(), 0.0) / n;
    double squares = 0.0;
    for (double one : means) squares += (one - mean) * (one - mean);
    MotionTest test{quantity, unit, mean, std::sqrt(squares / (n * (n - 1.0)))};
    if (test.error <= 0.0) return std::nullopt;  // alike in all: nobody knows how much they scatter
    test.t = mean / std::hypot(test.error, stated);
    test.p = StudentTail(test.t, n - 1.0);
    return test;
  }

 private:
  std::map<int, double> sum_;
  std::map<int, int> count_;
};

}  // namespace

std::vector<int> TurnsOf(const std::vector<double>& path, double drop) {
  std::vector<int> turns;
  if (path.empty()) return turns;
  int most = 0, least = 0, heading = 0;  // 0: neither way yet
  for (int t = 1; t < static_cast<int>(path.size()); ++t) {
    if (path[t] > path[most]) most = t;
    if (path[t] < path[least]) least = t;
    if (heading >= 0 && path[most] - path[t] >= drop) {
      if (heading > 0) turns.push_back(most);
      heading = -1;
      least = t;
    } else if (heading <= 0 && path[t] - path[least] >= drop) {
      if (heading < 0) turns.push_back(least);
      heading = 1;
      most = t;
    }
  }
  return turns;
}

MotionComparison CompareMotion(const FitProblem& problem, const FitPoint& point,
                               const Clusters& clusters) {
  Differences feet, time, turns;
  std::vector<double> explained;
  const ResidualsByRecording all = RawResiduals(problem, point);
  for (size_t i = 0; i < problem.recordings().size(); ++i) {
    const PendulumRecording& r = problem.recordings()[i];
    if (problem.Count(static_cast<int>(i)) == 0 || !r.IsSeen()) continue;
    const std::vector<double>& raw = all[i];
    if (raw.empty()) return {};
    const Compared c = MotionOf(r, raw, problem.options().sigmas);
    if (c.way > 0.0) explained.push_back(1.0 - c.error / c.way);
    if (!c.whole) continue;
    const int cluster = clusters.of[i][r.pushed_person];
    feet.Add(cluster, c.recorded.feet.back() - c.predicted.feet.back());
    const std::vector<int> recorded = TurnsOf(Smoothed(c.recorded.hip, r.scene.dt), kDrop);
    const std::vector<int> predicted = TurnsOf(Smoothed(c.predicted.hip, r.scene.dt), kDrop);
    turns.Add(cluster,
              static_cast<double>(recorded.size()) - static_cast<double>(predicted.size()));
    if (!recorded.empty() && !predicted.empty()) {
      time.Add(cluster, r.scene.dt * (recorded.front() - predicted.front()));
    }
  }
  MotionComparison found;
  for (const std::optional<MotionTest>& test :
       {feet.Test("travel of the feet", "m", Stated(problem.recordings()).drift_m),
        time.Test("first turn of the hip", "s", 0.0),
        turns.Test("number of turns of the hip", "", 0.0)}) {
    if (test) found.tests.push_back(*test);
  }
  found.explained =
      explained.empty() ? std::numeric_limits<double>::quiet_NaN() : Median(explained);
  return found;
}

}  // namespace pushid
