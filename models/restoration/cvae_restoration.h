// models: bodies by LDP's chain, frame after frame, everybody together.
#pragma once

#include <functional>
#include <vector>

#include "models/process_noise.h"
#include "models/restoration/cvae_features.h"
#include "models/restoration/dense_network.h"
#include "models/restoration/restoration.h"

namespace pushid {

// The networks of LDP's chain that are used after training: two samplers, which guess the
// latent variable from pose and pendulum, and two decoders, mixtures of experts.
//
//   lower: z = S_l(x^l_t, pendulum_t+1),  x^l_t+1 = D_l(z, x^l_t)
//   upper: c = [x^u_t, lower positions t+1],  z = S_u(c, pendulum_t+1),  x^u_t+1 = D_u(z, c)
//
// Without halves only the lower body's pair is there, and poses all joints. Without a pendulum
// there are no samplers: z is drawn from a standard normal three times a frame and the poses are
// averaged, as LDP does in its ablation.
//
// z is the sampler's mean: drawing it triples the jitter. The experts' outputs are blended, not
// their weights: the same function, since a layer is linear, and one product for a whole crowd.

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
  CvaeLayout layout;
  Scaling lower, upper, pendulum;  // of what the layout has
  CvaeSampler lower_sampler, upper_sampler;
  CvaeDecoder lower_decoder, upper_decoder;
};

inline constexpr int kCvaeDraws = 3;  // of z in a frame, without a pendulum

// One frame on: scaled frames of everybody, a column each, in place. pendulum: scaled, of the next
// frame. draws: of z where there is no pendulum, kLatent x kCvaeDraws, the same for everybody, so
// that the order of people changes nothing.
void StepLower(const CvaeWeights& weights, const Eigen::MatrixXf& pendulum,
               const Eigen::MatrixXf& draws, Eigen::MatrixXf* lower);
// lower: already of the next frame. Nothing happens without halves.
void StepUpper(const CvaeWeights& weights, const Eigen::MatrixXf& pendulum,
               const Eigen::MatrixXf& draws, const Eigen::MatrixXf& lower, Eigen::MatrixXf* upper);

TensorList ToTensors(const CvaeWeights& weights);
CvaeWeights TakeCvae(const CvaeLayout& layout, TensorReader* reader);

class CvaeRestoration : public Restoration {
 public:
  // draws: of z where there is no pendulum, made anew for every call of Restore.
  explicit CvaeRestoration(CvaeWeights weights, std::function<NormalSource()> draws = nullptr)
      : weights_(std::move(weights)), draws_(std::move(draws)) {}
  std::string_view kind() const override { return RowOf(RestorationKind::kCvae).name; }
  std::vector<BodyMotion> Restore(const std::vector<RestorationInput>& people) const override;
  const CvaeWeights& weights() const { return weights_; }

 private:
  CvaeWeights weights_;
  std::function<NormalSource()> draws_;
};

}  // namespace pushid
