// models: the networks of LDP's chain that are used after training: two samplers, which guess the
// latent variable from pose and pendulum, and two decoders, mixtures of experts.
//
//   lower: z = S_l(x^l_t, pendulum_t+1),  x^l_t+1 = D_l(z, x^l_t)
//   upper: c = [x^u_t, lower positions t+1],  z = S_u(c, pendulum_t+1),  x^u_t+1 = D_u(z, c)
//
// z is the sampler's mean: drawing it triples the jitter. The experts' outputs are blended, not
// their weights: the same function, since a layer is linear, and one product for a whole crowd.
#pragma once

#include <vector>

#include "models/restoration/cvae_features.h"
#include "models/restoration/dense_network.h"
#include "models/restoration/tensors.h"

namespace pushid {

inline constexpr int kLatent = 64, kExperts = 4, kCvaeHidden = 256, kGateHidden = 64;

// Three layers, the pendulum concatenated at each: [x, p] -> 256 -> 256 -> mean.
struct CvaeSampler {
  DenseLayer first, second, mean;
  Eigen::MatrixXf Evaluate(const Eigen::MatrixXf& condition, const Eigen::MatrixXf& pendulum) const;
};

// Three layers of four experts, z concatenated at each: [z, c] -> 256 -> 256 -> frame; the experts'
// weights stand below each other. The gate, a network of its own on [z, c], says how they are
// mixed.
struct CvaeDecoder {
  DenseNetwork gate;
  DenseLayer first, second, last;
  Eigen::MatrixXf Evaluate(const Eigen::MatrixXf& z, const Eigen::MatrixXf& condition) const;
};

struct CvaeWeights {
  Scaling lower, upper, pendulum;
  CvaeSampler lower_sampler, upper_sampler;
  CvaeDecoder lower_decoder, upper_decoder;
};

// One frame on: scaled frames of everybody, a column each, in place. pendulum: scaled, of the next
// frame.
void StepLower(const CvaeWeights& weights, const Eigen::MatrixXf& pendulum, Eigen::MatrixXf* lower);
// lower: already of the next frame.
void StepUpper(const CvaeWeights& weights, const Eigen::MatrixXf& pendulum,
               const Eigen::MatrixXf& lower, Eigen::MatrixXf* upper);

TensorList ToTensors(const CvaeWeights& weights);
CvaeWeights TakeCvae(TensorReader* reader);

}  // namespace pushid
