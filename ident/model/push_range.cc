// ident: durations and impulses of pushes.
#include "ident/model/push_range.h"

#include <cmath>
#include <optional>

#include "datasets/files/number_text.h"
#include "ident/model/identified_model.h"
#include "ident/model/model_rollout.h"
#include "ident/problem/own_axes.h"

namespace pushid {
namespace {

double Duration(const PendulumRecording& recording, const ScenePush& push) {
  return static_cast<double>(push.force.size()) * recording.scene.dt;
}

double ImpulsePerMass(const IdentifiedModel& model, const PendulumRecording& recording,
                      const ScenePush& push) {
  ParameterSet<double> p = PeoplesParameters(model, recording)[push.person];
  if (model.options.push_tail == PushTail::kNone) p[kTailGain] = p[kTailBase] = 0.0;
  const double mass = recording.scene.people[push.person].body.mass;
  return WholeImpulse(push, mass, p, recording.scene.dt) / mass;
}

bool HasDirection(const ScenePush& push) { return !push.mean.head<2>().isZero(0.0); }

// From the model's x axis, in degrees; to the left and to the right alike.
double Direction(const IdentifiedModel& model, const PendulumRecording& recording,
                 const ScenePush& push) {
  const double angle =
      std::atan2(push.mean[1], push.mean[0]) - OwnAxes(recording, model.options.directions);
  return std::abs(std::remainder(angle, 2.0 * M_PI)) * 180.0 / M_PI;
}

// The pushes of some recordings that lie outside of a range.
struct Outside {
  int recordings = 0;
  double farthest = 1.0;  // as a factor
  double value = 0.0;     // of the farthest
  std::string id;         // of its recording
  bool has_tail = false;  // in the model, and it is too much
  ValueRange range;

  void Add(double factor, double of, const std::string& recording, const ValueRange& fitted) {
    if (factor <= farthest) return;
    farthest = factor, value = of, id = recording, range = fitted;
  }
  std::string Sentence(const std::string& what, const std::string& unit, int all) const {
    const std::string others = recordings > 1
                                   ? " (the farthest of " + std::to_string(recordings) +
                                         " such among " + std::to_string(all) + " recordings)"
                                   : "";
    return what + " of " + id + " is " + Rounded(value, 3) + " " + unit + others +
           "; the model was fitted to " + Rounded(range.lower, 3) + " to " +
           Rounded(range.upper, 3) + " " + unit + ": an extrapolation";
  }
};

// What to say of pushes from where none was fitted.
std::optional<std::string> TurnedAway(const IdentifiedModel& model,
                                      const std::vector<PendulumRecording>& recordings) {
  const ValueRange& fitted = model.push_range->direction;
  if (fitted.empty()) return std::nullopt;
  for (const PendulumRecording& recording : recordings) {
    for (const ScenePush& push : recording.scene.pushes) {
      if (push.force.empty() || !HasDirection(push)) continue;
      const double angle = Direction(model, recording, push);
      if (angle <= fitted.upper + kBeyondFittedAngle &&
          angle >= fitted.lower - kBeyondFittedAngle) {
        continue;
      }
      return "the push of " + recording.id + " points " + Rounded(angle, 3) +
             " degrees off forwards; the model was fitted to " + Rounded(fitted.lower, 3) + " to " +
             Rounded(fitted.upper, 3) +
             " degrees: what people do then is an assumption, not an estimate";
    }
  }
  return std::nullopt;
}

}  // namespace

double PushSpeed(const PendulumRecording& recording) {
  double speed = 0.0;
  for (const ScenePush& push : recording.scene.pushes) {
    speed += push.mean.head<2>().norm() * static_cast<double>(push.force.size()) *
             recording.scene.dt / recording.scene.people[push.person].body.mass;
  }
  return speed;
}

PushRange FittedPushRange(const IdentifiedModel& model,
                          const std::vector<PendulumRecording>& recordings) {
  PushRange range;
  for (const PendulumRecording& recording : recordings) {
    for (const ScenePush& push : recording.scene.pushes) {
      if (push.force.empty()) continue;
      range.Durations(push.kind).Add(Duration(recording, push));
      range.impulse_per_mass.Add(ImpulsePerMass(model, recording, push));
      if (HasDirection(push)) range.direction.Add(Direction(model, recording, push));
    }
  }
  return range;
}

std::vector<std::string> ExtrapolationWarnings(const IdentifiedModel& model,
                                               const std::vector<PendulumRecording>& recordings) {
  if (!model.push_range) return {};
  IdentifiedModel boundless = model;  // tails as they would be without the range
  boundless.push_range.reset();
  Outside duration, impulse;
  for (const PendulumRecording& recording : recordings) {
    const auto judge = [&](const auto& value, const auto& range, Outside* outside) {
      bool any = false;
      for (const ScenePush& push : recording.scene.pushes) {
        if (push.force.empty()) continue;
        const double factor = range(push).Beyond(value(push));
        if (factor <= kBeyondFittedRange) continue;
        any = true;
        outside->Add(factor, value(push), recording.id, range(push));
        outside->has_tail |= model.options.push_tail != PushTail::kNone &&
                             push.kind != PushKind::kExternal && value(push) > range(push).upper;
      }
      outside->recordings += any;
    };
    judge([&](const ScenePush& push) { return Duration(recording, push); },
          [&](const ScenePush& push) { return model.push_range->Durations(push.kind); }, &duration);
    judge([&](const ScenePush& push) { return ImpulsePerMass(boundless, recording, push); },
          [&](const ScenePush&) { return model.push_range->impulse_per_mass; }, &impulse);
  }
  const int all = static_cast<int>(recordings.size());
  std::vector<std::string> warnings;
  if (duration.recordings > 0) {
    warnings.push_back(duration.Sentence("the push's duration", "s", all));
  }
  if (impulse.recordings > 0) {
    warnings.push_back(impulse.Sentence("the push's impulse over mass", "m/s", all));
    if (impulse.has_tail) warnings.back() += "; its tail is cut to what was seen";
  }
  if (const auto turned = TurnedAway(model, recordings)) warnings.push_back(*turned);
  return warnings;
}

}  // namespace pushid
