// models: feet that stand, and feet that step: which foot, to which place, and when.
//
// All places are relative to the cart, the middle between the ankles, in m. h is the hip, v its
// velocity, h0 the hip in the rest posture, omega = sqrt(g / l), xi = h + v / omega the capture
// point, d half the distance between the feet, along x and y, l the rod. b, b_back and b_side are
// the parameters support_front, _back and _side; f is foot_front, kappa step_gain, t_on step_onset
// and t_s step_swing.
//
// The centre of pressure c under both feet carries the hip, h'' = omega^2 (h - c):
//   c = h0 + lim(k (h - h0) + k' v),   k = Kp / (m g l), k' = Kd / (m g l)
// lim keeps it, smoothly, within the feet: d + f in front, d + 0.05 m behind, d + 0.03 m beside the
// ankles. After a step, c controls xi instead (k = 2.5, k' = 2.5 / omega), about the middle between
// the feet once the other foot has been placed beside the one that landed, or z of the way there; z
// rises from 0 to 1 while that step is prepared. On one foot the same holds about that foot: in
// front up to b / 2 during the first step, in which people let themselves fall, and up to f after
// it. Sideways c stays between both feet, also while one is in the air: people shift their weight
// before.
//
// A step is prepared while the capture point is beyond the support. With the clock a (s),
//   rho^2 = (xi_x / (b + d_x))^2 + ((xi_y - h0_y) / (b_side + d_y))^2,   b_back where xi_x < 0
//   a' = B (1 + S(rho - 1)) + (1 - B) (w t_on / 0.6 s - (1 - w) a / 0.2 s)
//   B = 1 / (1 + exp((1 - rho) / 0.05)),   S(u) = (u + sqrt(u^2 + 0.04)) / 2,
// w = e^2 / (e^2 + (0.02 m)^2) after a step, 0 before; e is d minus its initial value for feet side
// by side, so that the rear foot is brought up. At a = t_on the foot that did not land last (at
// first the rear one; if the feet are side by side, the one on the side of xi) leaves the ground,
// for t_s + (its distance behind the other) / 4.4 m/s. With xi' the capture point at landing,
//   place = the standing foot + kappa (xi'_x - h0_x - the standing foot), at most 1.2 l; backwards
// kappa is 1, because c hardly reaches behind the foot and a shorter step would not prevent a fall;
// sideways the foot keeps its distance, plus the distance of xi' from the middle of both feet, at
// most 0.4 m. Landing changes the support, and sets a = t_on - 0.06 s if xi' is outside the new
// support too. Legs have no mass: a foot in the air moves the cart by half of its own displacement,
// without an effect on the hip.
//
// In a model of people who touch, a person pressed against the one in front does not brake with the
// toes: while the first step is prepared, f goes to b / 2 over the first third of t_on. Swings of
// strongly pushed people are quicker, t_s / (1 + S(rho - 1) / 4) with rho at lift-off.
//
// Lift-off and landing are at times within a step of the rollout: the clock continues from there,
// and c is the mean over the step. The duration of the swing and the clock at landing are
// interpolated between the frames before and after, and are known one step later. Paths are
// therefore continuous in the parameters, except for which foot steps and whether it does.
//
// During a `net` push there is no ground force, since the push includes the feet's reaction. From a
// `net_without_friction` push LDP's friction of 100 N s/m was subtracted; here it is added again.
//
// Sources: capture point and support, Hof, Human Movement Science 2008; capturability, Koolen et
// al., Int. J. Robotics Research 2012. The clock and the numbers without a name were chosen by the
// predictions for people left out, and by whether strongly pushed people come to rest. Rejected: a
// clock independent of the distance of xi from the support (steps at 0.2 m/s already), support
// relative to the hip's place at rest, c under one foot always up to b or always up to b / 2
// (strongly pushed people fall), a cart that follows the capture point (strongly pushed people walk
// on), and the law of people who touch for single people (worse predictions of people left out).
#pragma once

#include <cmath>

