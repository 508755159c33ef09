// models: all frames of a person in one pass through the network.
#include "models/restoration/window_restoration.h"

#include "models/restoration/window_features.h"

namespace pushid {

std::vector<BodyMotion> WindowRestoration::Restore(
    const std::vector<RestorationInput>& people) const {
  std::vector<BodyMotion> motions;
  for (const RestorationInput& person : people) {
    const Eigen::MatrixXf inputs = weights_.inputs.Scaled(WindowInputs(person));
    motions.push_back(MotionFromOutputs(person, weights_.network.Evaluate(inputs)));
  }
  return motions;
}

}  // namespace pushid
