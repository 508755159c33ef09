// models: rollouts of doubles.
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

}  // namespace pushid
