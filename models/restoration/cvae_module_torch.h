// models: LDP's chain in LibTorch: modules and losses. Included by *_torch.cc files alone.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "models/restoration/body.h"
#include "models/restoration/cvae_restoration.h"
#include "models/restoration/support_torch.h"
#include "models/restoration/trainer.h"

namespace pushid {

// The foot-skate error (FSE), a loss of the lower sampler.
//
//   FSE = mean over ankles with h < H of  100 |way| (2 - 2^(max(0, h) / H)),  cm a frame
//
// way: horizontal displacement of the ankle from the input frame to the output, m; h: height of the
// output's ankle above its height at frame 0; H = 0.025 m. The same as FootSkate of
// ident/bodies/body_evaluation.cc. The selection of low ankles has no gradient. 0 if no ankle is
// low.
//
// In `tip` coordinates positions are relative to the hip, which is at the end of the rod, so the
// displacement and the rise of that end are added (PendulumFrames).

// Rows of FramesOf and PendulumFrames, not scaled; a row per sample.
struct SkateTensors {
  Tensor output, before, first;     // frames of the lower body: output, input, frame 0
  Tensor pendulum, first_pendulum;  // at the output's frame and at frame 0
};

inline Tensor FootSkateOf(const CvaeLayout& layout, const SkateTensors& frames) {
  constexpr double kTouch = 0.025;             // m: H
  constexpr double kCentimetresOf = 100.0;     // per m
  constexpr int kEndHeight = 6, kEndWay = 12;  // rows of a pendulum's frame (cvae_restoration.h)
  const bool tip = layout.Origin() == CvaeCoordinates::kTip;
  const std::vector<int>& joints = layout.Joints(kLowerHalf);
  Tensor sum = torch::zeros({1}, frames.output.options());
  Tensor contacts = torch::zeros({1}, frames.output.options());
  for (const int joint : {kRightAnkle, kLeftAnkle}) {
    const int64_t row = 3 + 3 * (std::find(joints.begin(), joints.end(), joint) - joints.begin());
    Tensor way = frames.output.slice(1, row, row + 2) - frames.before.slice(1, row, row + 2);
    Tensor height = frames.output.select(1, row + 2) - frames.first.select(1, row + 2);
    if (tip) {
      way = way + frames.pendulum.slice(1, kEndWay, kEndWay + 2);
      height = height + frames.pendulum.select(1, kEndHeight) -
               frames.first_pendulum.select(1, kEndHeight);
    }
    const Tensor low = (height < kTouch).to(height.dtype());
    const Tensor weight = 2.0 - torch::exp2(height.clamp(0.0, kTouch) / kTouch);
    sum = sum + (low * way.norm(2, 1) * weight).sum();
    contacts = contacts + low.sum();
  }
  return kCentimetresOf * sum / contacts.clamp_min(1.0);
}

struct Gaussian {
  Tensor mean, log_variance;

  Tensor Sigma() const { return torch::exp(0.5 * log_variance); }
  Tensor Draw() const { return mean + Sigma() * torch::randn_like(mean); }
};

inline Tensor AutoencoderLossOf(const CvaeOptions& options, const Gaussian& encoded,
                                const Tensor& output, const Tensor& frame) {
  const Tensor kl =
      -0.5 * (1.0 + encoded.log_variance - encoded.mean.pow(2) - encoded.log_variance.exp()).mean();
  return (output - frame).pow(2).mean() + options.kl_weight * kl;
}

// The sampler's loss without the foot skate.
inline Tensor SamplerLossOf(CvaeTraining training, const Gaussian& sampled,
                            const Gaussian& encoded) {
  const Tensor of_mean = (sampled.mean - encoded.mean).pow(2);
  if (training == CvaeTraining::kPublished) {
    return (of_mean + (sampled.Sigma() - encoded.Sigma()).pow(2)).sum(1).mean();
  }
  return of_mean.mean() + (sampled.log_variance - encoded.log_variance).pow(2).mean();
}

// done: share of the stage's steps, 0 .. 1.
inline double CvaeLearningRate(const CvaeOptions& options, bool sampler, double done) {
  constexpr double kFirst = 1e-4, kLast = 1e-7;
  if (options.training == CvaeTraining::kOwn) return options.learning_rate * OneCycle(done);
  return sampler ? kFirst : kFirst + (kLast - kFirst) * done;
}

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

}  // namespace pushid
