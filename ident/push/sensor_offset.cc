// ident: the offset between the clocks of force and motion.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/push/push_from_sensor.h"
#include "models/decompositions.h"

namespace pushid {
namespace {

using Eigen::VectorXd;

constexpr double kAfterPush = 0.4;  // s of motion behind the push's end that take part
constexpr int kFewestFrames = 12;
constexpr int kRefinements = 20;

// One sensor's force along the direction, integrated once and twice: exact for the broken line.
class Integrals {
 public:
  Integrals(const TimedRecord& force, const Eigen::Vector2d& direction)
      : zero_(force.frame_zero_time_s), time_(force.record.time_s) {
    for (const Eigen::Vector3d& f : force.record.force) {
      force_.push_back(f.head<2>().dot(direction));
    }
    once_.push_back(0.0);
    twice_.push_back(0.0);
    for (std::size_t i = 1; i < time_.size(); ++i) {
      double once = 0.0, twice = 0.0;
      Within(i - 1, time_[i] - time_[i - 1], &once, &twice);
      once_.push_back(once);
      twice_.push_back(twice);
    }
  }

  // At a time of the cameras plus the offset.
  void At(double t, double* once, double* twice) const {
    t += zero_;
    if (t <= time_.front()) {
      *once = *twice = 0.0;
      return;
    }
    if (t >= time_.back()) {
      *once = once_.back();
      *twice = twice_.back() + once_.back() * (t - time_.back());
      return;
    }
    const std::size_t i = std::upper_bound(time_.begin(), time_.end(), t) - time_.begin() - 1;
    Within(i, t - time_[i], once, twice);
  }

 private:
  // h behind sample i, within its interval.
  void Within(std::size_t i, double h, double* once, double* twice) const {
    const double slope = (force_[i + 1] - force_[i]) / (time_[i + 1] - time_[i]);
    *once = once_[i] + h * (force_[i] + 0.5 * h * slope);
    *twice = twice_[i] + h * (once_[i] + h * (0.5 * force_[i] + h * slope / 6.0));
  }

  double zero_;
  const std::vector<double>& time_;
  std::vector<double> force_, once_, twice_;
};

class OffsetFit {
 public:
  OffsetFit(const std::vector<TimedRecord>& forces, const PendulumRecording& recording, int person,
            const Eigen::Vector2d& direction, int frames)
      : dt_(recording.scene.dt), mass_(recording.scene.people[person].body.mass) {
    for (const TimedRecord& force : forces) integrals_.emplace_back(force, direction);
    Eigen::MatrixXd regressors(frames, 4);
    target_.resize(frames);
    weight_.resize(frames);
    double lean_once = 0.0, lean_twice = 0.0, way = 0.0, lean_before = 0.0, x_before = 0.0;
    double lean_zero = 0.0, x_zero = 0.0;
    for (int t = 0; t < frames; ++t) {
      const double x = recording.states[person][t].q.head<2>().dot(direction);
      const double hip = recording.hip[person][t].head<2>().dot(direction);
      if (t == 0) lean_zero = hip - x, x_zero = x;
      const double lean = hip - x - lean_zero, moved = x - x_zero;
      if (t > 0) {  // trapezoids
        const double once = lean_once + 0.5 * dt_ * (lean + lean_before);
        lean_twice += 0.5 * dt_ * (once + lean_once);
        lean_once = once;
        way += 0.5 * dt_ * (moved + x_before);
      }
      lean_before = lean;
      x_before = moved;
      weight_[t] = recording.Weight(person, t);
      regressors.row(t) << 1.0, t * dt_, lean_twice, way;
      target_[t] = 0.9 * hip + 0.1 * x;
    }
    pseudo_inverse_ = PseudoInverse(weight_.asDiagonal() * regressors);
    regressors_ = regressors;
  }

  // What the linear parameters leave; its derivative by tau, with them following.
  VectorXd Residual(double tau, VectorXd* derivative = nullptr) const {
    VectorXd way(target_.size()), velocity(target_.size());
    ByTheForce(tau, &way, &velocity);
    if (derivative != nullptr) *derivative = Projected(-velocity);
    return Projected(target_ - way);
  }

  // The multiple of the force that would leave least.
  double Gain(double tau) const {
    VectorXd way(target_.size()), velocity(target_.size());
    ByTheForce(tau, &way, &velocity);
    const VectorXd along = Projected(way);
    return along.dot(Projected(target_)) / along.squaredNorm();
  }

  double Count() const { return weight_.squaredNorm(); }

 private:
  // How far, and how fast, the force alone would have moved the person.
  void ByTheForce(double tau, VectorXd* way, VectorXd* velocity) const {
    for (int t = 0; t < target_.size(); ++t) {
      double once = 0.0, twice = 0.0, sum_once = 0.0, sum_twice = 0.0;
      for (const Integrals& integral : integrals_) {
        integral.At(t * dt_ + tau, &once, &twice);
        sum_once += once;
        sum_twice += twice;
      }
      (*way)[t] = sum_twice / mass_;
      (*velocity)[t] = sum_once / mass_;
    }
  }

  VectorXd Projected(const VectorXd& value) const {
    const VectorXd weighted = weight_.cwiseProduct(value);
    return weighted - weight_.asDiagonal() * (regressors_ * (pseudo_inverse_ * weighted));
  }

