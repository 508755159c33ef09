// models: restored joints together with their derivatives by the pendulum's path, in double
// precision, so that a restoration can stand in a least-squares problem.
//
// The path of a frame has six numbers, q, rod length and cart height, and its tip is
//   x + l r,   r = (sin theta, -cos theta sin phi, cos theta cos phi) on the cart at height h.
#pragma once

#include <vector>

#include "models/restoration/restoration.h"

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

}  // namespace pushid
