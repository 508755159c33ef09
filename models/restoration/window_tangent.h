// models: the window network's joints together with their derivatives by the pendulum's path, in
// double precision, so that a restoration can stand in a least-squares problem.
//
// With S(t) = dq(t)/d(columns) and the network N of inputs x,
//   d joint_j = d tip + turn dN_j,   dN = W_3 diag(e') W_2 diag(e') W_1 dx,
// where dx reads S at the window's lags as x reads q (FillPendulumInputs). Inputs beyond the limit
// of scaling have no derivative.
#pragma once

#include <vector>

#include "models/restoration/window_restoration.h"

namespace pushid {

class WindowTangent {
 public:
  // Of a window that sees the pendulum alone (RestorationView::kPendulum).
  explicit WindowTangent(const WindowWeights& weights);

  using PathDerivatives = std::vector<Eigen::Matrix<double, 4, Eigen::Dynamic>>;

  struct Joints {
    Eigen::VectorXd positions;    // m, world: x, y, z of each of the 22 joints
    Eigen::MatrixXd derivatives;  // rows as positions, a column for each of the path's
  };
  // At some frames. derivatives: of q, frame by frame, of as many columns; empty: without.
  std::vector<Joints> At(const RestorationInput& person, const PathDerivatives& derivatives,
                         const std::vector<int>& frames) const;

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
