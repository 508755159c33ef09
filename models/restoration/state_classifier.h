// models: states of people that somebody annotated, found in motion that nobody did: multinomial
// logistic regression on a few features of who moves how beside whom.
//
//   P(state k) = exp(w_k . x) / sum_j exp(w_j . x)
//   w = argmin of -log P of the annotated states + penalty / 2 |w|^2, by Newton's method
//
// x, each to zero mean and unit variance, and 1: means over +-0.25 s of
//   speed of the wrists seen from the hip, of both and of the faster; height of the higher wrist
//   above the hip; its distance to the nearest other's upper spine
//   speed of the faster ankle; of the hip; lean of the hip against the ankles; turning of the
//   shoulders; their angle to the pelvis
//   cosine between where others face and the way to me: mean and least
//   wrist speed of the others: mean and most; cosine between where I face and the ways to the
//   others, weighted by it
// Of others only means and extremes: their order does not matter. Who is alone has zeros there.
#pragma once

#include <vector>

#include "models/restoration/group_motion.h"

namespace pushid {

inline constexpr int kStateFeatures = 14;

// [person], a column per frame.
using StateFeatures = std::vector<Eigen::MatrixXd>;
StateFeatures StateFeaturesOf(const std::vector<BodyMotion>& people, double dt);

class StateClassifier {
 public:
  // A group with the states of its people, [person][frame].
  struct Annotated {
    StateFeatures features;
    std::vector<Symbols> states;
  };
  // Of num_symbols states, each of which somebody has at some frame or not.
  StateClassifier(const std::vector<const Annotated*>& groups, int num_symbols);

  // The most probable states, [person][frame].
  std::vector<Symbols> Of(const StateFeatures& features) const;

 private:
  Eigen::MatrixXd Standardized(const Eigen::MatrixXd& features) const;

  Eigen::VectorXd mean_, spread_;
  Eigen::MatrixXd weights_;  // symbols x (features and 1)
};

// Share of people and frames whose state is found.
double ShareFound(const std::vector<Symbols>& found, const std::vector<Symbols>& states);

}  // namespace pushid
