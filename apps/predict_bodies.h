// apps: pushid-predict --restoration: whole bodies from the predicted pendulums.
#pragma once

#include <string>

#include "ident/bodies/body_recording.h"
#include "ident/prediction/prediction.h"

namespace pushid {

// Whether --out and the flags of bodies go together.
MaybeError CheckBodyFlags(const std::string& out);

// Restores, writes what the flags name and prints; returns the exit code. compare: also say how far
// the bodies are from the recorded ones.
int WriteBodies(const Recording& recording, SkeletonMapping mapping, const Prediction& prediction,
                const std::string& out, bool compare);

}  // namespace pushid