#include "models/reaction_delay.h"
#include "models/support.h"

namespace pushid {

// Effects of standing and stepping on a person in one step of the rollout.
template <typename T>
struct StanceForces {
  Horizontal<T> torque;    // N m, of the ankles
  Horizontal<T> velocity;  // m/s, of the cart: half that of the foot in the air
  FeetState<T> next;       // the feet after the step
};

// One step of the rollout.
template <typename T>
class StanceStep : StanceNumbers {
 public:
  // ankle: the hip as the ankles feel it; xi: as the feet do.
  StanceStep(const StanceBody& body, const StanceParameters<T>& p, const FeetState<T>& feet,
             const HipOverFeet<T>& ankle, const Horizontal<T>& xi)
      : body_(body),
        p_(p),
        feet_(feet),
        ankle_(ankle),
        xi_(xi),
        d_(HalfApart(feet)),
        rest_{body.rest[0], body.rest[1]} {}

  StanceForces<T> Run() {
    if (feet_.fresh) Complete();
    if (feet_.swings == 0) {
      Stand();
    } else {
      Swing(feet_);
    }
    const double weight = body_.weight;
    const Horizontal<T> carried = pressure_ + Carried();
    out_.torque = {body_.hold[0] - weight * (carried[0] - rest_[0]),
                   body_.hold[1] + weight * (carried[1] - rest_[1])};
    return out_;
  }

 private:
  // A rod that leans by an angle e takes sin(e)^2 of its cart's acceleration along: the c that
  // takes that back, since legs have no mass.
  Horizontal<T> Carried() const {
    const double by = 1.0 / (body_.rod_length * kGravity * body_.dt);
    return by * ankle_.place.cwiseProduct(ankle_.place).cwiseProduct(out_.velocity - ankle_.cart);
  }

  // a' above.
  T ClockRate() const {
    using std::exp;
    const T over = Over(xi_);
    const T beyond = 1.0 / (1.0 + exp(over * (-1.0 / kSupportEdge)));
    T otherwise = feet_.clock * (-1.0 / kForgets);
    if (feet_.landed != 0) {
      const T wide = SpreadSideways(), far = d_[0] * d_[0] + wide * wide;
      const T stride = far / (far + kShortStride * kShortStride);
      otherwise = stride * p_.onset * (1.0 / kBringsUp) + (1.0 - stride) * otherwise;
    }
    return beyond * (1.0 + Rush(over)) + (1.0 - beyond) * otherwise;
  }

  // rho - 1 above, and S of it.
  T Over(const Horizontal<T>& xi) const {
    return SupportRatio<T>(p_, {xi[0], xi[1] - rest_[1]}, d_) - 1.0;
  }
  static T Rush(const T& over) {
    using std::sqrt;
    return 0.5 * (over + sqrt(over * over + kRushEdge * kRushEdge));
  }

  void Stand() {
    const double dt = body_.dt;
    const T rate = ClockRate();
    const T clock = feet_.clock + dt * rate;
    out_.next = feet_;
    out_.next.clock = clock;
    out_.velocity = {T(0.0), T(0.0)};
    pressure_ = StandingPressure();
    if (!(RealPart(clock) > RealPart(p_.onset))) return;
    const T late = (clock - p_.onset) / rate;  // s, since lift-off
    FeetState<T> lifted = feet_;
    lifted.swings = LiftedFoot();
    lifted.swing_time = SwingTime(lifted.swings);
    lifted.fresh = true;
    lifted.clock = late - dt;  // so that it is `late` after this step
    const Horizontal<T> standing = pressure_;
    Swing(lifted);
    if (RealPart(late) < dt) {
      pressure_ = standing + (late * (1.0 / dt)) * (pressure_ - standing);
    }
  }

