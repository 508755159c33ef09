// models: a moving body as particles: points whose coordinates are followed from frame to frame.
//
// All that a generator knows of the body stands in the layout, so that one generator serves any
// set of markers or joints: 25 joints of CMU's motion capture, 22 of the pushes.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace pushid {

// x, y, z of the first particle, then of the next, ... in a column a frame; m.
using Trajectories = Eigen::MatrixXf;

inline constexpr int kFixedPoint = -1, kNoBone = -2;  // a hip in the world has no bone

struct ParticleLayout {
  std::vector<std::string> names;
  std::vector<int> mirrored;   // the particle on the other side of the body
  int up_axis = 2;             // 0 x, 1 y, 2 z
  int mirrored_axis = 0;       // whose sign a mirror changes: 0 x, 1 y, 2 z
  std::vector<int> parents;    // the other end of its bone, before it; or one of those below
  Eigen::Matrix3Xf fixed;      // the other end where it is kFixedPoint; m
  std::vector<float> weights;  // in means over joints: how many a particle stands for
  int joints = 0;              // what such a mean is divided by

  int num_particles() const { return static_cast<int>(names.size()); }
  int num_coordinates() const { return 3 * num_particles(); }
};

Trajectories Mirrored(const Trajectories& motion, const ParticleLayout& layout);

// A row per particle, a column per frame, m; zero where there is no bone.
Eigen::MatrixXf BoneLengths(const Trajectories& motion, const ParticleLayout& layout);

// The transform over time by which networks read and write motions: the orthonormal DCT-II of
// `frames` values: row k of the matrix gives coefficient k, and the matrix transposed gives the
// values back.
Eigen::MatrixXd CosineTransform(int frames);

// Moves every particle along its bone, parents first, so that the bone has the length it has in
// `like`: a network that predicts coordinates knows nothing of bones.
void ProjectBones(const Eigen::VectorXf& like, const ParticleLayout& layout, Trajectories* motion);

// Distances of particles, weighted: a value per frame, m.
Eigen::VectorXf MeanDistance(const Trajectories& a, const Trajectories& b,
                             const ParticleLayout& layout);

// Joint positions of a body that is given by exponential maps, one rotation vector a joint.
//
// With row vectors, as the data's literature has them: R_i = Rodrigues(r_i) with angle |r_i| and
// axis r_i / (|r_i| + 1e-7). A joint with parent p > 0 turns with it, R_i <- R_i R_p, and stands at
// x_i = offset_i R_p + x_p; a joint whose parent is the root, and the root, keep R_i and stand at
// their offset. So the pose has neither the place nor the heading of the body.

struct JointTree {
  std::vector<int> parents;  // -1: the root; every parent precedes its children
  Eigen::Matrix3Xd offsets;  // a column a joint, m

  int num_joints() const { return static_cast<int>(parents.size()); }
};

// Turns row vectors: x R.
Eigen::Matrix3d Rodrigues(const Eigen::Vector3d& map);

// A column a joint, m. maps: three numbers a joint.
Eigen::Matrix3Xd JointPositions(const JointTree& tree, const Eigen::VectorXd& maps);

// Transition frequencies of symbols and the distance between two of them: the comparison of
// symbolic social cues (SSCP) of Tanke et al., ICCV 2023 (called SDM), for any symbols.
//
//   P[a][b]  share of the steps that lead from symbol a to symbol b; all of them sum to 1
//   D(p, q) = sqrt((KL(p | m) + KL(q | m)) / 2), m = (p + q) / 2, natural logarithm
//
// D is the Jensen-Shannon distance: 0 for equal frequencies, sqrt(ln 2) for disjoint ones.

using Symbols = std::vector<int>;  // of one person, frame by frame; from 0 on

enum class Transitions {
  kAll,     // most of them from a symbol to itself
  kChanges  // between different symbols alone
};

// Counts of steps, symbols x symbols.
Eigen::MatrixXd CountTransitions(const std::vector<Symbols>& people, int num_symbols,
                                 Transitions which);

// Distance of counts or shares, which are normalized here. No value where either is all zero.
std::optional<double> JensenShannon(const Eigen::MatrixXd& p, const Eigen::MatrixXd& q);

}  // namespace pushid
