// datasets: a double inverted pendulum that balances late, and steps.
#include <algorithm>
#include <cmath>
#include <utility>

#include "datasets/files/number_text.h"
#include "datasets/synthetic/laboratory.h"

namespace pushid {
namespace {

constexpr double kG = 9.81;          // m/s^2
constexpr double kReaction = 0.15;   // s, from the loss of balance to lift-off
constexpr double kSwing = 0.3;       // s
constexpr double kClearance = 0.06;  // m
constexpr double kSwayMemory = 0.3;  // s, of the noise at the ankles

// Winter's table for both sides: shanks and thighs are the legs; feet have mass but no motion.
struct WinterSegments {
  explicit WinterSegments(const LaboratoryPerson& person)
      : m1(0.293 * person.mass_kg),
        m2(0.678 * person.mass_kg),
        c1(0.307 * person.height_m),
        c2(0.180 * person.height_m),
        l(person.RodLength()),
        i1(0.0056 * person.mass_kg * person.height_m * person.height_m),
        i2(0.0138 * person.mass_kg * person.height_m * person.height_m),
        ankle(0.039 * person.height_m),
        heel(0.030 * person.height_m),
        toe(0.090 * person.height_m),
        weight(person.mass_kg * kG) {}
  double m1, m2, c1, c2, l, i1, i2;  // kg, m, kg m^2
  double ankle;                      // height, m
  double heel, toe;                  // how far the centre of pressure goes from the ankle, m
  double weight;                     // N
};

struct TwoAngles {
  double legs = 0.0, trunk = 0.0;
};
TwoAngles operator+(TwoAngles a, TwoAngles b) { return {a.legs + b.legs, a.trunk + b.trunk}; }
TwoAngles operator*(double s, TwoAngles a) { return {s * a.legs, s * a.trunk}; }
struct Moving {
  TwoAngles q, v;
};
Moving operator+(Moving a, Moving b) { return {a.q + b.q, a.v + b.v}; }
Moving operator*(double s, Moving a) { return {s * a.q, s * a.v}; }

struct Swing {
  double from = 0.0, to = 0.0, begin = -1.0;  // m, s
  bool Now(double t) const { return begin >= 0.0 && t < begin + kSwing; }
  double Phase(double t) const { return std::clamp((t - begin) / kSwing, 0.0, 1.0); }
  double Place(double t) const {
    const double u = Phase(t);
    return from + (to - from) * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
  }
  double Acceleration(double t) const {
    if (!Now(t)) return 0.0;
    const double u = Phase(t);
    return (to - from) / (kSwing * kSwing) * u * (60.0 - 180.0 * u + 120.0 * u * u);
  }
};

class Walker {
 public:
  Walker(const LaboratoryPerson& person, const LaboratoryPush& push, int substeps)
      : person_(person), body_(person), push_(push), h_(1.0 / (kLaboratoryHz * substeps)) {
    now_.q.legs = person.lean_rad;
    tonic_ = -(body_.m1 * body_.c1 + body_.m2 * body_.l) * kG * std::sin(person.lean_rad);
  }

  double time() const { return h_ * static_cast<double>(history_.size()); }
  bool Falls() const { return std::abs(now_.q.legs) > 0.7 || std::abs(now_.q.trunk) > 1.2; }
  void SetSway(double torque) { sway_ = torque; }

  void Advance() {
    history_.push_back(now_);
    const Moving a = Slope(0.0, now_), b = Slope(0.5, now_ + 0.5 * h_ * a),
                 c = Slope(0.5, now_ + 0.5 * h_ * b), d = Slope(1.0, now_ + h_ * c);
    now_ = now_ + h_ / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  }

