// ident: what a fit with bodies (FitOptions::body_weight) is told of them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ident/bodies/body_recording.h"
#include "residuals/cost_functions/body_residual.h"

namespace pushid {

// Errors: a restoration that is no `window` of the pendulum alone, whose Jacobian is not known.
Result<std::shared_ptr<const BodyData>> MakeBodyData(const Restoration& restoration,
                                                     const std::vector<BodyRecording>& recordings);

// The same from a restoration's folder, which `flag` names, and loaded recordings with all joints.
Result<std::shared_ptr<const BodyData>> LoadBodyData(const std::string& folder, const char* flag,
                                                     const std::vector<Recording>& recordings,
                                                     SkeletonMapping mapping);

}  // namespace pushid
