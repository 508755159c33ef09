// models: the window's numbers.
#include "models/restoration/window_features.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pushid {
namespace {

constexpr std::array<int, 15> kLags = {0, -2, -4, -6, -8, -12, -16, -24, 2, 4, 6, 8, 12, 16, 24};
constexpr std::array<int, 5> kRateLags = {0, -12, -6, 6, 12};
constexpr std::array<int, 7> kSeenJoints = {kRightKnee,  kLeftKnee,  kRightAnkle, kLeftAnkle,
                                            kRightWrist, kLeftWrist, kBodyHead};
constexpr double kLagRate = 60.0;     // Hz
constexpr double kLongestTime = 2.0;  // s

// A pendulum's path in the heading's frame with its rates, read at any time.
class TurnedPath {
 public:
  TurnedPath(const RestorationInput& person, double heading) {
    for (const Vector4<double>& q : person.q) q_.push_back(TurnedPendulum(q, -heading));
    const int last = static_cast<int>(q_.size()) - 1;
    for (int t = 0; t <= last; ++t) {
      const int before = std::max(0, t - 1), after = std::min(last, t + 1);
      rate_.push_back((q_[after] - q_[before]) / (std::max(1, after - before) * person.dt));
    }
  }
  const Vector4<double>& First() const { return q_.front(); }
  Vector4<double> At(double frame) const { return Read(q_, frame); }
  Vector4<double> RateAt(double frame) const { return Read(rate_, frame); }

 private:
  static Vector4<double> Read(const std::vector<Vector4<double>>& values, double frame) {
    const double at = std::clamp(frame, 0.0, static_cast<double>(values.size() - 1));
    const size_t low = static_cast<size_t>(at), high = std::min(low + 1, values.size() - 1);
    const double share = at - static_cast<double>(low);
    if (share == 0.0) return values[low];
    return (1.0 - share) * values[low] + share * values[high];
  }
  std::vector<Vector4<double>> q_, rate_;
};

}  // namespace

Eigen::MatrixXf WindowInputs(const RestorationInput& person) {
  const double heading = Heading(person.first_pose);
  const TurnedPath path(person, heading);
  const Eigen::Matrix3d turn = TurnAboutZ(-heading);
  const double frames_per_lag = 1.0 / (kLagRate * person.dt);
  const double leg = LegLength(person.first_pose);
  const int frames = static_cast<int>(person.q.size());
  Eigen::MatrixXf inputs(kWindowInputs, frames);
  for (int t = 0; t < frames; ++t) {
    auto column = inputs.col(t);
    int row = 0;
    const auto add = [&column, &row](double value) { column[row++] = static_cast<float>(value); };
    const Vector4<double> now = path.At(t);
    for (const int lag : kLags) {
      const Vector4<double> q = path.At(t + lag * frames_per_lag);
      const Vector4<double>& base = lag == 0 ? path.First() : now;
      add(q[0] - base[0]), add(q[1] - base[1]);
      add(q[2] - path.First()[2]), add(q[3] - path.First()[3]);
    }
    for (const int lag : kRateLags) {
      const Vector4<double> rate = path.RateAt(t + lag * frames_per_lag);
      for (int i = 0; i < 4; ++i) add(rate[i]);
    }
    add(std::clamp(t * person.dt - person.push_start, 0.0, kLongestTime));
    add(person.body.mass), add(person.body.rod_length), add(leg);
    add(path.First()[2]), add(path.First()[3]);
    for (const int joint : kSeenJoints) {
      const Eigen::Vector3d place =
          turn * (person.first_pose.col(joint) - person.first_pose.col(0));
      for (int i = 0; i < 3; ++i) add(place[i]);
    }
  }
  return inputs;
}

Eigen::MatrixXf WindowTargets(const RestorationInput& person, const BodyMotion& motion) {
  const Eigen::Matrix3d turn = TurnAboutZ(-Heading(person.first_pose));
  Eigen::MatrixXf targets(kWindowOutputs, static_cast<int>(motion.size()));
  for (size_t t = 0; t < motion.size(); ++t) {
    for (int j = 1; j < kBodyJoints; ++j) {
      const Eigen::Vector3d shape = motion[t].col(j) - motion[t].col(0) -
                                    (person.first_pose.col(j) - person.first_pose.col(0));
      targets.block<3, 1>(3 * (j - 1), static_cast<int>(t)) = (turn * shape).cast<float>();
    }
  }
  return targets;
}

BodyMotion MotionFromOutputs(const RestorationInput& person, const Eigen::MatrixXf& outputs) {
  const Eigen::Matrix3d turn = TurnAboutZ(Heading(person.first_pose));
  BodyMotion motion(outputs.cols());
  for (int t = 0; t < static_cast<int>(motion.size()); ++t) {
    const Eigen::Vector3d tip = TipAt(person, t);
    motion[t].col(0) = tip;
    for (int j = 1; j < kBodyJoints; ++j) {
      motion[t].col(j) = tip + (person.first_pose.col(j) - person.first_pose.col(0)) +
                         turn * outputs.block<3, 1>(3 * (j - 1), t).cast<double>();
    }
  }
  return motion;
}

}  // namespace pushid
