// models: what MRT (mrt_network.h) is told of a group, and how its outputs become motion.
//
// Everybody's motion is told as displacements from frame to frame, transformed by cosines over
// time, in the heading of the person who is asked for, at the last given frame. So nothing depends
// on where a group stands or which way it faces.
#pragma once

#include <vector>

#include "models/restoration/body.h"
#include "models/restoration/dense_network.h"

namespace pushid {

inline constexpr int kMrtGiven = 20, kMrtFrames = 20;  // seen, and predicted at once
inline constexpr int kMrtTokens = kMrtGiven - 1;       // cosine coefficients, of a person
inline constexpr int kMrtPoseRows = 3 * kBodyJoints;
inline constexpr int kMrtPlaceRows = 5;
inline constexpr int kMrtQueryRows = 2 * kMrtPoseRows;

// What is told when one of a group is asked for.
struct MrtView {
  int person = 0;          // who is asked for
  Eigen::MatrixXf tokens;  // kMrtPoseRows x (kMrtTokens people); a person's coefficients, lowest
                           // first, then the next person's
  Eigen::MatrixXf places;  // kMrtPlaceRows x people: where a hip is from the asked one's, x and y
                           // in m; exp(-distance^2 / m^2); sine and cosine of the way it faces
  Eigen::VectorXf query;   // the asked one's last pose from its hip (the hip: its height), and its
                           // last displacement, both in m

  int num_people() const { return static_cast<int>(places.cols()); }
};

// people: everybody of one recording; of the frames [last - 19, last].
MrtView MrtViewOf(const std::vector<BodyMotion>& people, int last, int person);

// kMrtPoseRows x kMrtFrames: ways from the pose of `last` to the frames after it, m, in its
// heading.
Eigen::MatrixXf MrtWays(const BodyMotion& motion, int last);

// A column per coefficient of the displacements <-> a column per way; one is the other's inverse.
Eigen::MatrixXf MrtCoefficientsOf(const Eigen::MatrixXf& ways);
Eigen::MatrixXf MrtWaysOf(const Eigen::MatrixXf& coefficients);

// The matrix by which coefficients are multiplied from the right to give ways.
const Eigen::MatrixXf& MrtWaysMatrix();

// The numbers of a view and of what is asked, brought to spread 1. Rows of tokens are those of one
// person below one another (kMrtPoseRows kMrtTokens), and so are those of outputs.
struct MrtScalings {
  Scaling tokens, query, outputs;
};
MrtView Scaled(const MrtScalings& scalings, MrtView view);

// Of all people of groups at every `stride`-th frame that has enough before and after it. Empty
// where there is none.
MrtScalings MrtScalingsOf(const std::vector<std::vector<BodyMotion>>& groups, int stride);

}  // namespace pushid
