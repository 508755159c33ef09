// ident: parameters of a rollout, and where it ended.
#include "ident/model/model_rollout.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "ident/problem/own_axes.h"
#include "ident/problem/statistics.h"
#include "residuals/rollout_residual.h"

namespace pushid {
namespace {

// A push gives nobody more momentum for the mass than any that the model was fitted to: beyond
// those, nothing is known of tails, and in proportion to the rows
// they run away. Rows are measured and stay. Of several pushes on a person the strongest counts.
void BoundTails(const PushRange& range, const PendulumRecording& recording,
                std::vector<ParameterSet<double>>* sets) {
  if (range.impulse_per_mass.empty()) return;
  const double dt = recording.scene.dt;
  for (const ScenePush& push : recording.scene.pushes) {
    ParameterSet<double>& p = (*sets)[push.person];
    const double mass = recording.scene.people[push.person].body.mass;
    const double tail = TailImpulse(push, mass, p, dt);
    const double rows = WholeImpulse(push, mass, p, dt) - tail;
    const double most = std::max(0.0, range.impulse_per_mass.upper * mass - rows);
    if (tail > most) ScaleTail(most / tail, &p);
  }
}

}  // namespace

std::vector<ParameterSet<double>> PeoplesParameters(const IdentifiedModel& model,
                                                    const PendulumRecording& recording) {
  std::vector<ParameterSet<double>> sets;
  const ParameterMap map = model.table.Map();
  const std::vector<std::vector<double>> covariates = CovariatesOf(recording, map.covariates);
  for (const std::string& unit : PoolingUnits(recording, model.pool_by)) {
    sets.push_back(model.For(unit));
    if (!covariates.empty()) map.Shift(covariates[sets.size() - 1], &sets.back());
  }
  if (model.options.push_tail != PushTail::kNone && model.push_range) {
    BoundTails(*model.push_range, recording, &sets);
  }
  return sets;
}

std::string OutsideText(const RolloutStatus& status) {
  return std::string(status.quantity) + " of person " + std::to_string(status.person) +
         " leaves the model's domain at frame " + std::to_string(status.frame);
}

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

// The push's angle from the model's x axis, degrees; pushes to the left and to the right count
// alike.
double Direction(const IdentifiedModel& model, const PendulumRecording& recording,
                 const ScenePush& push) {
  const double angle =
      std::atan2(push.mean[1], push.mean[0]) - OwnAxes(recording, model.options.directions);
  return std::abs(std::remainder(angle, 2.0 * M_PI)) * 180.0 / M_PI;
}

// The height, as a fraction of the rod, at which a horizontal force on the body has the push's
// torque; at least a hundredth, because ranges are compared by their ratios.
double HeightOfRod(const PendulumRecording& recording, const ScenePush& push) {
  const ScenePerson& person = recording.scene.people[push.person];
  Vector4<double> f = push.mean;
  // The rows of a net push hold the posture as well.
  if (push.kind != PushKind::kExternal) f -= Gravity<double>(person.body, person.start.q);
  const double lean = std::cos(person.start.q[2]) * std::cos(person.start.q[3]);
  return std::max(0.01, (f[2] * f[0] - f[3] * f[1]) /
                            (f.head<2>().squaredNorm() * person.body.rod_length * lean));
}

bool HasHeight(const ScenePush& push) {
  return push.kind == PushKind::kExternal && HasDirection(push);
}

// The medians of the commonest kind.
std::optional<UsualPush> UsualOf(const std::vector<PendulumRecording>& recordings) {
  std::map<PushKind, std::vector<double>> durations, heights, impulses;
  for (const PendulumRecording& recording : recordings) {
    for (const ScenePush& push : recording.scene.pushes) {
      if (push.force.empty() || !HasDirection(push)) continue;
      const double duration = Duration(recording, push);
      durations[push.kind].push_back(duration);
      impulses[push.kind].push_back(duration * push.mean.head<2>().norm());
      heights[push.kind].push_back(HeightOfRod(recording, push));
    }
  }
  if (durations.empty()) return std::nullopt;
  const PushKind kind =
      std::max_element(durations.begin(), durations.end(), [](const auto& a, const auto& b) {
        return a.second.size() < b.second.size();
      })->first;
  return UsualPush{kind, Median(durations[kind]), Median(heights[kind]), Median(impulses[kind])};
}

// The distance from a person's cart to the nearest other one, m; infinite for a person alone.
double Spacing(const Scene& scene, int person) {
  double nearest = INFINITY;
  for (int n = 0; n < scene.num_people(); ++n) {
    if (n == person) continue;
    const Vector4<double> apart = scene.people[n].start.q - scene.people[person].start.q;
    nearest = std::min(nearest, apart.head<2>().norm());
  }
  return nearest;
}

// Adds each person once, by id, in the order of the recordings: with the body and feet of the first
// recording and the median posture of all of them, because a person may lean in one.
void AddPeople(const std::vector<PendulumRecording>& recordings, PushRange* range) {
  std::map<std::string, std::pair<std::vector<double>, std::vector<double>>> leans;
  std::vector<std::string> ids;
  for (const PendulumRecording& recording : recordings) {
    const Scene scene = TurnedScene(recording, recording.facing);
    for (int n = 0; n < scene.num_people(); ++n) {
      if (scene.num_people() > 1) range->spacing.Add(Spacing(scene, n));
      const auto& [body, start] = scene.people[n];
      auto& [theta, phi] = leans[recording.subject_ids[n]];
      theta.push_back(start.q[2]);
      phi.push_back(start.q[3]);
      if (theta.size() > 1) continue;
      ids.push_back(recording.subject_ids[n]);
      range->people.push_back(
          {body.mass, body.rod_length, body.cart_height, 0.0, 0.0, start.feet.apart});
    }
  }
  for (size_t i = 0; i < ids.size(); ++i) {
    range->people[i].theta = Median(leans[ids[i]].first);
    range->people[i].phi = Median(leans[ids[i]].second);
  }
}

// The pushes, or people, of some recordings that lie outside of a range.
struct Outside {
  const char *what, *unit;  // "the push's duration", "s"
  int recordings = 0;
  double farthest = 1.0;     // as a factor
  double value = 0.0;        // of the farthest
  std::string id{}, last{};  // of its recording, and of the last one counted
  ValueRange range{};        // that it lies outside of
  std::string remark{};      // behind the sentence

