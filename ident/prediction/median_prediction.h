// ident: the predictions of an ensemble put together by their median.
#pragma once

#include <vector>

#include "ident/prediction/prediction.h"

namespace pushid {

// Frame by frame, person by person; at least one of them, all of them whole and equally long.
Prediction MedianPrediction(const PendulumRecording& recording,
                            const std::vector<Prediction>& predictions);

}  // namespace pushid
