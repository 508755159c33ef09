// models: the four stages of the chain's training in LibTorch: data, losses, steps, roll-outs. For
// cvae_trainer_torch.cc alone, which runs them in rounds and keeps their state.
#pragma once

#include <memory>
#include <vector>

#include "models/restoration/cvae_modules_torch.h"
#include "models/restoration/cvae_trainer.h"

namespace pushid {

// Sequences padded to the longest: [sequence, frame, number].
struct CvaeSequences {
  Tensor lower, upper, pendulum, lower_predicted;  // the last: positions, once the chain is there
  std::vector<int64_t> frames;

  int64_t count() const { return static_cast<int64_t>(frames.size()); }
  int64_t longest() const { return lower.size(1); }
};

CvaeSequences Gather(const std::vector<CvaeSequence>& sequences);

inline constexpr double kWorstCvaeLoss = 1e30;

struct CvaeStages {
  CvaeOptions options;
  CvaeWeights scalings;
  CvaeSequences training, held;
  std::shared_ptr<HalfModule> lower, upper, best_lower, best_upper;  // upper: null without halves
  std::unique_ptr<torch::optim::AdamW> optimizer;
  Tensor lower_spread, upper_spread, lower_mean;  // of positions, for errors in m
  int stage = 0, step = 0, rounds = 0;
  double best_loss = kWorstCvaeLoss;
  // The batch that is being rolled out.
  Tensor rows, first;
  int64_t at = 0, rollout_left = 0;
  Tensor state;  // x_t of the batch, true or its own

  bool Upper() const { return stage >= 2; }
  bool Sampler() const { return stage % 2 == 1; }
  HalfModule& Half() { return Upper() ? *upper : *lower; }
  const Tensor& Frames(const CvaeSequences& s) const { return Upper() ? s.upper : s.lower; }
  const CvaeLayout& layout() const { return scalings.layout; }
  int NumPositions() const {
    return Upper() ? layout().UpperPositions() : layout().LowerPositions();
  }
  // x_t and, for the upper body, the lower positions of the next frame.
  Tensor Condition(const Tensor& x, const Tensor& lower_next) const {
    return Upper() ? Join(x, lower_next) : x;
  }

  // Whether the layout has it.
  bool Has(int which) const {
    return (layout().halves || which < 2) && (layout().pendulum || which % 2 == 0);
  }
  // Of stages that the layout has not, 0.
  int Steps(int which) const { return Has(which) ? options.steps[which] : 0; }
  void StartStage();
  void FinishStage();
  void NewBatch();
  double Step();
  Tensor AutoencoderLoss(const Tensor& next, const Tensor& condition, Tensor* output);
  Tensor SamplerLoss(const Tensor& next, const Tensor& condition, const Tensor& pendulum,
                     const Tensor& before, Tensor* output);
  Tensor Skate(const Tensor& output, const Tensor& x, const Tensor& next,
               const Tensor& before) const;
  enum class Latent { kEncoder, kSampler, kPriorMean };
  Tensor RollOut(const CvaeSequences& s, Latent latent);
  double HeldLoss();
  void PredictLower(CvaeSequences* s);
};

}  // namespace pushid
