// ident: what groups do where hips alone are predicted, as pendulums do.
//
// Who begins to move when is told by the hips. The measures of what people do (sscp, sscp_changes,
// ndms) need bodies: each recorded first pose is carried by the predicted hip and never steps, as
// `rigid` bodies do (bodies/body_evaluation.h). Where recordings have no bodies they have no value.
#pragma once

#include <optional>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/results/model_rollout.h"
#include "ident/validation/group_metrics.h"

namespace pushid {

// [recording][person]; empty where bodies are not known.
using RecordedBodies = std::vector<std::vector<BodyMotion>>;

// Of one recording, which may be predicted several times.
struct PredictedGroup {
  int recording = 0;
  HipPaths hips;  // [person][frame], m
};

// Nothing where nothing was predicted.
std::optional<GroupMetrics> CompareHips(const std::vector<PendulumRecording>& recordings,
                                        const RecordedBodies& bodies,
                                        const std::vector<PredictedGroup>& predicted);

}  // namespace pushid
