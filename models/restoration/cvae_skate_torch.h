// models: the foot-skate error on LibTorch's tensors. For *_torch.cc files alone.
#pragma once

#include "models/restoration/cvae_skate.h"
#include "models/restoration/support_torch.h"

namespace pushid {

// As CvaeSkateFrames, but a row per sample.
struct SkateTensors {
  torch::Tensor output, before, first, pendulum, first_pendulum;
};
torch::Tensor FootSkateOf(const CvaeLayout& layout, const SkateTensors& frames);

}  // namespace pushid
