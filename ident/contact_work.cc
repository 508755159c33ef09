// ident: work and impulse of contact along a rollout.
#include "ident/contact_work.h"

namespace pushid {

std::vector<std::vector<Vector4<double>>> InteractionAlong(
    const Scene& scene, const ModelOptions& options,
    const std::vector<ParameterSet<double>>& parameters, const RolloutPath<double>& path) {
  std::vector<std::vector<Vector4<double>>> forces;
  for (int t = 0; t < path.num_frames(); ++t) {
    forces.push_back(InteractionForces(scene, options, parameters, path, t));
    for (int n = 0; n < scene.num_people(); ++n) {
      // A push that replaces the other forces replaces contact too.
      if (ForcesAt(scene, options.push, n, t) != ActiveForces::kAll) forces[t][n].setZero();
    }
  }
  return forces;
}

ContactBooks KeepBooks(const RolloutPath<double>& path,
                       const std::vector<std::vector<Vector4<double>>>& forces, double dt) {
  const int people = path.num_people();
  ContactBooks books;
  books.work.assign(people, 0.0);
  books.impulse.assign(people, Vector4<double>::Zero());
  for (int t = 0; t + 1 < path.num_frames(); ++t) {
    double total = 0.0;
    for (int n = 0; n < people; ++n) {
      const Vector4<double> step = path.At(t + 1, n).q - path.At(t, n).q;
      const double work = 0.5 * (forces[t][n] + forces[t + 1][n]).dot(step);
      books.work[n] += work;
      books.impulse[n] += dt * forces[t][n];
      total += work;
    }
    (total < 0.0 ? books.absorbed : books.returned) += std::abs(total);
  }
  return books;
}

Vector4<double> PushImpulse(const Scene& scene, const ModelOptions& options,
                            const ParameterSet<double>& parameters, int person, int num_frames) {
  Vector4<double> impulse = Vector4<double>::Zero();
  for (int t = 0; t + 1 < num_frames; ++t) {
    impulse += scene.dt * PushForceAt(scene, person, t);
    if (options.push_tail != PushTail::kExponential) continue;
    if (ForcesAt(scene, options.push, person, t) != ActiveForces::kAll) continue;
    for (const ScenePush& push : scene.pushes) {
      if (push.person == person) impulse += scene.dt * TailForce(push, parameters, t, scene.dt);
    }
  }
  return impulse;
}

}  // namespace pushid
