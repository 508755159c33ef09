// models: rollouts of doubles, and a step by jets about rest.
#include "models/rollout.h"

namespace pushid {

template RolloutStatus StepOn<double>(const Scene&, ModelStep<double>*, int, RolloutPath<double>*,
                                      FrameTable<NetForce<double>>*,
                                      const FrameTable<Vector4<double>>*);
template RolloutStatus RollOn<double>(const Scene&, ModelStep<double>*, int, RolloutPath<double>*,
                                      FrameTable<NetForce<double>>*,
                                      const FrameTable<Vector4<double>>*);
template RolloutStatus Rollout<double>(const Scene&, const ModelOptions&,
                                       const std::vector<ParameterSet<double>>&,
                                       const std::vector<Vector4<double>>&, int,
                                       RolloutPath<double>*, FrameTable<NetForce<double>>*,
                                       const double*, const FrameTable<Vector4<double>>*);

RestJacobian LinearizeAtRest(const ModelOptions& options, const SelfForce& self,
                             const ParameterSet<double>& p, RestInput by) {
  using Jet = VectorJet;
  ParameterSet<Jet> parameters;
  for (int i = 0; i < kNumParameters; ++i) parameters[i] = Jet(p[i]);
  PendulumState<Jet> moved, rest;
  Vector4<Jet> previous = Vector4<Jet>::Zero();
  for (int i = 0; i < 4; ++i) moved.qd[i] = Jet::Input(0.0, 2 + i);
  for (int i = 0; i < 2; ++i) {
    moved.q[2 + i] = Jet::Input(self.posture[i], i);
    rest.q[2 + i] = Jet(self.posture[i]);
    previous[i] = Jet::Input(0.0, 6 + i);
    moved.feet.apart[i] = rest.feet.apart[i] = Jet(self.standing.apart[i]);
  }
  const auto input = [&](RestInput own) {
    return by == RestInput::kAll || by == own ? moved : rest;
  };
  const PosedPendulum<Jet> state = input(RestInput::kState);
  Perceived<Jet> perceived;
  perceived.ankle = input(RestInput::kAnkle);
  perceived.step = input(RestInput::kStep);
  const Vector4<Jet> none = Vector4<Jet>::Zero();
  const NetForce<Jet> net = NetForceAt<Jet>(Scene(), options, self, parameters, 0, 0, state,
                                            previous, none, none, &perceived);
  const Vector4<Jet> force =
      net.Total() - Gravity<Jet>(BodyAtRest(options, self.body, parameters), state.angles);
  RestJacobian jacobian;
  jacobian.ground = net.ground.a;
  for (int row = 0; row < 4; ++row) {
    for (int i = 0; i < 6; ++i) jacobian.by_state(row, i) = force[row].Slope(i);
  }
  for (int i = 0; i < 2; ++i) jacobian.by_previous[i] = force[i].Slope(6 + i);
  return jacobian;
}

}  // namespace pushid
