// People who do something that no gain can: pushes are answered by what a planted network does, and
// fits are judged by what they predict of pushes they have not seen.
#pragma once

#include <memory>
#include <vector>

#include "ident/fit/fit.h"
#include "ident/parameters/fit_options.h"
#include "ident/prediction/evaluation.h"
#include "tests/ident/fit_samples.h"

namespace pushid {

inline std::shared_ptr<const LearnedTerms> PlantedNetwork(const NetworkShape& shape) {
  LearnedTerms network{shape, InitialWeights(shape, 99)};
  Random random(98);
  for (int i = shape.output_at(); i < shape.num_weights(); ++i) {
    network.weights[i] = random.Uniform(-0.4, 0.4);
  }
  return std::make_shared<const LearnedTerms>(network);
}

struct Study {
  std::vector<PendulumRecording> training, held_out;
  FitOptions options;
};

inline Study PlantedStudy(std::shared_ptr<const LearnedTerms> planted, double noise) {
  SyntheticOptions synthetic;
  synthetic.frames = 60;
  synthetic.joint_noise_m = noise;
  synthetic.model.learned = std::move(planted);
  Study study;
  const std::vector<PendulumRecording> all = MakePendulums(synthetic);
  for (size_t i = 0; i < all.size(); ++i) {
    (i % 4 == 0 ? study.held_out : study.training).push_back(all[i]);
  }
  study.options = UnbiasedFit(synthetic);
  study.options.model.learned = nullptr;
  study.options.network_prior = 30.0;
  return study;
}

inline FitResult FitWith(const Study& study, const NetworkShape& shape, uint64_t seed = 1) {
  FitOptions options = study.options;
  options.seed = seed;
  if (shape.any()) options.model.learned = InitialNetwork(shape, seed);
  return Fit(study.training, options);
}

inline double HeldOutAde(const Study& study, const FitResult& result) {
  return Evaluate(ModelOf(result), study.held_out).model.mean.value[kHipAde];
}

}  // namespace pushid
