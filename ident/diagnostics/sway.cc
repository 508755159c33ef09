// ident: sway of quiet stance.
#include "ident/diagnostics/sway.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "datasets/files/random.h"
#include "datasets/loading/motion_preparation.h"
#include "ident/diagnostics/spectra.h"
#include "ident/problem/own_axes.h"
#include "models/ground_reaction.h"
#include "models/net_force.h"
#include "models/rollout.h"

namespace pushid {
namespace {

using Track = std::vector<Eigen::Vector2d>;

constexpr double kShortestStance = 10.0, kForgets = 10.0;  // s
constexpr double kCutoff = 5.0, kLowestSway = 0.15;        // Hz
constexpr double kSwaySegment = 20.0;                      // s
constexpr double kStillGround = 1e-6;                      // m, rad

Track Smoothed(const Track& track, double dt) {
  if (kCutoff >= HighestCutoff(1.0 / dt)) return track;
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector2d& p : track) points.emplace_back(p[0], p[1], 0.0);
  LowPass(kCutoff, 1.0 / dt, &points);
  Track smoothed;
  for (const Eigen::Vector3d& p : points) smoothed.push_back(p.head<2>());
  return smoothed;
}

double MeanFrequency(const Track& track, int axis, double dt) {
  std::vector<double> series;
  for (const Eigen::Vector2d& p : track) series.push_back(p[axis]);
  const int segment =
      std::min(static_cast<int>(std::lround(kSwaySegment / dt)), static_cast<int>(series.size()));
  const std::vector<double> density = PowerDensity(series, segment, dt);
  double sum = 0.0, weighted = 0.0;
  for (size_t i = 0; i < density.size(); ++i) {
    const double hz = static_cast<double>(i) / (segment * dt);
    if (hz < kLowestSway || hz > kCutoff) continue;
    sum += density[i];
    weighted += hz * density[i];
  }
  return sum > 0.0 ? weighted / sum : 0.0;
}

// What was not seen is taken as it was before.
Track MeasuredTrack(const PendulumRecording& recording, int person) {
  const bool plates = recording.HasPlates(person);
  Track track;
  for (int t = 0; t < recording.num_frames(); ++t) {
    const bool seen =
        plates ? recording.plates[person][t].weight > 0.0 : recording.Weight(person, t) > 0.0;
    if (!seen && !track.empty()) {
      track.push_back(track.back());
    } else {
      track.push_back(plates ? recording.plates[person][t].centre
                             : Eigen::Vector2d(recording.hip[person][t].head<2>()));
    }
  }
  return track;
}

// Of a rollout from frame `from` on, as MeasuredTrack would have it.
Track SimulatedTrack(const Scene& scene, const ModelOptions& options, const ParameterSet<double>& p,
                     const RolloutPath<double>& path, int person, int from, bool plates) {
  const Body& body = scene.people[person].body;
  const BodyOf<double> turns =
      DynamicBody<double>(options, body, p, options.stance == Stance::kFixed);
  Track track;
  for (int t = from; t + 1 < path.num_frames(); ++t) {
    const PendulumState<double>& state = path.At(t, person);
    if (!plates) {
      track.emplace_back(HipPosition(body, state.q).head<2>());
      continue;
    }
    const Vector4<double> a = (path.At(t + 1, person).qd - state.qd) / scene.dt;
    track.emplace_back(
        GroundReaction<double>(turns, state, a, GroundStep{}, Vector4<double>::Zero()).tail<2>());
  }
  return track;
}

struct SwaySums {
  Sway sum{}, squares{};
  int count = 0;

  void Add(const Sway& sway) {
    ++count;
    for (int i = 0; i < kNumSwayMeasures; ++i) {
      sum[i] += sway[i];
      squares[i] += sway[i] * sway[i];
    }
  }
  Sway Mean() const {
    Sway mean{};
    for (int i = 0; i < kNumSwayMeasures && count > 0; ++i) mean[i] = sum[i] / count;
    return mean;
  }
  Sway Spread() const {
    Sway spread{};
    const Sway mean = Mean();
    for (int i = 0; i < kNumSwayMeasures && count > 1; ++i) {
      const double variance = (squares[i] - count * mean[i] * mean[i]) / (count - 1.0);
      spread[i] = std::sqrt(std::max(0.0, variance));
    }
    return spread;
  }
};

struct SwayOfOne {
  bool by_plates = false;
  SwaySums measured, simulated;
};

void Simulate(const PendulumRecording& recording, const ModelOptions& options,
              const std::vector<ParameterSet<double>>& parameters, int repeats, Random* random,
              std::map<std::string, SwayOfOne>* people) {
  Scene scene = recording.scene;
  scene.pushes.clear();
  scene.ground = {};
  const int before = static_cast<int>(std::lround(kForgets / scene.dt));
  const int frames = before + recording.num_frames() + 1;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    FrameTable<Vector4<double>> noise(frames, scene.num_people());
    for (int t = 0; t < frames; ++t) {
      for (int n = 0; n < scene.num_people(); ++n) {
        for (double& w : noise.At(t, n)) w = random->Normal();
      }
    }
    RolloutPath<double> path;
    if (!Rollout<double>(scene, options, parameters, InitialVelocities(scene), frames, &path,
                         nullptr, nullptr, &noise)
             .ok) {
      continue;
    }
    for (int n = 0; n < scene.num_people(); ++n) {
      SwayOfOne& one = (*people)[recording.subject_ids[n]];
      one.simulated.Add(SwayOf(
          SimulatedTrack(scene, options, parameters[n], path, n, before, recording.HasPlates(n)),
          scene.dt));
    }
  }
}

}  // namespace

