// models: the window network's joints together with their derivatives by the pendulum's path, in
// double precision, so that a restoration can stand in a least-squares problem.
//
// With S(t) = dq(t)/d(columns) and the network N of inputs x,
//   d joint_j = d tip + turn dN_j,   dN = W_3 diag(e') W_2 diag(e') W_1 dx,
// where dx reads S at the window's lags as x reads q (FillPendulumInputs), and the rod's length of
// the frame. Inputs beyond the limit of scaling have no derivative.
#pragma once

#include <vector>

#include "models/restoration/body_tangent.h"
#include "models/restoration/window_restoration.h"

namespace pushid {

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

}  // namespace pushid
