// models: what all restorations share, and the rigid one.
#include "models/restoration/restoration.h"

namespace pushid {

Vector3<double> TipAt(const RestorationInput& person, int frame) {
  return HipPosition(person.BodyAt(frame), person.q[frame]);
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

FramePath<Vector4<double>> TurnedPath(const RestorationInput& person, double heading) {
  std::vector<Vector4<double>> turned;
  for (const Vector4<double>& q : person.q) turned.push_back(TurnedPendulum(q, -heading));
  return {std::move(turned), person.dt};
}

namespace {

// The impulses of everybody who is pushed together, as one push on the first of them.
SeenPush PushOf(const Scene& scene, const std::vector<Pose>& first_poses) {
  SeenPush seen;
  if (scene.pushes.empty()) return seen;
  for (const ScenePush& push : scene.pushes) {
    const double duration = static_cast<double>(push.force.size()) * scene.dt;
    const double mass = scene.people[push.person].body.mass;
    seen.velocity.head<2>() += push.mean.head<2>() * (duration / mass);
    seen.duration = std::max(seen.duration, duration);
  }
  seen.place = first_poses[scene.pushes.front().person].col(kBodyHip);
  return seen;
}

}  // namespace

std::vector<RestorationInput> PeopleOf(const Scene& scene, const std::vector<Pose>& first_poses) {
  double push_start = 0.0;
  for (size_t i = 0; i < scene.pushes.size(); ++i) {
    const double start = scene.pushes[i].start_frame * scene.dt;
    push_start = i == 0 ? start : std::min(push_start, start);
  }
  const SeenPush push = PushOf(scene, first_poses);
  std::vector<RestorationInput> people(scene.num_people());
  for (int n = 0; n < scene.num_people(); ++n) {
    people[n].first_pose = first_poses[n];
    people[n].body = scene.people[n].body;
    people[n].dt = scene.dt;
    people[n].push_start = push_start;
    people[n].push = push;
  }
  return people;
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