  // Once a sample: lifts the hind foot where balance was lost a reaction time ago.
  void Decide(LaboratoryTrial* trial) {
    const double t = time();
    const auto [back, front] = Support(t);
    const double mass = body_.m1 + body_.m2, x = Middle(t), place = CentreOfMass(now_.q, x);
    const double speed = (CentreOfMass(now_.q + 1e-6 * now_.v, x) - place) / 1e-6;
    const double height = (body_.m1 * body_.c1 + body_.m2 * (body_.l + body_.c2)) / mass;
    const double rate = std::sqrt(kG / height), beyond = place + speed / rate;
    lost_.push_back(beyond > front);
    const size_t late = static_cast<size_t>(kReaction * kLaboratoryHz);
    const bool swings = swing_[0].Now(t) || swing_[1].Now(t);
    if (swings || lost_.size() <= late || !lost_.back() || !lost_[lost_.size() - 1 - late]) return;
    const int foot = Foot(1, t) < Foot(0, t) ? 1 : 0;
    const double stand = Foot(1 - foot, t) + body_.toe;
    // Where the extrapolated centre of mass will be when the foot lands; the foot reaches past it.
    const double landing = stand + (beyond - stand) * std::exp(rate * kSwing);
    swing_[foot] = {Foot(foot, t), std::max(landing - 0.2 * body_.toe, stand), t};
    trial->steps.push_back({foot, t, t + kSwing, swing_[foot].to - swing_[foot].from});
  }

  LaboratorySample Sample() const {
    const double t = time();
    const Moving slope = Slope(1.0, now_);  // the history ends a step before
    const double torque = AnkleTorque(1.0, now_);
    const auto& [q, v] = now_;
    const auto part = [&](double arm, double angle, double rate, double turn) {
      return std::pair<double, double>(
          arm * (std::cos(angle) * turn - std::sin(angle) * rate * rate),
          -arm * (std::sin(angle) * turn + std::cos(angle) * rate * rate));
    };
    const auto legs = part(1.0, q.legs, v.legs, slope.v.legs);
    const auto trunk = part(body_.c2, q.trunk, v.trunk, slope.v.trunk);
    const double ground = MiddleAcceleration(t);
    LaboratorySample s{q.legs, q.trunk};
    s.push_N = push_.ForceAt(t);
    for (int foot : {0, 1}) {
      s.foot[foot] = Foot(foot, t);
      const double u = swing_[foot].Now(t) ? swing_[foot].Phase(t) : 0.0;
      s.foot_lift[foot] = 16.0 * kClearance * u * u * (1.0 - u) * (1.0 - u);
    }
    const double first = body_.m1 * body_.c1 + body_.m2 * body_.l;
    s.shear_N =
        first * legs.first + body_.m2 * trunk.first + (body_.m1 + body_.m2) * ground - s.push_N;
    s.vertical_N = body_.weight + first * legs.second + body_.m2 * trunk.second;
    s.centre_m = Middle(t) - (torque + body_.ankle * s.shear_N) / s.vertical_N;
    return s;
  }

 private:
  double Foot(int foot, double t) const {
    return swing_[foot].begin < 0.0 ? 0.0 : swing_[foot].Place(t);
  }
  double Middle(double t) const { return 0.5 * (Foot(0, t) + Foot(1, t)); }
  double MiddleAcceleration(double t) const {
    return 0.5 * (swing_[0].Acceleration(t) + swing_[1].Acceleration(t));
  }
  double CentreOfMass(const TwoAngles& q, double x) const {
    return x + ((body_.m1 * body_.c1 + body_.m2 * body_.l) * std::sin(q.legs) +
                body_.m2 * body_.c2 * std::sin(q.trunk)) /
                   (body_.m1 + body_.m2);
  }
  // Of the feet that stand: hindmost and foremost point.
  std::pair<double, double> Support(double t) const {
    double back = 1e9, front = -1e9;
    for (int foot : {0, 1}) {
      if (swing_[foot].Now(t)) continue;
      back = std::min(back, Foot(foot, t) - body_.heel);
      front = std::max(front, Foot(foot, t) + body_.toe);
    }
    return {back, front};
  }

  // s steps of h after the last one in the history, less the delay; at rest before.
  Moving Late(double s) const {
    const double at = static_cast<double>(history_.size()) - 1.0 + s - person_.delay_s / h_;
    if (at <= 0.0) return {{person_.lean_rad, 0.0}, {}};
    const size_t i = std::min(static_cast<size_t>(at), history_.size() - 1);
    const size_t next = std::min(i + 1, history_.size() - 1);
    const double f = at - static_cast<double>(i);
    return (1.0 - f) * history_[i] + f * history_[next];
  }

