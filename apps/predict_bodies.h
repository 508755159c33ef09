// apps: pushid-predict --restoration: whole bodies from the predicted pendulums.
#pragma once

#include "apps/flags/predict_flags.h"
#include "ident/bodies/body_recording.h"
#include "ident/prediction/prediction.h"

namespace pushid {

// Restores, writes what the flags name and prints, for a whole recording also how far the bodies
// are from the recorded ones; returns the exit code.
int WriteBodies(const PredictFlags& flags, const Recording& recording, SkeletonMapping mapping,
                const Prediction& prediction);

}  // namespace pushid