Sway SwayOf(const std::vector<Eigen::Vector2d>& track, double dt) {
  Track p = Smoothed(track, dt);
  const double n = static_cast<double>(p.size());
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : p) mean += point / n;
  Sway sway{};
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  for (size_t t = 0; t < p.size(); ++t) {
    p[t] -= mean;
    squares += p[t] * p[t].transpose();
    if (t > 0) sway[kSwayPath] += (p[t] - p[t - 1]).norm();
  }
  sway[kSwaySpeed] = sway[kSwayPath] / ((n - 1.0) * dt);
  sway[kSwayRmsX] = std::sqrt(squares(0, 0) / n);
  sway[kSwayRmsY] = std::sqrt(squares(1, 1) / n);
  sway[kSwayFrequencyX] = MeanFrequency(p, 0, dt);
  sway[kSwayFrequencyY] = MeanFrequency(p, 1, dt);
  // Of two and m degrees of freedom: P(F > f) = (1 + 2 f / m)^(-m / 2).
  const double m = n - 2.0, f95 = 0.5 * m * (std::pow(0.05, -2.0 / m) - 1.0);
  const double det =
      (squares(0, 0) * squares(1, 1) - squares(0, 1) * squares(0, 1)) / ((n - 1.0) * (n - 1.0));
  sway[kSwayEllipse] = 2.0 * M_PI * f95 * std::sqrt(std::max(0.0, det));
  return sway;
}

bool IsQuiet(const PendulumRecording& recording) {
  if ((recording.num_frames() - 1) * recording.scene.dt < kShortestStance) return false;
  for (const ScenePush& push : recording.scene.pushes) {
    for (const Vector4<double>& row : push.force) {
      if (!row.isZero(0.0)) return false;
    }
  }
  const std::vector<GroundPose>& poses = recording.scene.ground.poses;
  return std::all_of(poses.begin(), poses.end(), [&poses](const GroundPose& pose) {
    return (pose - poses.front()).cwiseAbs().maxCoeff() < kStillGround;
  });
}

std::vector<PersonSway> SwayOfPeople(
    const std::vector<PendulumRecording>& recordings, const ModelOptions& options,
    const std::vector<std::vector<ParameterSet<double>>>& parameters, int repeats, uint64_t seed) {
  const auto own = InOwnAxes(recordings, options);
  const std::vector<PendulumRecording>& seen = own ? *own : recordings;
  std::map<std::string, SwayOfOne> people;
  Random random(seed);
  for (size_t i = 0; i < seen.size(); ++i) {
    const PendulumRecording& recording = seen[i];
    if (!IsQuiet(recording)) continue;
    for (int n = 0; n < recording.num_people(); ++n) {
      SwayOfOne& one = people[recording.subject_ids[n]];
      one.by_plates = one.by_plates || recording.HasPlates(n);
      one.measured.Add(SwayOf(MeasuredTrack(recording, n), recording.scene.dt));
    }
    if (options.process_noise == ProcessNoise::kNone) continue;
    Simulate(recording, options, parameters[i], repeats, &random, &people);
  }
  std::vector<PersonSway> result;
  for (const auto& [name, one] : people) {
    result.push_back({name, one.measured.count, one.by_plates, one.measured.Mean(),
                      one.simulated.count, one.simulated.Mean(), one.simulated.Spread()});
  }
  return result;
}

TextTable SwayTable(const std::vector<PersonSway>& people) {
  TextTable table({"person", "of", "recordings", "measure", "unit", "measured", "simulated",
                   "simulated_spread", "repeats"});
  for (const PersonSway& one : people) {
    for (int i = 0; i < kNumSwayMeasures; ++i) {
      const bool known = one.repeats > 0;
      table.Add({one.person, one.by_plates ? "centre of pressure" : "hip", one.recordings,
                 kSwayMeasures[i].name, kSwayMeasures[i].unit, one.measured[i],
                 known ? TableCell(one.simulated[i]) : TableCell(""),
                 known ? TableCell(one.spread[i]) : TableCell(""), one.repeats});
    }
  }
  return table;
}

}  // namespace pushid