  // Completes a lift-off or landing within the last step, from the frame before and this one.
  void Complete() {
    const T since = feet_.swings != 0 ? feet_.clock : feet_.swing_time;
    const T before = RealPart(since) < body_.dt ? T(since * (1.0 / body_.dt)) : T(1.0);
    if (feet_.swings != 0) {
      feet_.swing_time += (1.0 - before) * (SwingTime(feet_.swings) - feet_.swing_time);
    } else {
      feet_.clock += (1.0 - before) * (ClockOnLanding() - feet_.clock);
      feet_.swing_time = T(0.0);
    }
    feet_.fresh = false;
  }

  // foot: which lifts off, 1 or -1.
  T SwingTime(double foot) const {
    const Horizontal<T> behind = -foot * feet_.apart;  // the standing foot from it
    const T along = behind[0] * Direction()[0] + behind[1] * Direction()[1];
    T time = p_.swing;
    if (body_.among_others) time = time / (1.0 + kQuicker * Rush(Over(xi_)));
    return RealPart(along) > 0.0 ? T(time + along * (1.0 / kFootSpeed)) : time;
  }

  T ClockOnLanding() const {
    using std::exp;
    const T prepared = p_.onset - kAgain;
    return (RealPart(prepared) > 0.0 ? prepared : T(0.0)) /
           (1.0 + exp(Over(xi_) * (-1.0 / kSupportEdge)));
  }

  // Direction of xi from the middle of the support, by its extent: a unit vector.
  Horizontal<T> Direction() const {
    using std::sqrt;
    const T front = (RealPart(xi_[0]) < 0.0 ? p_.back : p_.front) + d_[0];
    const T x = xi_[0] / front, y = (xi_[1] - rest_[1]) / (p_.side + d_[1]);
    const T norm = sqrt(x * x + y * y + 1e-12);
    return {x / norm, y / norm};
  }

  // How far half the feet are farther apart along y than they were.
  T SpreadSideways() const { return d_[1] - 0.5 * std::abs(body_.apart[1]); }

  signed char LiftedFoot() const {
    const double far = std::hypot(RealPart(d_[0]), RealPart(SpreadSideways()));
    if (feet_.landed != 0 && far > kAbreast) return -feet_.landed;
    const double ahead = RealPart(feet_.apart[0]) * RealPart(Direction()[0]);  // the left foot
    if (std::abs(ahead) > kStaggered) return ahead > 0.0 ? -1 : 1;
    return RealPart(xi_[1]) >= RealPart(rest_[1]) ? 1 : -1;
  }

  // k (h - from) + k' v above.
  T Pressure(int i, const T& from) const {
    const T off = ankle_.place[i] - from;
    if (feet_.landed != 0) {
      return kCaptureGain * (off + (1.0 / body_.capture_rate) * ankle_.velocity[i]);
    }
    const double moment = body_.weight * body_.rod_length;
    return (body_.stiffness / moment) * p_.Kp[i] * off +
           (body_.damping / moment) * p_.Kd[i] * ankle_.velocity[i];
  }
  // foot: that which will stay, 1 or -1; how_far: of the way towards where it will be one of two.
  T Sideways(double foot, const T& how_far) const {
    const T from = how_far * (0.5 * foot) * (feet_.apart[1] - body_.apart[1]) + rest_[1];
    return rest_[1] + SmoothLimit<T>(from - rest_[1] + Pressure(1, from), d_[1] + kFootSide);
  }
  T Forwards(const T& foot, const T& from, const T& back, const T& front) const {
    const T start = foot + rest_[0], wanted = from - start + Pressure(0, from);
    const T most = RealPart(wanted) < 0.0 ? T(back + rest_[0]) : T(front - rest_[0]);
    return start + SmoothLimit<T>(wanted, RealPart(most) > kLeastReach ? most : T(kLeastReach));
  }
  Horizontal<T> StandingPressure() const {
    const double foot = feet_.landed;
    const T rise = foot != 0.0 ? SmoothRise(T(feet_.clock / p_.onset)) : T(0.0);
    const T from = rise * (0.5 * foot) * feet_.apart[0] + rest_[0];
    return {Forwards(T(0.0), from, d_[0] + kFootBack, d_[0] + FrontReach()), Sideways(foot, rise)};
  }
  // Reach of c before the foremost ankle.
  T FrontReach() const {
    if (!body_.among_others || feet_.landed != 0) return p_.foot_front;
    const T falls = SmoothRise(T(feet_.clock * kLetsFall / p_.onset));
    return p_.foot_front + falls * (0.5 * p_.front - p_.foot_front);
  }

