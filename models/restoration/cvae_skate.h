// models: the foot-skate error (FSE) that the lower sampler is trained against, without LibTorch in
// front, so that it can be tested by hand.
//
//   FSE = mean over ankles with h < H of  100 |way| (2 - 2^(max(0, h) / H)),  cm a frame
//
// way: of the ankle, horizontal, from the frame that the network started from to its output, m;
// h: the output's ankle above its own height at frame 0 of the person; H = 0.025 m. The same as
// FootSkate of ident/bodies/body_metrics.h. h counts in the weight and its gradient; which ankles
// count has no gradient. 0 where no ankle is low.
//
// In `ldp` coordinates positions contain the hip's way. In `tip` coordinates they do not: the hip
// is put at the end of the rod, so the way and the rise of that end are added (PendulumFrames).
#pragma once

#include <Eigen/Core>

#include "models/restoration/cvae_features.h"

namespace pushid {

// Not scaled, as FramesOf and PendulumFrames give them; a column per sample.
struct CvaeSkateFrames {
  Eigen::MatrixXd output, before, first;     // of the lower body: output, started from, frame 0
  Eigen::MatrixXd pendulum, first_pendulum;  // of the output's frame and of frame 0
};

// by_output: the gradient, of the shape of `output`.
double CvaeFootSkate(const CvaeLayout& layout, const CvaeSkateFrames& frames,
                     Eigen::MatrixXd* by_output);

}  // namespace pushid
