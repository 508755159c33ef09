// models: the four stages of the chain's training in LibTorch: data, losses, steps, roll-outs. For
// cvae_trainer_torch.cc alone, which runs them in rounds and keeps their state.
#pragma once

#include <memory>
#include <vector>

#include "models/restoration/cvae_restoration.h"
#include "models/restoration/cvae_trainer.h"
#include "models/restoration/support_torch.h"

namespace pushid {

// The foot-skate error on LibTorch's tensors. For *_torch.cc files alone.

// As CvaeSkateFrames, but a row per sample.
struct SkateTensors {
  torch::Tensor output, before, first, pendulum, first_pendulum;
};
torch::Tensor FootSkateOf(const CvaeLayout& layout, const SkateTensors& frames);

// The modules of LDP's chain in LibTorch, for cvae_trainer_torch.cc and its likes alone.

using torch::Tensor;

struct Gaussian {
  Tensor mean, log_variance;

  Tensor Sigma() const { return torch::exp(0.5 * log_variance); }
  Tensor Draw() const { return mean + Sigma() * torch::randn_like(mean); }
};

inline Tensor Join(const Tensor& a, const Tensor& b) { return torch::cat({a, b}, 1); }

// [x, c] -> 256 -> 256 -> mean and log-variance; `again` is concatenated at the later layers.
class EncoderModule : public torch::nn::Module {
 public:
  EncoderModule(int inputs, int again)
      : first_(register_module("first", torch::nn::Linear(inputs, kCvaeHidden))),
        second_(register_module("second", torch::nn::Linear(kCvaeHidden + again, kCvaeHidden))),
        mean_(register_module("mean", torch::nn::Linear(kCvaeHidden + again, kLatent))),
        log_variance_(
            register_module("log_variance", torch::nn::Linear(kCvaeHidden + again, kLatent))) {}

  // again_first: [again, h] as in the autoencoders, else [h, again] as in the samplers.
  Gaussian Forward(const Tensor& inputs, const Tensor& again, bool again_first) {
    const auto join = [&](const Tensor& h) {
      return again_first ? Join(again, h) : Join(h, again);
    };
    Tensor h = torch::elu(first_(inputs));
    h = torch::elu(second_(join(h)));
    h = join(h);
    return {mean_(h), log_variance_(h)};
  }
  CvaeSampler SamplerWeights() const {
    return {ToLayer(first_), ToLayer(second_), ToLayer(mean_), ToLayer(log_variance_)};
  }

 private:
  torch::nn::Linear first_, second_, mean_, log_variance_;
};

class DecoderModule : public torch::nn::Module {
 public:
  DecoderModule(int condition, int frame) {
    const int inputs = kLatent + condition;
    gate_ = {register_module("gate0", torch::nn::Linear(inputs, kGateHidden)),
             register_module("gate1", torch::nn::Linear(kGateHidden, kGateHidden)),
             register_module("gate2", torch::nn::Linear(kGateHidden, kExperts))};
    layers_ = {
        register_module("first", torch::nn::Linear(inputs, kExperts * kCvaeHidden)),
        register_module("second", torch::nn::Linear(kLatent + kCvaeHidden, kExperts * kCvaeHidden)),
        register_module("last", torch::nn::Linear(kLatent + kCvaeHidden, kExperts * frame))};
  }
  Tensor Forward(const Tensor& z, const Tensor& condition) {
    const Tensor inputs = Join(z, condition);
    const Tensor shares =
        torch::softmax(gate_[2](torch::elu(gate_[1](torch::elu(gate_[0](inputs))))), 1);
    Tensor h = torch::elu(Mix(layers_[0], inputs, shares));
    h = torch::elu(Mix(layers_[1], Join(z, h), shares));
    return Mix(layers_[2], Join(z, h), shares);
  }
  CvaeDecoder Weights() const {
    CvaeDecoder decoder;
    for (const auto& layer : gate_) decoder.gate.layers.push_back(ToLayer(layer));
    decoder.first = ToLayer(layers_[0]);
    decoder.second = ToLayer(layers_[1]);
    decoder.last = ToLayer(layers_[2]);
    return decoder;
  }

 private:
  static Tensor Mix(torch::nn::Linear experts, const Tensor& inputs, const Tensor& shares) {
    const Tensor all = experts(inputs).view({inputs.size(0), kExperts, -1});
    return torch::bmm(shares.unsqueeze(1), all).squeeze(1);
  }
  std::vector<torch::nn::Linear> gate_, layers_;
};

// One half of the body: an autoencoder of frames and the sampler that stands in for its encoder.
class HalfModule : public torch::nn::Module {
 public:
  // pendulum: its numbers in a frame.
  HalfModule(int frame, int condition, int pendulum)
      : encoder(
            register_module("encoder", std::make_shared<EncoderModule>(frame + condition, frame))),
        decoder(register_module("decoder", std::make_shared<DecoderModule>(condition, frame))),
        sampler(register_module("sampler",
                                std::make_shared<EncoderModule>(condition + pendulum, pendulum))) {}

  Gaussian Encode(const Tensor& next, const Tensor& condition) {
    return encoder->Forward(Join(next, condition), next, true);
  }
  Gaussian Sample(const Tensor& condition, const Tensor& pendulum) {
    return sampler->Forward(Join(condition, pendulum), pendulum, false);
  }
  std::vector<Tensor> AutoencoderParameters() const {
    std::vector<Tensor> all = encoder->parameters();
    for (const Tensor& p : decoder->parameters()) all.push_back(p);
    return all;
  }

  std::shared_ptr<EncoderModule> encoder;
  std::shared_ptr<DecoderModule> decoder;
  std::shared_ptr<EncoderModule> sampler;
};

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
  Tensor lower_spread, upper_spread, lower_mean, pendulum_spread, pendulum_mean;  // for m
  int stage = 0, step = 0, rounds = 0;
  double best_loss = kWorstCvaeLoss;
  // The batch that is being rolled out.
  Tensor rows, first;
  int64_t at = 0, rollout_left = 0;
  Tensor state;  // x_t of the batch, true or its own

  bool Upper() const { return stage >= 2; }
  bool Sampler() const { return stage % 2 == 1; }
  bool Published() const { return options.training == CvaeTraining::kPublished; }
  std::vector<Tensor> Trained() {
    return Sampler() ? Half().sampler->parameters() : Half().AutoencoderParameters();
  }
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
                     Tensor* output);
  Tensor Skate(const Tensor& output, const Tensor& pendulum) const;
  double LearningRate(double done) const;
  enum class Latent { kEncoder, kSampler, kPriorMean };
  Tensor RollOut(const CvaeSequences& s, Latent latent);
  double HeldLoss();
  void PredictLower(CvaeSequences* s);
};

}  // namespace pushid
