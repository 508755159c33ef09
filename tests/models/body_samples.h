// A standing person of 22 joints, people with pendulums, and networks of random weights, for tests
// of restorations.
#pragma once

#include <cmath>

#include "datasets/files/random.h"
#include "models/restoration/cvae_restoration.h"
#include "models/restoration/restoration.h"
#include "models/restoration/window_restoration.h"
#include "models/skeleton_mapping.h"

namespace pushid {

// Facing +x, knees a little bent forwards, left side slightly unlike the right one.
inline Pose StandingPose() {
  Pose p;
  p.col(0) << 0.02, 0.0, 1.0;
  p.col(1) << 0.02, 0.0, 1.1;
  p.col(2) << 0.01, 0.0, 1.2;
  p.col(3) << 0.00, 0.0, 1.3;
  p.col(4) << 0.01, 0.0, 1.45;
  p.col(5) << 0.03, 0.0, 1.55;
  p.col(6) << 0.00, -0.03, 1.38;
  p.col(7) << -0.01, -0.17, 1.36;
  p.col(8) << -0.03, -0.20, 1.08;
  p.col(9) << 0.05, -0.21, 0.84;
  p.col(10) << 0.00, 0.03, 1.38;
  p.col(11) << -0.01, 0.17, 1.36;
  p.col(12) << -0.02, 0.21, 1.08;
  p.col(13) << 0.06, 0.22, 0.84;
  p.col(14) << 0.02, -0.08, 0.92;
  p.col(15) << 0.06, -0.09, 0.50;
  p.col(16) << 0.00, -0.10, 0.09;
  p.col(17) << 0.14, -0.11, 0.02;
  p.col(18) << 0.02, 0.08, 0.92;
  p.col(19) << 0.05, 0.09, 0.50;
  p.col(20) << -0.01, 0.10, 0.09;
  p.col(21) << 0.13, 0.12, 0.02;
  return p;
}

// The pose turned about z and moved.
inline Pose Placed(const Pose& pose, double turn, const Eigen::Vector3d& move) {
  return (TurnAboutZ(turn) * pose).colwise() + move;
}

inline RestorationInput WithPendulum(const Pose& first_pose, double mass) {
  RestorationInput person;
  person.first_pose = first_pose;
  const MappedPose mapped =
      MapSkeleton(first_pose.col(0), first_pose.col(kLeftAnkle), first_pose.col(kRightAnkle));
  person.body = {mass, mapped.rod_length, mapped.cart_height};
  person.q = {mapped.q};
  return person;
}

// Is pushed from behind, walks off along its heading and sways; frames of q.
inline RestorationInput MovingPerson(const Pose& first_pose, double mass, int frames) {
  RestorationInput person = WithPendulum(first_pose, mass);
  const double heading = Heading(first_pose);
  const Vector4<double> start = TurnedPendulum(person.q[0], -heading);
  person.push = {TurnAboutZ(heading) * Eigen::Vector3d(0.6, 0.1, 0.0), 0.2, first_pose.col(0)};
  person.q.clear();
  for (int t = 0; t < frames; ++t) {
    const double s = t / 60.0;
    const Vector4<double> move(0.4 * s * s, 0.05 * s, 0.2 * s * std::exp(-s),
                               0.03 * std::sin(4 * s));
    person.q.push_back(TurnedPendulum(start + move, heading));
  }
  return person;
}

inline Eigen::MatrixXf RandomMatrix(int rows, int columns, double spread, Random* random) {
  Eigen::MatrixXf m(rows, columns);
  for (Eigen::Index i = 0; i < m.size(); ++i) {
    m.data()[i] = static_cast<float>(spread * random->Normal());
  }
  return m;
}

inline DenseLayer RandomLayer(int inputs, int outputs, Random* random) {
  return {RandomMatrix(outputs, inputs, 0.7 / std::sqrt(inputs), random),
          RandomMatrix(outputs, 1, 0.01, random)};
}

inline Scaling UnitScaling(int rows) {
  return {Eigen::VectorXf::Zero(rows), Eigen::VectorXf::Ones(rows)};
}

inline WindowWeights RandomWindow(uint64_t seed = 1,
                                  RestorationView view = RestorationView::kPendulum) {
  Random random(seed);
  WindowWeights weights;
  weights.view = view;
  weights.inputs = UnitScaling(WindowInputRows(view));
  weights.network.layers = {RandomLayer(WindowInputRows(view), 256, &random),
                            RandomLayer(256, 256, &random),
                            RandomLayer(256, WindowOutputRows(view), &random)};
  weights.network.layers.back().weights *= 0.05f;
  return weights;
}

// Random weights for a layout, or for LDP's own.
inline CvaeWeights RandomCvae(uint64_t seed = 1, const CvaeLayout& layout = {}) {
  Random random(seed);
  const auto sampler = [&random](int condition) {
    return CvaeSampler{RandomLayer(condition + kPendulumFrame, kCvaeHidden, &random),
                       RandomLayer(kCvaeHidden + kPendulumFrame, kCvaeHidden, &random),
                       RandomLayer(kCvaeHidden + kPendulumFrame, kLatent, &random),
                       RandomLayer(kCvaeHidden + kPendulumFrame, kLatent, &random)};
  };
  const auto decoder = [&random](int condition, int frame) {
    CvaeDecoder d;
    d.gate.layers = {RandomLayer(kLatent + condition, kGateHidden, &random),
                     RandomLayer(kGateHidden, kGateHidden, &random),
                     RandomLayer(kGateHidden, kExperts, &random)};
    d.first = RandomLayer(kLatent + condition, kExperts * kCvaeHidden, &random);
    d.second = RandomLayer(kLatent + kCvaeHidden, kExperts * kCvaeHidden, &random);
    d.last = RandomLayer(kLatent + kCvaeHidden, kExperts * frame, &random);
    return d;
  };
  CvaeWeights weights;
  weights.layout = layout;
  for (int half = 0; half < layout.num_halves(); ++half) {
    weights.halves[half].scaling = UnitScaling(layout.Frame(half));
  }
  weights.pendulum = UnitScaling(layout.PendulumFrame());
  if (layout.pendulum) weights.halves[kLowerHalf].sampler = sampler(layout.Frame(kLowerHalf));
  if (layout.pendulum && layout.halves)
    weights.halves[kUpperHalf].sampler = sampler(layout.Condition(kUpperHalf));
  weights.halves[kLowerHalf].decoder = decoder(layout.Frame(kLowerHalf), layout.Frame(kLowerHalf));
  if (layout.halves) {
    weights.halves[kUpperHalf].decoder =
        decoder(layout.Condition(kUpperHalf), layout.Frame(kUpperHalf));
  }
  return weights;
}

}  // namespace pushid
