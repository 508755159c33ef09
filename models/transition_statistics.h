// models: how often one symbol follows another, and how unlike two such statistics are: the
// comparison of symbolic social cues (SSCP) of Tanke et al., ICCV 2023 (called SDM), for any
// symbols.
//
//   P[a][b]  share of the steps that lead from symbol a to symbol b; all of them sum to 1
//   D(p, q) = sqrt((KL(p | m) + KL(q | m)) / 2), m = (p + q) / 2, natural logarithm
//
// D is Jensen and Shannon's distance: 0 of equal statistics, sqrt(ln 2) of disjoint ones.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace pushid {

using Symbols = std::vector<int>;  // of one person, frame by frame; from 0 on

enum class Transitions {
  kAll,     // most of them from a symbol to itself
  kChanges  // between different symbols alone
};

// Counts of steps, symbols x symbols.
Eigen::MatrixXd CountTransitions(const std::vector<Symbols>& people, int num_symbols,
                                 Transitions which);

// Of counts or shares, which are normalized here. No value where either of them is all zero.
std::optional<double> JensenShannon(const Eigen::MatrixXd& p, const Eigen::MatrixXd& q);

}  // namespace pushid
