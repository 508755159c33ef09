// models: all frames of a person in one pass through the network.
#include "models/restoration/window_restoration.h"

#include "models/restoration/window_features.h"

namespace pushid {

std::vector<BodyMotion> WindowRestoration::Restore(
    const std::vector<RestorationInput>& people) const {
  std::vector<BodyMotion> motions;
  for (int n = 0; n < static_cast<int>(people.size()); ++n) {
    const Eigen::MatrixXf inputs = weights_.inputs.Scaled(WindowInputs(people, n, weights_.view));
    motions.push_back(
        MotionFromOutputs(people[n], weights_.network.Evaluate(inputs), weights_.view));
  }
  return motions;
}

}  // namespace pushid
