// ident: the pushes that a model was fitted to, and predictions beyond them.
//
// What a push does to a person is its impulse over the person's mass: of its rows and of the tail
// that the model gives it, so that a measured push and the part of one compare. How long it lasts
// compares among pushes of one kind only: the rows of a net push cover its beginning.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "datasets/loading/pendulum_recording.h"

namespace pushid {

struct IdentifiedModel;

struct ValueRange {
  double lower = std::numeric_limits<double>::infinity(), upper = 0.0;

  bool empty() const { return lower > upper; }
  void Add(double value) {
    lower = std::min(lower, value);
    upper = std::max(upper, value);
  }
  // How far a value lies outside, as a factor; 1 inside, and where the range is empty.
  double Beyond(double value) const {
    return empty() ? 1.0 : std::max({1.0, value / upper, lower / value});
  }
};

struct PushRange {
  ValueRange external_s, net_s;  // durations of the rows, s
  ValueRange impulse_per_mass;   // m/s

  ValueRange& Durations(PushKind kind) { return kind == PushKind::kExternal ? external_s : net_s; }
  const ValueRange& Durations(PushKind kind) const {
    return const_cast<PushRange*>(this)->Durations(kind);
  }
};

// Under `push_range` in a model's JSON, each a pair.
struct PushRangeRow {
  const char* key;
  ValueRange PushRange::*range;
};
inline constexpr PushRangeRow kPushRangeRows[] = {
    {"external_duration_s", &PushRange::external_s},
    {"net_duration_s", &PushRange::net_s},
    {"impulse_per_mass_m_s", &PushRange::impulse_per_mass},
};

// What the recorded rows alone give people, m/s; tails not counted.
double PushSpeed(const PendulumRecording& recording);
// Horizontal direction of what the pushes on the pushed person add up to; +x where they cancel.
Eigen::Vector2d PushDirection(const PendulumRecording& recording);

PushRange FittedPushRange(const IdentifiedModel& model,
                          const std::vector<PendulumRecording>& recordings);

// Farther outside the range than this, a prediction is an extrapolation.
inline constexpr double kBeyondFittedRange = 1.25;

// What to warn of: one sentence on the durations and one on the impulses that lie outside; none
// where the model's file is older than the range.
std::vector<std::string> ExtrapolationWarnings(const IdentifiedModel& model,
                                               const std::vector<PendulumRecording>& recordings);

}  // namespace pushid
