// models: forward mode through LDP's chain: its joints with their derivatives by the pendulum's
// path, frame after frame, z being the sampler's mean.
//
// With the pendulum p of a frame, S the sampler and D the decoder of a half of the body,
//   dz = S_x dx + S_p dp,   dx' = D_z dz + D_x dx,
// and of an expert layer, y = sum_e g_e (W_e v + b_e) with shares g = softmax(a),
//   dy = (sum_e g_e W_e) dv + sum_e (W_e v + b_e) dg_e,   dg = (diag(g) - g g') da.
// Frame 0 is given and has no derivative. Pendulums beyond the limit of scaling have none.
#pragma once

#include <vector>

#include "models/restoration/body_tangent.h"
#include "models/restoration/cvae_restoration.h"

namespace pushid {

class CvaeTangent : public BodyTangent {
 public:
  // Of a chain with a pendulum (CvaeLayout::pendulum).
  explicit CvaeTangent(const CvaeWeights& weights);

  std::vector<Joints> At(const RestorationInput& person, const PathDerivatives& derivatives,
                         const std::vector<int>& frames) const override;

  // A value and its derivatives, a column each.
  struct Dual {
    Eigen::VectorXd x;
    Eigen::MatrixXd dx;
  };

 private:
  struct Layer {
    Eigen::MatrixXd weights;
    Eigen::VectorXd bias;
  };
  struct Half {
    Layer sampler[3];  // to the mean
    Layer gate[3];
    Layer experts[3];  // their rows one expert after the other
    Eigen::VectorXd mean, spread;
  };
  static Half HalfOf(const CvaeSampler& sampler, const CvaeDecoder& decoder,
                     const Scaling& scaling);
  static Dual Affine(const Layer& layer, const Dual& v);
  static Dual Mixed(const Layer& experts, const Dual& v, const Dual& shares);
  static Dual Next(const Half& half, const Dual& condition, const Dual& pendulum);

  std::vector<Dual> Pendulums(const RestorationInput& person,
                              const PathDerivatives& derivatives) const;
  // Of one frame at 60 Hz, in the world. tip: of the rod, where positions are measured from it.
  Joints JointsOf(const RestorationInput& person, const Dual& lower, const Dual& upper,
                  const Dual& tip) const;

  CvaeLayout layout_;
  CvaeWeights scalings_;  // without networks
  Half lower_, upper_;
};

}  // namespace pushid
