// ident: work and impulse of contact along a rollout.
#include "ident/prediction/contact_work.h"

namespace pushid {

ContactEnergyBalance BalanceContactEnergy(const RolloutPath<double>& path, const ForceTrace& forces,
                                          double dt) {
  const int people = path.num_people();
  ContactEnergyBalance balance;
  balance.work.assign(people, 0.0);
  balance.impulse.assign(people, Vector4<double>::Zero());
  for (int t = 0; t + 1 < path.num_frames(); ++t) {
    double total = 0.0;
    for (int n = 0; n < people; ++n) {
      const Vector4<double> step = path.At(t + 1, n).q - path.At(t, n).q;
      const Vector4<double>& now = forces.At(t, n)[ForcePart::kInteraction];
      const double work = 0.5 * (now + forces.At(t + 1, n)[ForcePart::kInteraction]).dot(step);
      balance.work[n] += work;
      balance.impulse[n] += dt * now;
      total += work;
    }
    (total < 0.0 ? balance.absorbed : balance.returned) += std::abs(total);
  }
  return balance;
}

Vector4<double> PushImpulse(const ForceTrace& forces, int person, double dt) {
  Vector4<double> impulse = Vector4<double>::Zero();
  for (int t = 0; t + 1 < forces.num_frames(); ++t) {
    const NetForce<double>& force = forces.At(t, person);
    impulse += dt * (force[ForcePart::kPush] + force[ForcePart::kTail]);
  }
  return impulse;
}

}  // namespace pushid
