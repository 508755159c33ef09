// models: the chain's training in rounds, with its state.
#include <algorithm>

#include "models/restoration/cvae_stages_torch.h"
#include "models/restoration/cvae_trainer.h"

namespace pushid {
struct CvaeTrainer::Torch : KeptRun<Run, Torch>, CvaeStages {
  template <typename Fields>
  void Keep(Fields* fields) {
    fields->Part("lower", lower.get());
    fields->Part("best_lower", best_lower.get());
    if (upper) {
      fields->Part("upper", upper.get());
      fields->Part("best_upper", best_upper.get());
    }
    int of_stage = stage, of_step = step;
    double loss = best_loss;
    int64_t column = at, left = rollout_left;
    fields->Numbers("counts", &of_stage, &of_step, &rounds, &loss, &column, &left);
    if (Fields::kReads) {  // the stage first, with its optimizer; then how far it is
      stage = of_stage;
      if (stage == 3) PredictLower(&training), PredictLower(&held);
      if (stage < 4) StartStage();
      step = of_step, best_loss = loss, at = column, rollout_left = left;
    }
    fields->Part("optimizer", optimizer.get());
    if (rollout_left == 0) return;
    fields->Tensor("rows", &rows);
    fields->Tensor("first", &first);
    fields->Tensor("state", &state);
  }

  bool Done() const override { return stage == 4; }

  double ShareDone() const override {
    double all = 0.0, done = 0.0;
    for (int i = 0; i < 4; ++i) {
      all += Steps(i);
      if (i < stage) done += Steps(i);
    }
    return Done() ? 1.0 : (done + step) / all;
  }

  TrainingPoint RunRound() override {
    double sum = 0.0;
    int steps = 0;
    while (steps < options.round && step < Steps(stage)) sum += Step(), ++steps;
    TrainingPoint point = {++rounds, sum / std::max(1, steps), HeldLoss(), kCvaeStageNames[stage]};
    // Best of the part in which the network goes on from its own frames.
    if (point.validation_loss < best_loss && step >= Steps(stage) / 2) {
      best_loss = point.validation_loss;
      CopyWeights(Half(), (Upper() ? best_upper : best_lower).get());
    }
    if (step >= Steps(stage)) {
      FinishStage();
      if (stage < 4) StartStage();
    }
    return point;
  }
};

CvaeTrainer::CvaeTrainer(std::vector<CvaeSequence> training, std::vector<CvaeSequence> held,
                         const CvaeWeights& scalings, const CvaeOptions& options)
    : Trainer(std::make_unique<Torch>()) {
  StartTraining(options);
  Torch& t = As<Torch>();
  t.options = options;
  t.scalings = scalings;
  t.training = Gather(training);
  t.held = Gather(held);
  t.lower_spread = ToTensor(scalings.lower.spread), t.lower_mean = ToTensor(scalings.lower.mean);
  t.upper_spread = ToTensor(scalings.upper.spread);
  t.pendulum_spread = ToTensor(scalings.pendulum.spread);
  t.pendulum_mean = ToTensor(scalings.pendulum.mean);
  const CvaeLayout& layout = scalings.layout;
  const auto lower = [&layout] {
    return std::make_shared<HalfModule>(layout.LowerFrame(), layout.LowerFrame(),
                                        layout.PendulumFrame());
  };
  const auto upper = [&layout] {
    return std::make_shared<HalfModule>(layout.UpperFrame(), layout.UpperCondition(),
                                        layout.PendulumFrame());
  };
  t.lower = lower(), t.best_lower = lower();
  if (layout.halves) t.upper = upper(), t.best_upper = upper();
  t.StartStage();
}

CvaeWeights CvaeTrainer::Best() const {
  const Torch& t = As<Torch>();
  CvaeWeights weights = t.scalings;
  const auto take = [&](const HalfModule& half, CvaeSampler* sampler, CvaeDecoder* decoder) {
    if (weights.layout.pendulum) *sampler = half.sampler->SamplerWeights();
    *decoder = half.decoder->Weights();
  };
  take(*t.lower, &weights.lower_sampler, &weights.lower_decoder);
  if (weights.layout.halves) take(*t.upper, &weights.upper_sampler, &weights.upper_decoder);
  return weights;
}

std::array<int64_t, 4> CvaeTrainer::NumParameters() const {
  const Torch& t = As<Torch>();
  std::array<int64_t, 4> all = {};
  for (int i = 0; i < 4; ++i) {
    if (!t.Has(i)) continue;
    const HalfModule& half = i < 2 ? *t.lower : *t.upper;
    all[i] = NumNumbers(i % 2 == 0 ? half.AutoencoderParameters() : half.sampler->parameters());
  }
  return all;
}

}  // namespace pushid