  double AnkleTorque(double s, const Moving& m) const {
    const double t = time() + (s - 1.0) * h_;
    const Moving late = Late(s);
    const LaboratoryPerson::Joint& k = person_.ankle;
    const double torque = tonic_ + sway_ - k.active * (late.q.legs - person_.lean_rad) -
                          k.active_damping * late.v.legs -
                          k.passive * (m.q.legs - person_.lean_rad) - k.passive_damping * m.v.legs;
    const auto [back, front] = Support(t);
    const double x = Middle(t);
    return std::clamp(torque, -body_.weight * (front - x), -body_.weight * (back - x));
  }

  Moving Slope(double s, const Moving& m) const {
    const double t = time() + (s - 1.0) * h_;
    const Moving late = Late(s);
    const LaboratoryPerson::Joint& k = person_.hip;
    const double hip = -k.active * late.q.trunk - k.active_damping * late.v.trunk -
                       k.passive * (m.q.trunk - m.q.legs + person_.lean_rad) -
                       k.passive_damping * (m.v.trunk - m.v.legs);
    const double ankle = AnkleTorque(s, m), force = push_.ForceAt(t),
                 ground = MiddleAcceleration(t);
    const double m1 = body_.m1, m2 = body_.m2, c1 = body_.c1, c2 = body_.c2, l = body_.l;
    const double apart = m.q.legs - m.q.trunk, across = m2 * l * c2;
    const double a = m1 * c1 * c1 + body_.i1 + m2 * l * l, b = across * std::cos(apart),
                 d = m2 * c2 * c2 + body_.i2;
    const double legs =
        (m1 * c1 + m2 * l) * (kG * std::sin(m.q.legs) - ground * std::cos(m.q.legs)) + ankle - hip +
        force * l * std::cos(m.q.legs) - across * std::sin(apart) * m.v.trunk * m.v.trunk;
    const double trunk = m2 * c2 * (kG * std::sin(m.q.trunk) - ground * std::cos(m.q.trunk)) + hip +
                         across * std::sin(apart) * m.v.legs * m.v.legs;
    const double det = a * d - b * b;
    return {m.v, {(d * legs - b * trunk) / det, (a * trunk - b * legs) / det}};
  }

  LaboratoryPerson person_;
  WinterSegments body_;
  LaboratoryPush push_;
  double h_, tonic_ = 0.0, sway_ = 0.0;
  Moving now_;
  std::vector<Moving> history_;  // of every step
  std::vector<bool> lost_;       // of every sample: balance
  Swing swing_[2];
};

}  // namespace

double LaboratoryPush::ForceAt(double t) const {
  const double u = (t - start_s) / duration_s;
  return u > 0.0 && u < 1.0 ? peak_N * std::sin(M_PI * u) : 0.0;
}

Result<LaboratoryTrial> SimulateLaboratoryTrial(const LaboratoryPerson& person,
                                                const LaboratoryPush& push, double seconds,
                                                double sway, uint64_t seed, int substeps) {
  LaboratoryTrial trial;
  Walker walker(person, push, substeps);
  Random random(seed);
  const int samples = static_cast<int>(std::lround(seconds * kLaboratoryHz)) + 1;
  const double memory = std::exp(-1.0 / (kSwayMemory * kLaboratoryHz));
  double noise = 0.0;
  for (int i = 0; i < samples; ++i) {
    noise = memory * noise + std::sqrt(1.0 - memory * memory) * sway * random.Normal();
    walker.SetSway(noise);
    walker.Decide(&trial);
    trial.samples.push_back(walker.Sample());
    if (walker.Falls()) {
      return Error{"the person falls after " + Rounded(walker.time(), 3) + " s, pushed by " +
                   Rounded(push.peak_N, 3) + " N"};
    }
    for (int k = 0; k < substeps; ++k) walker.Advance();
  }
  return trial;
}

}  // namespace pushid
