// models: which forces act when, and what does not depend on the scalar.
#include "models/net_force.h"

namespace pushid {

ActiveForces ForcesAt(const Scene& scene, PushUse use, int person, int frame) {
  ActiveForces active = ActiveForces::kAll;
  if (use == PushUse::kAdded) return active;
  for (const ScenePush& push : scene.pushes) {
    if (push.person != person || !push.Active(frame)) continue;
    if (push.kind == PushKind::kNet) return ActiveForces::kPushOnly;
    if (push.kind == PushKind::kNetWithoutFriction) active = ActiveForces::kPushAndFriction;
  }
  return active;
}

Vector4<double> PushForceAt(const Scene& scene, int person, int frame) {
  Vector4<double> sum = Vector4<double>::Zero();
  for (const ScenePush& push : scene.pushes) {
    if (push.person == person && push.Active(frame)) sum += push.force[frame - push.start_frame];
  }
  return sum;
}

std::vector<ForcePart> ReportedParts(const ModelOptions& options) {
  std::vector<ForcePart> parts;
  for (const auto& [name, part] : kForceParts) {
    if (part == ForcePart::kNoise) continue;  // a model's rollout is without
    if (part == ForcePart::kOwn && options.own_laws.empty()) continue;
    if (part == ForcePart::kInertia) continue;  // listed where the ground moves
    parts.push_back(part);
  }
  return parts;
}

std::vector<SelfForce> SelfForces(const Scene& scene, const ModelOptions& options) {
  std::vector<SelfForce> self;
  self.reserve(scene.people.size());
  for (const ScenePerson& person : scene.people) {
    self.emplace_back(options, person.body, person.start.q, scene.dt);
    for (int i = 0; i < 2; ++i) self.back().standing.apart[i] = person.start.feet.apart[i];
  }
  return self;
}

}  // namespace pushid
