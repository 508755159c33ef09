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
// A sampler gives a Gaussian: z is its mean (CvaeLatent::kMean), or mu + sigma eps, eps drawn anew
// for every frame and half of the body (kDraw). The experts' outputs are blended, not
// their weights: the same function, since a layer is linear, and one product for a whole crowd.

inline constexpr int kLatent = 64, kExperts = 4, kCvaeHidden = 256, kGateHidden = 64;

enum class CvaeLatent { kMean, kDraw };
constexpr EnumNames<CvaeLatent, 2> Names(CvaeLatent) {
  return {{{"mean", CvaeLatent::kMean}, {"draw", CvaeLatent::kDraw}}};
}

// Three layers, the pendulum concatenated at each: [x, p] -> 256 -> 256 -> mean and log-variance.
struct CvaeSampler {
  DenseLayer first, second, mean, log_variance;  // the last: of layouts with sigma
  // eps: a column for everybody; none: the mean.
  Eigen::MatrixXf Evaluate(const Eigen::MatrixXf& condition, const Eigen::MatrixXf& pendulum,
                           const Eigen::MatrixXf& eps) const;
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
// frame. draws: standard normal numbers, kLatent x kCvaeDraws where there is no pendulum (z), one
// column (eps) or none (the mean) with samplers; the same for everybody, so that the order of
// people changes nothing.
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
  bool CanDraw() const { return weights_.layout.pendulum && weights_.layout.sigma; }
  // From here on z is drawn from the samplers' Gaussians (CanDraw); every call of Restore takes its
  // normal numbers from `draws` anew.
  void DrawLatent(std::function<NormalSource()> draws) {
    latent_ = CvaeLatent::kDraw;
    draws_ = std::move(draws);
  }

 private:
  int NumDraws() const;  // columns of draws in a step

  CvaeWeights weights_;
  std::function<NormalSource()> draws_;
  CvaeLatent latent_ = CvaeLatent::kMean;
};

}  // namespace pushid
