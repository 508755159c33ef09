// ident: how each assumption changes what a fit sees.
#include "ident/uncertainty/assumptions.h"

#include <algorithm>
#include <cmath>

#include "ident/problem/fit_problem.h"
#include "models/self_terms.h"

namespace pushid {
namespace {

constexpr double kPushedAgain = 0.3;  // s, from the end of a push to one that nobody recorded

// Calls f(push) for every measured push.
template <typename F>
void ForMeasured(PendulumRecording* r, const F& f) {
  for (ScenePush& push : r->scene.pushes) {
    if (push.kind == PushKind::kExternal && !push.force.empty()) f(&push);
  }
}

void Renew(ScenePush* push) {
  *push = MakeScenePush(push->person, push->start_frame, push->kind, std::move(push->force));
}

// Rows of pushes that were measured, or of those by inverse dynamics.
void ScaleRows(bool measured, double factor, PendulumRecording* r) {
  for (ScenePush& push : r->scene.pushes) {
    if ((push.kind == PushKind::kExternal) != measured) continue;
    for (Vector4<double>& row : push.force) row *= factor;
    Renew(&push);
  }
}

void ScaleMeasured(double eta, PendulumRecording* r) { ScaleRows(true, 1.0 + eta, r); }

// Later by eta frames, between rows by straight lines.
void Lag(double eta, PendulumRecording* r) {
  ForMeasured(r, [eta](ScenePush* push) {
    const std::vector<Vector4<double>> old = push->force;
    const int n = static_cast<int>(old.size());
    const auto at = [&old, n](int i) -> Vector4<double> {
      return i < 0 || i >= n ? Vector4<double>(Vector4<double>::Zero()) : old[i];
    };
    for (int i = 0; i < n; ++i) {
      push->force[i] =
          eta > 0.0 ? at(i) - eta * (at(i) - at(i - 1)) : at(i) - eta * (at(i + 1) - at(i));
    }
    if (eta > 0.0) push->force.push_back(eta * at(n - 1));
    Renew(push);
  });
}

// Pushes act at the hands, eta metres higher.
void Raise(double eta, PendulumRecording* r) {
  ForMeasured(r, [eta, r](ScenePush* push) {
    const std::vector<PendulumState<double>>& states = r->states[push->person];
    for (size_t i = 0; i < push->force.size(); ++i) {
      const size_t frame = std::min(states.size() - 1, push->start_frame + i);
      const Angles<double> angles(states[frame].q);
      Body lever;
      lever.rod_length = 1.0;
      const Vector4<double>& row = push->force[i];
      const Vector4<double> more =
          GeneralizedForce<double>(lever, angles, {row[0], row[1], 0.0}, eta);
      push->force[i].tail<2>() += more.tail<2>();
    }
    Renew(push);
  });
}

// The sensor reads eta newtons more, along the push and as high as it.
void Shift(double eta, PendulumRecording* r) {
  ForMeasured(r, [eta](ScenePush* push) {
    const double mean = push->mean.head<2>().norm();
    if (mean <= 0.0) return;
    for (Vector4<double>& row : push->force) row += eta / mean * push->mean;
    Renew(push);
  });
}

// All people heavier by the share eta; pushes by inverse dynamics with them.
void ScaleMasses(double eta, PendulumRecording* r) {
  for (ScenePerson& person : r->scene.people) person.body.mass *= 1.0 + eta;
  ScaleRows(false, 1.0 + eta, r);
}

// More frames a second by the share eta; forces by inverse dynamics are masses times second
// differences.
void ScaleFrameRate(double eta, PendulumRecording* r) {
  r->scene.dt /= 1.0 + eta;
  for (ScenePerson& person : r->scene.people) person.start.qd *= 1.0 + eta;
  ScaleRows(false, (1.0 + eta) * (1.0 + eta), r);
  for (auto& states : r->states) {
    for (PendulumState<double>& state : states) state.qd *= 1.0 + eta;
  }
  GroundMotion& ground = r->scene.ground;
  if (ground.moves()) ground = GroundThrough(ground.poses, r->scene.dt);
}

// Positions drift along the push, by eta metres over a recording.
void DriftAlong(double eta, PendulumRecording* r) {
  const Eigen::Vector2d along = eta * PushDirection(*r);
  const double last = std::max(1, r->num_frames() - 1);
  for (int n = 0; n < r->num_people(); ++n) {
    for (int t = 0; t < r->num_frames(); ++t) {
      r->hip[n][t].head<2>() += t / last * along;
      r->states[n][t].q.head<2>() += t / last * along;
      if (t > 0) r->states[n][t].qd.head<2>() += along / (last * r->scene.dt);
    }
  }
}

// At frames, and `between` two of them.
template <typename T, typename Between>
void Double(const Between& between, std::vector<T>* at) {
  std::vector<T> doubled;
  for (const T& next : *at) {
    if (!doubled.empty()) doubled.push_back(between(doubled.back(), next));
    doubled.push_back(next);
  }
  *at = std::move(doubled);
}

// Twice as many steps in the same time. Rows of external pushes and of the ground's acceleration
// are means about their frames (ResamplePush) and go between them by straight lines; every half of
// a step is compared with the frame at its end.
void HalveSteps(double, PendulumRecording* r) {
  r->scene.dt *= 0.5;
  for (ScenePush& push : r->scene.pushes) {
    std::vector<Vector4<double>> rows;
    for (const Vector4<double>& row : push.force) {
      if (!rows.empty()) rows.back() += 0.5 * row;
      rows.push_back(row);
      rows.push_back(0.5 * row);
    }
    if (!rows.empty()) rows[0] *= 1.5;  // with the half before it: the impulse stays
    push = MakeScenePush(push.person, 2 * push.start_frame, push.kind, std::move(rows));
  }
  GroundMotion& ground = r->scene.ground;
  ground.dt *= 0.5;
  Double([](const auto& a, const auto& b) -> GroundPose { return 0.5 * (a + b); }, &ground.poses);
  Double(
      [](const GroundStep& a, const GroundStep& b) {
        return GroundStep{0.5 * (a.acceleration + b.acceleration), 0.5 * (a.gravity + b.gravity)};
      },
      &ground.steps);
  const auto next = [](const auto&, const auto& b) { return b; };
  for (auto& of_one : r->states) Double(next, &of_one);
  for (auto& of_one : r->rod_length) Double(next, &of_one);
  for (auto& of_one : r->hip) Double(next, &of_one);
  for (auto& of_one : r->weight) Double(next, &of_one);
  for (auto& of_one : r->plates) Double(next, &of_one);
}

// Carts carry a share of the masses that is larger by eta.
void LoadCarts(double eta, PendulumRecording* r) {
  for (ScenePerson& person : r->scene.people) person.body.point_share -= eta;
}

// Measured pushes come again, eta times as strong.
void PushTwice(double eta, PendulumRecording* r) {
  const int later = static_cast<int>(std::lround(kPushedAgain / r->scene.dt));
  std::vector<ScenePush> again = r->scene.pushes;
  ForMeasured(r, [&](ScenePush* push) {
    again.push_back(*push);
    for (Vector4<double>& row : again.back().force) row *= eta;
    again.back().start_frame = push->EndFrame() + later;
    Renew(&again.back());
  });
  r->scene.pushes = std::move(again);
}

constexpr double kFactorOfTwo = 0.6931471805599453;  // its logarithm

// A parameter that is not fitted: the logarithm of a factor on it, or what is added.
Assumption Held(const ParameterSpec& spec) {
  const bool factor = spec.transform == Transform::kLog && spec.nominal > 0.0;
  const double stated = factor ? kFactorOfTwo : 0.0;
  const double step = factor ? kScaleStep : kScaleStep * spec.scale;
  return {spec.name,
          factor ? "" : spec.unit,
          stated,
          step,
          nullptr,
          [id = spec.id, factor](double eta, FitOptions* options) {
            double& value = options->table[id].nominal;
            value = factor ? value * std::exp(eta) : value + eta;
          }};
}

constexpr double kTriedDelay = 0.12;  // s

// People react late: what is fitted as damping is less by the delay times the stiffness.
Assumption Delayed(const FitProblem& problem, const FitPoint& point, double stated) {
  const ParameterSet<double> values = problem.Parameters(point, "");
  Assumption delay{kReactionDelayName, "s", stated, kTriedDelay, nullptr};
  for (const auto& [damping, stiffness] :
       {std::pair(kKdTheta, kKpTheta), std::pair(kKdPhi, kKpPhi)}) {
    const size_t i = problem.FittedIndex(damping);
    if (i == problem.map().fitted.size()) continue;
    const Transform transform = problem.Spec(i).transform;
    const double more = values[damping] + kTriedDelay * values[stiffness];
    delay.along.emplace_back(i, ToFitted(transform, more) - ToFitted(transform, values[damping]));
  }
  delay.of_options = [](double eta, FitOptions* options) {
    options->model.delay = Delay::kOne;
    options->table[kReactionDelay].nominal = eta;
    for (Parameter share : {kPassiveStiffness, kPassiveDamping}) options->table[share].nominal = 0;
  };
  return delay;
}

}  // namespace

StatedErrors Stated(const std::vector<PendulumRecording>& recordings) {
  if (recordings.empty()) return {};
  StatedErrors largest = recordings[0].stated_errors;
  for (const PendulumRecording& r : recordings) {
    for (const StatedErrorRow& row : kStatedErrors) {
      largest.*row.value = std::max(largest.*row.value, r.stated_errors.*row.value);
    }
  }
  return largest;
}

std::vector<Assumption> AssumptionsOf(const FitProblem& problem, const FitPoint& point) {
  std::vector<Assumption> all;
  bool measured = false, only_measured = true;
  for (const PendulumRecording& r : problem.recordings()) {
    for (const ScenePush& push : r.scene.pushes) {
      const bool external = push.kind == PushKind::kExternal;
      measured = measured || external;
      only_measured = only_measured && external;
    }
  }
  const StatedErrors stated = Stated(problem.recordings());
  if (measured) {
    all.push_back({"scale of the pushes", "", stated.push_scale, 1e-4, ScaleMeasured});
    all.push_back({"lag of the pushes", "frames", stated.push_lag_frames, 1e-3, Lag});
    all.push_back({"height of the pushes", "m", stated.push_height_m, 1e-4, Raise});
    all.push_back({"zero of the pushes", "N", stated.push_zero_N, 1e-2, Shift});
    all.push_back({"second pushes", "", 0.0, 1e-4, PushTwice});
  }
  all.push_back({"masses", "", stated.mass, 1e-4, ScaleMasses});
  all.push_back({"frame rate", "", stated.frame_rate, 1e-4, ScaleFrameRate, nullptr, {}, true});
  all.push_back({"drift of the cameras", "m", stated.drift_m, 1e-4, DriftAlong});
  // Net pushes were computed from the recording's own steps, and reproduce the motion with these.
  if (only_measured) {
    all.push_back({kStepName, "", 1.0, -0.5, HalveSteps, nullptr, {}, false, true});
  }
  const FitOptions& options = problem.options();
  const ModelOptions& model = options.model;
  if (model.stance == Stance::kSlide && model.body != BodyModel::kTable) {
    all.push_back({"share of the masses in the carts", "", 0.0, 1e-4, LoadCarts});
  }
  // Robots and rigs have clocks of their own, and a late difference of velocities has no meaning.
  if (model.delay == Delay::kNone && model.body != BodyModel::kTable &&
      model.cart_derivative == CartDerivative::kNone) {
    all.push_back(Delayed(problem, point, stated.reaction_delay_s));
  }
  for (const ParameterSpec& spec : options.table.specs) {
    const bool of_tail = spec.id >= kTailGain && spec.id <= kTailBase;
    const bool tested = !spec.free && !spec.tied_to && !HeldByConvention(spec.id) &&
                        !IsNoiseParameter(spec.id) && spec.id != kPushGain &&
                        Acts(spec.id, options.model) && !(of_tail && only_measured);
    if (tested) all.push_back(Held(spec));
  }
  return all;
}

}  // namespace pushid
