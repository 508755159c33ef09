// models: inputs of restorations, and the rigid restoration.
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

std::vector<RestorationInput> PeopleOf(const Scene& scene, const std::vector<Pose>& first_poses) {
  RestorationInput alike;  // the fields that are the same for all people
  alike.dt = scene.dt;
  // The pushes on all people count as one push on the first pushed person.
  SeenPush& seen = alike.push;
  for (const ScenePush& push : scene.pushes) {
    const bool is_first = &push == &scene.pushes.front();
    const double start = push.start_frame * scene.dt;
    const double duration = static_cast<double>(push.force.size()) * scene.dt;
    alike.push_start = is_first ? start : std::min(alike.push_start, start);
    seen.velocity.head<2>() +=
        push.mean.head<2>() * (duration / scene.people[push.person].body.mass);
    seen.duration = std::max(seen.duration, duration);
    if (is_first) seen.place = first_poses[push.person].col(kBodyHip);
  }
  std::vector<RestorationInput> people(scene.num_people(), alike);
  for (int n = 0; n < scene.num_people(); ++n) {
    people[n].first_pose = first_poses[n];
    people[n].body = scene.people[n].body;
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