  // Counts a value that is more than a quarter outside; whether it is.
  bool See(double of, const std::string& recording, const ValueRange& fitted) {
    const double factor = fitted.Beyond(of);
    if (factor <= kBeyondFittedRange) return false;
    recordings += recording != last;
    last = recording;
    if (factor > farthest) farthest = factor, value = of, id = recording, range = fitted;
    return true;
  }
  std::string Sentence(size_t all) const {
    const std::string others = recordings > 1
                                   ? " (the farthest of " + std::to_string(recordings) +
                                         " such among " + std::to_string(all) + " recordings)"
                                   : "";
    return std::string(what) + " of " + id + " is " + Rounded(value, 3) + " " + unit + others +
           "; the model was fitted to " + Rounded(range.lower, 3) + " to " +
           Rounded(range.upper, 3) + " " + unit + ": an extrapolation" + remark;
  }
};

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
      if (HasHeight(push)) range.height.Add(HeightOfRod(recording, push));
    }
  }
  range.usual = UsualOf(recordings);
  AddPeople(recordings, &range);
  return range;
}

std::vector<std::string> ExtrapolationWarnings(const IdentifiedModel& model,
                                               const std::vector<PendulumRecording>& recordings) {
  if (!model.push_range) return {};
  const PushRange& fitted = *model.push_range;
  IdentifiedModel boundless = model;  // tails as they would be without the range
  boundless.push_range.reset();
  Outside duration{"the push's duration", "s"}, impulse{"the push's impulse over mass", "m/s"},
      height{"the push's height over the rod", "of it"}, mass{"the mass of a person", "kg"},
      spacing{"the distance to the nearest person", "m"};
  std::string turned;
  ValueRange masses;
  for (const FittedPerson& person : fitted.people) masses.Add(person.mass);
  for (const PendulumRecording& recording : recordings) {
    const std::string& id = recording.id;
    for (const ScenePush& push : recording.scene.pushes) {
      if (push.force.empty()) continue;
      duration.See(Duration(recording, push), id, fitted.Durations(push.kind));
      const double speed = ImpulsePerMass(boundless, recording, push);
      const bool outside = impulse.See(speed, id, fitted.impulse_per_mass);
      if (outside && speed > fitted.impulse_per_mass.upper && push.kind != PushKind::kExternal &&
          model.options.push_tail != PushTail::kNone) {
        impulse.remark = "; its tail is cut to what was seen";
      }
      if (HasHeight(push)) height.See(HeightOfRod(recording, push), id, fitted.height);
      if (!turned.empty() || fitted.direction.empty() || !HasDirection(push)) continue;
      const double angle = Direction(model, recording, push);
      const auto& [lower, upper] = fitted.direction;
      if (angle <= upper + kBeyondFittedAngle && angle >= lower - kBeyondFittedAngle) continue;
      turned = "the push of " + id + " points " + Rounded(angle, 3) +
               " degrees off forwards; the model was fitted to " + Rounded(lower, 3) + " to " +
               Rounded(upper, 3) +
               " degrees: what people do then is an assumption, not an estimate";
    }
    const Scene& scene = recording.scene;
    for (int n = 0; n < scene.num_people(); ++n) {
      mass.See(scene.people[n].body.mass, id, masses);
      if (scene.num_people() > 1) spacing.See(Spacing(scene, n), id, fitted.spacing);
    }
  }
  std::vector<std::string> warnings;
  for (const Outside* one : {&duration, &impulse, &height, &mass, &spacing}) {
    if (one->recordings > 0) warnings.push_back(one->Sentence(recordings.size()));
  }
  if (!turned.empty()) warnings.push_back(turned);
  return warnings;
}

}  // namespace pushid
