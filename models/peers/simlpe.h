// models: siMLPe, a peer that sees every person alone. In the manner of siMLPe (Guo et al., Back to
// MLP, WACV 2023): the cosine transform over time of 12 given frames, fully connected layers, 6
// frames predicted as displacements from the last given one. Smaller than the published network:
// dense layers over all coefficients at once, as many as the window network has.
//
// Joints are seen against the hip of the last given frame and in its heading.
#pragma once

#include <utility>

#include "models/peers/peer.h"
#include "models/restoration/dense_network.h"
#include "models/restoration/restoration.h"

namespace pushid {

inline constexpr int kSimlpeGiven = 12, kSimlpeFrames = 6;
inline constexpr int kSimlpeInputs = 3 * kBodyJoints * kSimlpeGiven;
inline constexpr int kSimlpeOutputs = 3 * kBodyJoints * kSimlpeFrames;

struct SimlpeWeights {
  Scaling inputs;
  DenseNetwork network;  // outputs in m
};

// Of the frames [last - 11, last] of a motion.
Eigen::VectorXf SimlpeInput(const BodyMotion& motion, int last);
// Of the frames [last + 1, last + 6].
Eigen::VectorXf SimlpeTarget(const BodyMotion& motion, int last);

class SimlpePeer : public Peer {
 public:
  explicit SimlpePeer(SimlpeWeights weights) : weights_(std::move(weights)) {}
  std::string_view name() const override { return RowOf(RestorationKind::kSimlpe).name; }
  int given_frames() const override { return kSimlpeGiven; }
  std::vector<BodyMotion> Continue(const std::vector<BodyMotion>& people,
                                   int frames) const override;

 private:
  SimlpeWeights weights_;
};

void AddTensors(const SimlpeWeights& weights, TensorList* tensors);
SimlpeWeights TakeSimlpe(TensorReader* reader);

}  // namespace pushid
