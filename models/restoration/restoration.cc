// models: what all restorations share, and the rigid one.
#include "models/restoration/restoration.h"

#include <algorithm>

namespace pushid {

Vector3<double> TipAt(const RestorationInput& person, int frame) {
  return HipPosition(person.body, person.q[frame]);
}

Vector4<double> TurnedPendulum(const Vector4<double>& q, double angle) {
  const Eigen::Matrix3d turn = TurnAboutZ(angle);
  const Eigen::Vector3d cart = turn * Eigen::Vector3d(q[0], q[1], 0.0);
  const Eigen::Vector3d rod =
      turn * Eigen::Vector3d(std::sin(q[2]), -std::cos(q[2]) * std::sin(q[3]),
                             std::cos(q[2]) * std::cos(q[3]));
  return {cart.x(), cart.y(), std::asin(std::clamp(rod.x(), -1.0, 1.0)),
          std::atan2(-rod.y(), rod.z())};
}

TurnedPath::TurnedPath(const RestorationInput& person, double heading) {
  for (const Vector4<double>& q : person.q) q_.push_back(TurnedPendulum(q, -heading));
  const int last = static_cast<int>(q_.size()) - 1;
  for (int t = 0; t <= last; ++t) {
    const int before = std::max(0, t - 1), after = std::min(last, t + 1);
    rate_.push_back((q_[after] - q_[before]) / (std::max(1, after - before) * person.dt));
  }
}

Vector4<double> TurnedPath::Read(const std::vector<Vector4<double>>& values, double frame) {
  const double at = std::clamp(frame, 0.0, static_cast<double>(values.size() - 1));
  const size_t low = static_cast<size_t>(at), high = std::min(low + 1, values.size() - 1);
  const double share = at - static_cast<double>(low);
  if (share == 0.0) return values[low];
  return (1.0 - share) * values[low] + share * values[high];
}

RestorationInput Mirrored(const RestorationInput& person) {
  RestorationInput mirrored = person;
  mirrored.first_pose = Mirrored(person.first_pose);
  for (Pose& pose : mirrored.seen) pose = Mirrored(pose);
  for (Vector4<double>& q : mirrored.q) q[1] = -q[1], q[3] = -q[3];
  mirrored.push.velocity.y() *= -1.0;
  mirrored.push.place.y() *= -1.0;
  return mirrored;
}

std::vector<BodyMotion> RigidRestoration::Restore(
    const std::vector<RestorationInput>& people) const {
  std::vector<BodyMotion> motions;
  for (const RestorationInput& person : people) {
    BodyMotion motion;
    for (int t = 0; t < static_cast<int>(person.q.size()); ++t) {
      const Eigen::Vector3d move = TipAt(person, t) - person.first_pose.col(0);
      motion.push_back(person.first_pose.colwise() + move);
    }
    motions.push_back(std::move(motion));
  }
  return motions;
}

}  // namespace pushid
