// models: restored joints together with their derivatives by the pendulum's path, in double
// precision, so that a restoration can stand in a least-squares problem.
//
// The path of a frame has six numbers, q, rod length and cart height, and its tip is
//   x + l r,   r = (sin theta, -cos theta sin phi, cos theta cos phi) on the cart at height h.
#pragma once

#include <vector>

#include "models/restoration/cvae_restoration.h"
#include "models/restoration/restoration.h"
#include "models/restoration/window_restoration.h"

namespace pushid {

// What the kinds have in common that are differentiable (RestorationKindRow).
class BodyTangent {
 public:
  virtual ~BodyTangent() = default;

  // Of [x, y, theta, phi, rod length, cart height] by some columns.
  static constexpr int kPathRows = 6;
  using PathBlock = Eigen::Matrix<double, kPathRows, Eigen::Dynamic>;
  using PathDerivatives = std::vector<PathBlock>;  // frame by frame

  struct Joints {
    Eigen::VectorXd positions;    // m, world: x, y, z of each of the 22 joints
    Eigen::MatrixXd derivatives;  // rows as positions, a column for each of the path's
  };
  // At some frames, in ascending order. derivatives: of as many columns in all frames; empty:
  // without.
  virtual std::vector<Joints> At(const RestorationInput& person, const PathDerivatives& derivatives,
                                 const std::vector<int>& frames) const = 0;
};

// Of TurnedPendulum.
using TurnedBlock = Eigen::Matrix<double, 4, Eigen::Dynamic>;
TurnedBlock TurnedDerivatives(const Vector4<double>& q, double angle,
                              const BodyTangent::PathBlock& derivatives);

// Of the rod's tip in the world, TipAt.
Eigen::Matrix3Xd TipDerivatives(const RestorationInput& person, int frame,
                                const BodyTangent::PathBlock& derivatives);

// The window network's joints together with their derivatives by the pendulum's path, in
// double precision, so that a restoration can stand in a least-squares problem.
//
// With S(t) = dq(t)/d(columns) and the network N of inputs x,
//   d joint_j = d tip + turn dN_j,   dN = W_3 diag(e') W_2 diag(e') W_1 dx,
// where dx reads S at the window's lags as x reads q (FillPendulumInputs), and the rod's length of
// the frame. Inputs beyond the limit of scaling have no derivative.

class WindowTangent : public BodyTangent {
 public:
  // Of a window that sees the pendulum alone (RestorationView::kPendulum).
  explicit WindowTangent(const WindowWeights& weights);

  std::vector<Joints> At(const RestorationInput& person, const PathDerivatives& derivatives,
                         const std::vector<int>& frames) const override;

 private:
  // Through the layers, in place.
  void Forward(Eigen::VectorXd* x, Eigen::MatrixXd* dx) const;

  struct Layer {
    Eigen::MatrixXd weights;
    Eigen::VectorXd bias;
  };
  Eigen::VectorXd mean_, spread_;
  std::vector<Layer> layers_;
};

// Forward mode through LDP's chain: its joints with their derivatives by the pendulum's
// path, frame after frame, z being the sampler's mean.
//
// With the pendulum p of a frame, S the sampler and D the decoder of a half of the body,
//   dz = S_x dx + S_p dp,   dx' = D_z dz + D_x dx,
// and of an expert layer, y = sum_e g_e (W_e v + b_e) with shares g = softmax(a),
//   dy = (sum_e g_e W_e) dv + sum_e (W_e v + b_e) dg_e,   dg = (diag(g) - g g') da.
// Frame 0 is given and has no derivative. Pendulums beyond the limit of scaling have none.

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
