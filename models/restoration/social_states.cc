// models: symbols of people in a crowd.
#include "models/restoration/social_states.h"

#include <algorithm>
#include <cmath>

namespace pushid {
namespace {

constexpr double kStepSpeed = 0.35, kPushSpeed = 0.08;  // m/s
constexpr double kLeanAngle = 5.0 * M_PI / 180.0;
constexpr double kReach = 0.35;  // m
constexpr int kNobody = -1;

Eigen::Vector3d Upright(const Pose& pose) {
  return (pose.col(kBodyHip) - 0.5 * (pose.col(kRightAnkle) + pose.col(kLeftAnkle))).normalized();
}

int InFront(const std::vector<BodyMotion>& people, size_t of) {
  int front = kNobody;
  double nearest = 0.0;
  for (size_t n = 0; n < people.size(); ++n) {
    const Eigen::Vector2d d = (people[n].front() - people[of].front()).col(kBodyHip).head<2>();
    if (!(d.x() > 0.0 && std::abs(d.y()) < d.x())) continue;
    if (front != kNobody && d.norm() >= nearest) continue;
    front = static_cast<int>(n);
    nearest = d.norm();
  }
  return front;
}

// Of frame t > 0.
int PostureSymbol(const BodyMotion& body, size_t t, double dt) {
  for (const int ankle : {kRightAnkle, kLeftAnkle}) {
    const Eigen::Vector3d way = body[t].col(ankle) - body[t - 1].col(ankle);
    if (way.head<2>().norm() > kStepSpeed * dt) return kStep;
  }
  const double cosine = Upright(body[0]).dot(Upright(body[t]));
  return std::acos(std::clamp(cosine, -1.0, 1.0)) > kLeanAngle ? kLean : kStand;
}

bool Pushes(const BodyMotion& body, const BodyMotion& front, size_t t, double dt) {
  if (!(body[t](0, kBodyHip) - body[t - 1](0, kBodyHip) > kPushSpeed * dt)) return false;
  const Eigen::Vector3d back = front[t].col(kUpperSpine);
  return (body[t].col(kRightWrist) - back).norm() < kReach ||
         (body[t].col(kLeftWrist) - back).norm() < kReach;
}

}  // namespace

std::vector<Symbols> SocialStates(const std::vector<BodyMotion>& people, double dt) {
  std::vector<Symbols> all;
  for (size_t n = 0; n < people.size(); ++n) {
    const int front = InFront(people, n);
    Symbols symbols(people[n].size(), kStand);
    for (size_t t = 1; t < symbols.size(); ++t) {
      const bool pushes = front != kNobody && Pushes(people[n], people[front], t, dt);
      symbols[t] = (pushes ? kPushStanding : kStand) + PostureSymbol(people[n], t, dt);
    }
    if (symbols.size() > 1) symbols[0] = symbols[1];
    all.push_back(std::move(symbols));
  }
  return all;
}

}  // namespace pushid