  // Goes on with the foot in the air, which was as in `feet` when the step began; its clock may be
  // negative: then it leaves during the step.
  void Swing(const FeetState<T>& feet) {
    using std::exp;
    const double dt = body_.dt, omega = body_.capture_rate;
    const T& total = feet.swing_time;
    const Horizontal<T> own = (0.5 * feet.swings) * feet.apart, stands = -own;
    pressure_ = {Forwards(stands[0], T(stands[0] + rest_[0]), T(kFootBack),
                          feet_.landed != 0 ? p_.foot_front : T(0.5 * p_.front)),
                 Sideways(-feet.swings, T(feet_.landed != 0 ? 1.0 : 0.0))};
    const T left = total - feet.clock, after = feet.clock + dt;
    const bool lands = RealPart(after) >= RealPart(total);
    const T growth = exp(omega * (RealPart(left) > 0.0 ? left : T(0.0)));
    const Horizontal<T> landing = pressure_ + growth * (xi_ - pressure_);  // xi' above
    Horizontal<T> place;
    const T ahead = landing[0] - rest_[0] - stands[0];
    place[0] = stands[0] + SmoothLimit<T>(RealPart(ahead) < 0.0 ? ahead : p_.gain * ahead,
                                          T(kReach * body_.rod_length));
    const double lane = feet.swings * body_.apart[1];
    place[1] = stands[1] + lane +
               SmoothLimit<T>(landing[1] - rest_[1] - stands[1] - 0.5 * lane, T(kSideReach));
    T way = RealPart(left) > 0.0 ? T(left * (1.0 / dt)) : T(0.0);  // of what is left of it
    if (!lands) {
      const T before = SmoothRise(T(feet.clock / total));
      way = (SmoothRise(T(after / total)) - before) / (1.0 - before);
    }
    const Horizontal<T> gone = way * (place - own);
    out_.velocity = (0.5 / dt) * gone;
    out_.next = feet;
    out_.next.apart = feet.apart + double(feet.swings) * gone;
    out_.next.clock = after;
    if (lands) Land(gone, landing, T(after - total));
  }

  // gone: by the foot in this step; landing: xi then, seen from where the ankles were; since: s.
  void Land(const Horizontal<T>& gone, const Horizontal<T>& landing, const T& since) {
    FeetState<T>& next = out_.next;
    next.landed = next.swings;
    next.swings = 0;
    HipOverFeet<T> hip = ankle_;
    hip.place -= 0.5 * gone;
    StanceStep then(body_, p_, next, hip, landing - 0.5 * gone);
    then.feet_.clock = then.ClockOnLanding();
    pressure_ += (since * (1.0 / body_.dt)) * (then.StandingPressure() + 0.5 * gone - pressure_);
    next.clock = then.feet_.clock + body_.dt * then.ClockRate();  // after a whole step
    next.swing_time = since;
    next.fresh = true;
  }

  const StanceBody& body_;
  const StanceParameters<T>& p_;
  FeetState<T> feet_;
  const HipOverFeet<T> ankle_;
  const Horizontal<T> xi_, d_;
  const double rest_[2];
  Horizontal<T> pressure_;
  StanceForces<T> out_;
};

template <typename T>
StanceForces<T> StanceAt(const StanceBody& body, const StanceParameters<T>& p,
                         const FeetState<T>& feet, const PosedPendulum<T>& ankle,
                         const PosedPendulum<T>& step) {
  const HipOverFeet<T> felt(body, step.angles, step.qd);
  return StanceStep<T>(body, p, feet, {body, ankle.angles, ankle.qd}, felt.Capture(body)).Run();
}

}  // namespace pushid