  double dt_, mass_;
  std::vector<Integrals> integrals_;
  VectorXd target_, weight_;
  Eigen::MatrixXd regressors_, pseudo_inverse_;
};

// Where 99 % of the force's impulse has passed, on the cameras' clock; the net direction.
double PushEnd(const std::vector<TimedRecord>& forces, Eigen::Vector2d* direction) {
  double end = 0.0;
  Eigen::Vector2d impulse = Eigen::Vector2d::Zero();
  for (const TimedRecord& force : forces) {
    const SensorRecord& r = force.record;
    double total = 0.0, sum = 0.0;
    const auto size = [&r](std::size_t i) {
      return (r.time_s[i] - r.time_s[i - 1]) * r.force[i].head<2>().norm();
    };
    for (std::size_t i = 1; i < r.time_s.size(); ++i) {
      total += size(i);
      impulse += (r.time_s[i] - r.time_s[i - 1]) * r.force[i].head<2>();
    }
    for (std::size_t i = 1; i < r.time_s.size() && sum < 0.99 * total; ++i) {
      sum += size(i);
      if (sum >= 0.99 * total) end = std::max(end, r.time_s[i] - force.frame_zero_time_s);
    }
  }
  *direction = impulse.normalized();
  return impulse.norm() > 0.0 ? end : -1.0;
}

// The way back after a push would otherwise do for a push the other way.
bool MovesAgainst(const std::vector<Vector3<double>>& hip, int frames,
                  const Eigen::Vector2d& direction) {
  double forth = 0.0, back = 0.0;
  for (int t = 0; t < frames; ++t) {
    const double way = (hip[t] - hip[0]).head<2>().dot(direction);
    forth = std::max(forth, way);
    back = std::max(back, -way);
  }
  return back > forth;
}

}  // namespace

Result<SensorOffset> EstimateSensorOffset(const std::vector<TimedRecord>& forces,
                                          const PendulumRecording& recording, int person,
                                          double max_offset_s) {
  if (person < 0 || person >= recording.num_people()) {
    return Error{"recording " + recording.id + ": there is no person " + std::to_string(person)};
  }
  if (!(max_offset_s > 0.0 && max_offset_s <= 60.0)) {
    return Error{"the largest offset must be above 0 and at most 60 s"};
  }
  Eigen::Vector2d direction;
  const double end = PushEnd(forces, &direction);
  if (forces.empty() || end < -0.5)
    return Error{"there is no horizontal force whose time could be found"};
  const double dt = recording.scene.dt;
  const int frames = std::min(recording.num_frames(),
                              static_cast<int>(std::ceil((end + max_offset_s + kAfterPush) / dt)));
  if (frames < kFewestFrames) {
    return Error{"recording " + recording.id + ": the push ends too early to find its time"};
  }
  if (recording.StepsKnown() && !recording.steps[person].Moved()) {
    return Error{
        "recording " + recording.id +
        ": the feet do not move, and how a person who stands gives way does not tell the "
        "sensor's time; give it (--sensor_start), or leave --estimate_offset out where the "
        "clocks agree"};
  }
  if (MovesAgainst(recording.hip[person], frames, direction)) {
    return Error{"recording " + recording.id +
                 ": the person moves against the force; its sign or its direction is wrong"};
  }
  const OffsetFit fit(forces, recording, person, direction, frames);
  const int steps = std::max(4, static_cast<int>(std::ceil(4.0 * max_offset_s / dt)));
  int best = 0;
  double least = 0.0;
  for (int i = -steps; i <= steps; ++i) {
    const double cost = fit.Residual(i * max_offset_s / steps).squaredNorm();
    if (i == -steps || cost < least) least = cost, best = i;
  }
  if (best == -steps || best == steps) {
    return Error{"recording " + recording.id + ": force and motion do not fit together within " +
                 Rounded(max_offset_s) +
                 " s; give the sensor's time at frame 0, or a larger --max_offset_s"};
  }
  SensorOffset result;
  result.offset_s = best * max_offset_s / steps;
  VectorXd slope, residual;
  for (int i = 0; i < kRefinements; ++i) {
    residual = fit.Residual(result.offset_s, &slope);
    const double step = -slope.dot(residual) / slope.squaredNorm();
    if (!std::isfinite(step)) return Error{"the force does not move the person"};
    result.offset_s += std::clamp(step, -dt, dt);
    if (std::fabs(step) < 1e-9) break;
  }
  residual = fit.Residual(result.offset_s, &slope);
  const double n = fit.Count(), variance = residual.squaredNorm() / std::max(1.0, n - 5.0);
  const double after = residual.head(frames - 1).dot(residual.tail(frames - 1));
  const double r = std::clamp(after / std::max(residual.squaredNorm(), 1e-300), 0.0, 0.99);
  result.standard_error_s = std::sqrt(variance / slope.squaredNorm() * (1.0 + r) / (1.0 - r));
  result.rms_m = std::sqrt(residual.squaredNorm() / n);
  result.gain = fit.Gain(result.offset_s);
  if (!(result.standard_error_s <= 0.25 * max_offset_s)) {
    return Error{"recording " + recording.id +
                 ": the sensor's time cannot be found from the motion (" +
                 Rounded(result.offset_s, 3) + " +- " + Rounded(result.standard_error_s, 2) +
                 " s); is the force in N?"};
  }
  return result;
}

}  // namespace pushid
