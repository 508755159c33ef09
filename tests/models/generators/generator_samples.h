// Particles of four points that sway, and networks of random weights, for tests of generators.
#pragma once

#include "datasets/files/random.h"
#include "models/generators/particle_generator.h"

namespace pushid {

// A spine on a fixed point, a head on it, an arm to each side.
inline ParticleLayout FourParticles() {
  ParticleLayout layout;
  layout.names = {"spine", "head", "left", "right"};
  layout.up_axis = 1;
  layout.mirrored_axis = 0;
  layout.mirrored = {0, 1, 3, 2};
  layout.parents = {kFixedPoint, 0, 1, 1};
  layout.fixed = Eigen::Matrix3Xf::Zero(3, 4);
  layout.weights = {2.0f, 1.0f, 1.0f, 1.0f};
  layout.joints = 6;
  return layout;
}

// About 0.3 m long bones; every motion sways in its own phase.
inline Trajectories SwayingMotion(int frames, float phase, float size = 0.1f) {
  Trajectories motion(12, frames);
  for (int t = 0; t < frames; ++t) {
    const float x = size * std::sin(0.2f * t + phase), z = size * std::cos(0.13f * t + 2 * phase);
    motion.col(t) << x, 0.3f, z, 2 * x, 0.6f, z, 2 * x + 0.3f, 0.6f + z, z, 2 * x - 0.3f, 0.6f - x,
        2 * z;
  }
  return motion;
}

inline DenseLayer RandomLayer(int outputs, int inputs, double size, Random* random) {
  DenseLayer layer{Eigen::MatrixXf(outputs, inputs), Eigen::VectorXf(outputs)};
  for (float& w : layer.weights.reshaped()) w = static_cast<float>(size * random->Normal());
  for (float& b : layer.bias) b = static_cast<float>(size * random->Normal());
  return layer;
}

inline ParticleNetwork RandomParticles(uint64_t seed, const ParticleStructure& structure = {}) {
  Random random(seed);
  const int size = FourParticles().num_coordinates();
  ParticleNetwork network;
  network.structure = structure;
  network.pose_mean = SwayingMotion(50, 0.0f).rowwise().mean();
  network.pose_spread = Eigen::VectorXf::Constant(size, 0.1f);
  network.step_spread = Eigen::VectorXf::Constant(size, 0.01f);
  network.input = RandomLayer(structure.NumGates(), structure.NumInputs(size), 0.1, &random);
  network.recurrent = RandomLayer(structure.NumGates(), kParticleHidden, 0.05, &random);
  network.drift = RandomLayer(size, kParticleHidden, 0.03, &random);
  network.noise = RandomLayer(size, kParticleHidden, 0.03, &random);
  if (structure.corrected_frames > 0) {
    const int terms = kCorrectionTerms * size;
    network.correction_hidden =
        RandomLayer(kCorrectionHidden, kParticleHidden + terms, 0.05, &random);
    network.correction = RandomLayer(terms, kCorrectionHidden, 0.03, &random);
  }
  if (structure.noisy_input) {
    network.noise_below = RandomLayer(size * size, kParticleHidden, 0.01, &random);
  } else {
    network.noise_mix = Eigen::MatrixXf::Identity(size, size);
  }
  if (structure.HasSkip()) {
    network.skip = RandomLayer(size, kSkipSteps * size, 0.01, &random).weights;
    network.skip.leftCols(size) += Eigen::MatrixXf::Identity(size, size);
  }
  return network;
}

// Two blocks over twelve frames.
inline SimlpeNetwork RandomSimlpe(uint64_t seed) {
  Random random(seed);
  const int size = FourParticles().num_coordinates();
  const auto values = [&random](int count) { return RandomLayer(count, 1, 0.1, &random).bias; };
  SimlpeNetwork network = {SwayingMotion(50, 0.0f).rowwise().mean(),
                           Eigen::VectorXf::Constant(size, 0.1f),
                           RandomLayer(size, size, 0.1, &random),
                           RandomLayer(size, size, 0.1, &random),
                           {}};
  for (int i = 0; i < 2; ++i) {
    network.blocks.push_back({RandomLayer(12, 12, 0.1, &random), values(size), values(size)});
  }
  return network;
}

}  // namespace pushid
