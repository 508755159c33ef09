// models: MRT as a LibTorch module; mrt_network.h has its equations. Included by *_torch.cc files
// alone. Tensors are [person asked for, token, channel].
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "models/peers/mrt_network.h"
#include "models/restoration/support_torch.h"

namespace pushid {

// Scaled views of groups of one size.
struct MrtBatch {
  torch::Tensor own, all, places, query;
};

class MrtNormModule : public torch::nn::Module {
 public:
  explicit MrtNormModule(int width)
      : scale_(register_parameter("scale", torch::ones({width}))),
        shift_(register_parameter("shift", torch::zeros({width}))) {}
  torch::Tensor operator()(const torch::Tensor& x) const {
    return torch::layer_norm(x, {x.size(-1)}, scale_, shift_);
  }
  MrtNorm Weights() const { return {ToVector(scale_), ToVector(shift_)}; }

 private:
  torch::Tensor scale_, shift_;
};

class MrtLayerModule : public torch::nn::Module {
 public:
  MrtLayerModule(const MrtWidths& widths, double dropout) : widths_(widths), dropout_(dropout) {
    const int heads = widths.heads * widths.head;
    query_ = register_module("query", torch::nn::Linear(widths.width, heads));
    key_ = register_module("key", torch::nn::Linear(widths.width, heads));
    value_ = register_module("value", torch::nn::Linear(widths.width, heads));
    join_ = register_module("join", torch::nn::Linear(heads, widths.width));
    widen_ = register_module("widen", torch::nn::Linear(widths.width, widths.inner));
    narrow_ = register_module("narrow", torch::nn::Linear(widths.inner, widths.width));
    after_attention_ =
        register_module("after_attention", std::make_shared<MrtNormModule>(widths.width));
    after_dense_ = register_module("after_dense", std::make_shared<MrtNormModule>(widths.width));
  }

  torch::Tensor Forward(const torch::Tensor& of, const torch::Tensor& to) {
    const torch::Tensor shares =
        torch::softmax(torch::matmul(Heads(query_(of)), Heads(key_(to)).transpose(2, 3)) /
                           std::sqrt(static_cast<double>(widths_.head)),
                       -1);
    const torch::Tensor heads =
        torch::matmul(Dropped(shares), Heads(value_(to))).transpose(1, 2).flatten(2);
    const torch::Tensor seen = (*after_attention_)(of + Dropped(join_(heads)));
    return (*after_dense_)(seen + Dropped(narrow_(torch::relu(widen_(seen)))));
  }

  MrtLayer Weights() const {
    return {ToLayer(query_),
            ToLayer(key_),
            ToLayer(value_),
            ToLayer(join_),
            after_attention_->Weights(),
            ToLayer(widen_),
            ToLayer(narrow_),
            after_dense_->Weights()};
  }

 private:
  // [person, token, heads * head] -> [person, head, token, head's channel]
  torch::Tensor Heads(const torch::Tensor& x) const {
    return x.view({x.size(0), x.size(1), widths_.heads, widths_.head}).transpose(1, 2);
  }
  torch::Tensor Dropped(const torch::Tensor& x) const {
    return torch::dropout(x, dropout_, is_training());
  }

  MrtWidths widths_;
  double dropout_;
  torch::nn::Linear query_{nullptr}, key_{nullptr}, value_{nullptr}, join_{nullptr},
      widen_{nullptr}, narrow_{nullptr};
  std::shared_ptr<MrtNormModule> after_attention_, after_dense_;
};

class MrtModule : public torch::nn::Module {
 public:
  MrtModule(MrtSize size, double dropout) : size_(size) {
    const MrtWidths widths = WidthsOf(size);
    const auto linear = [&](const char* name, int inputs, int outputs) {
      return register_module(name, torch::nn::Linear(inputs, outputs));
    };
    local_token_ = linear("local_token", kMrtPoseRows, widths.width);
    global_token_ = linear("global_token", kMrtPoseRows, widths.width);
    place_ = linear("place", kMrtPlaceRows, widths.width);
    query_ = linear("query", kMrtQueryRows, widths.width);
    coefficients_ =
        register_parameter("coefficients", 0.1 * torch::randn({kMrtTokens, widths.width}));
    AddLayers("local", widths, dropout, &local_);
    AddLayers("global", widths, dropout, &global_);
    AddLayers("decoder", widths, dropout, &decoder_);
    output_ = linear("output", widths.width, kMrtPoseRows * kMrtFrames);
    torch::nn::init::zeros_(output_->weight);  // starts with the mean motion
    torch::nn::init::zeros_(output_->bias);
  }

  // Scaled outputs, [person, coefficient, pose row].
  torch::Tensor Forward(const MrtBatch& batch) {
    torch::Tensor local = local_token_(batch.own) + coefficients_;
    for (const auto& layer : local_) local = layer->Forward(local, local);
    const int64_t people = batch.places.size(1), persons = batch.places.size(0);
    torch::Tensor global = global_token_(batch.all).view({persons, people, kMrtTokens, -1});
    global = (global + coefficients_ + place_(batch.places).unsqueeze(2)).flatten(1, 2);
    for (const auto& layer : global_) global = layer->Forward(global, global);
    const torch::Tensor both = torch::cat({local, global}, 1);
    torch::Tensor query = query_(batch.query).unsqueeze(1);
    for (const auto& layer : decoder_) query = layer->Forward(query, both);
    return output_(query).view({persons, kMrtFrames, kMrtPoseRows});
  }

  MrtWeights Weights(const MrtScalings& scalings) const {
    return {size_,
            scalings,
            ToLayer(local_token_),
            ToLayer(global_token_),
            ToLayer(place_),
            ToLayer(query_),
            ToMatrix(coefficients_).transpose(),
            OfLayers(local_),
            OfLayers(global_),
            OfLayers(decoder_),
            ToLayer(output_)};
  }

 private:
  using Layers = std::vector<std::shared_ptr<MrtLayerModule>>;
  void AddLayers(const std::string& name, const MrtWidths& widths, double dropout, Layers* layers) {
    for (int i = 0; i < widths.layers; ++i) {
      layers->push_back(register_module(name + std::to_string(i),
                                        std::make_shared<MrtLayerModule>(widths, dropout)));
    }
  }
  static std::vector<MrtLayer> OfLayers(const Layers& layers) {
    std::vector<MrtLayer> weights;
    for (const auto& layer : layers) weights.push_back(layer->Weights());
    return weights;
  }

  MrtSize size_;
  torch::nn::Linear local_token_{nullptr}, global_token_{nullptr}, place_{nullptr}, query_{nullptr},
      output_{nullptr};
  torch::Tensor coefficients_;
  Layers local_, global_, decoder_;
};

}  // namespace pushid
