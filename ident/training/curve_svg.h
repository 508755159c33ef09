// ident: the course of a training as a picture.
#pragma once

#include <string>
#include <vector>

#include "models/restoration/regression_trainer.h"

namespace pushid {

// Loss against epoch, training and held-out; stages one after the other.
std::string TrainingCurveSvg(const std::vector<TrainingPoint>& curve, const std::string& title);

}  // namespace pushid
