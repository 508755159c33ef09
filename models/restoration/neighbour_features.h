// models: what the window network sees of a person's neighbours.
//
// The nearest at frame 0 in each of four quarters (ahead, behind, to the left, to the right,
// between the diagonals of the heading at frame 0), if anybody is there within 2 m, hip to hip:
//   at frame 0: its hip against the person's (x, y), m; its rod length, m; how near, exp(-(d/m)^2)
//   4 per lag of 0, +-6, +-12, 24 frames (at 60 Hz; by time at other rates): its hip against the
//     person's, less the same at frame 0 (x, y), m; how near 18
//   now: velocity of its hip against the person's (x, y), m/s; its theta and phi, rad 4
// Zeros where nobody is. Hips are the tips of the rods. In the mirror left and right change places
// by themselves, and the order of people changes nothing: of two just as near the one further left,
// or else ahead, counts.
#pragma once

#include <vector>

#include "models/restoration/restoration.h"

namespace pushid {

inline constexpr int kNeighbourQuarters = 4, kNumbersPerNeighbour = 26;
inline constexpr int kNeighbourInputs = kNeighbourQuarters * kNumbersPerNeighbour;

// The neighbours' part of the inputs of person n: kNeighbourInputs x frames of q.
Eigen::MatrixXf NeighbourInputs(const std::vector<RestorationInput>& people, int n);

}  // namespace pushid
