// models: the modules of LDP's chain in LibTorch, for cvae_trainer_torch.cc and its likes alone.
#pragma once

#include <utility>
#include <vector>

#include "models/restoration/cvae_networks.h"
#include "models/restoration/support_torch.h"

namespace pushid {

using torch::Tensor;

struct Gaussian {
  Tensor mean, log_variance;
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
  CvaeSampler SamplerWeights() const { return {ToLayer(first_), ToLayer(second_), ToLayer(mean_)}; }

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
