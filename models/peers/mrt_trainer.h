// models: training of MRT on whole groups.
//
// A window is 20 frames of everybody of a group and the 20 after them, beginning at any frame; an
// epoch takes some of them by chance. By chance too the 20 frames are the true ones, or what the
// network itself says after 20 earlier ones, or after 20 and 20 (without gradients through them),
// as far as there are earlier frames: three steps of 20 are the 60 frames of the published task.
// Loss: mean distance of joints from the true ones, m, all people of a window being asked for;
// noise on the scaled inputs, dropout, AdamW with a one-cycle learning rate. After each epoch the
// held-out groups are continued from their first 20 frames to their end, as they will be when it is
// used, and the mean distance of joints in the frames after those, m, judges: the best epoch is
// kept, and training ends early after `patience` epochs without a better one. With one thread a run
// that was broken off and resumed ends with the same bits.
#pragma once

#include <cstdint>
#include <vector>

#include "models/peers/mrt_network.h"
#include "models/restoration/trainer.h"

namespace pushid {

struct MrtGroup {
  std::vector<BodyMotion> people;  // at kPeerRate, as many frames each
  double weight = 1.0;             // of a frame in the loss
};

inline constexpr int kMrtSteps = 3;  // of 20 frames, in training

struct MrtOptions : TrainerOptions {
  MrtSize size = MrtSize::kSmall;
  double dropout = 0.1;
  double input_noise = 0.1;  // standard deviation, on scaled inputs
  double learning_rate = 1e-3;
  double weight_decay = 1e-2;
  int epochs = 40;
  int windows = 512;  // of an epoch
  int batch = 8;      // windows, of groups of one size
  int patience = 15;  // epochs without a better held-out loss
};

class MrtTrainer : public Trainer {
 public:
  // Groups without a window, or without a frame after the given ones to be judged by, are left out;
  // there must be one of each.
  MrtTrainer(std::vector<MrtGroup> training, std::vector<MrtGroup> held, const MrtOptions& options);

  MrtWeights Best() const;
  int64_t NumParameters() const;
  // What LibTorch makes of a view with the best weights; PredictedWays must say the same.
  Eigen::MatrixXf LibTorchWays(const MrtView& view) const;

 private:
  struct Torch;
};

// Whether a group has a window to learn from, and a frame to be judged by.
bool HasWindow(const MrtGroup& group);
bool HasFrameAfter(const MrtGroup& group);

}  // namespace pushid
