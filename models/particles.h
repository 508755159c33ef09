// models: a moving body as particles: points whose coordinates are followed from frame to frame.
//
// What a generator knows of the body stands in the layout alone, so that one generator serves any
// set of markers or joints: 25 joints of CMU's motion capture, 22 of the pushes.
#pragma once

#include <Eigen/Core>
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
// What acts on the body, in the same mirror: a row per control, a sign (1 or -1) each.
Eigen::MatrixXf MirroredControls(const Eigen::MatrixXf& controls, const std::vector<float>& signs);

// A row per particle, a column per frame, m; zero where there is no bone.
Eigen::MatrixXf BoneLengths(const Trajectories& motion, const ParticleLayout& layout);

// Moves every particle along its bone, parents first, so that the bone has the length it has in
// `like`: a network that predicts coordinates knows nothing of bones.
void ProjectBones(const Eigen::VectorXf& like, const ParticleLayout& layout, Trajectories* motion);

// Distances of particles, weighted: a value per frame, m.
Eigen::VectorXf MeanDistance(const Trajectories& a, const Trajectories& b,
                             const ParticleLayout& layout);

}  // namespace pushid
