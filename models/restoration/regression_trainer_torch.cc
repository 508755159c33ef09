// models: the trainer of dense networks, in LibTorch.
#include <vector>

#include "models/restoration/support_torch.h"
#include "models/restoration/trainer.h"

namespace pushid {
namespace {

class Network : public torch::nn::Module {
 public:
  Network(int inputs, int outputs, const RegressionOptions& options) : dropout_(options.dropout) {
    int width = inputs;
    for (int i = 0; i <= options.hidden_layers; ++i) {
      const int next = i == options.hidden_layers ? outputs : options.hidden;
      layers_.push_back(
          register_module("layer" + std::to_string(i), torch::nn::Linear(width, next)));
      width = next;
    }
  }
  torch::Tensor forward(torch::Tensor x) {
    for (size_t i = 0; i + 1 < layers_.size(); ++i) {
      x = torch::dropout(torch::elu(layers_[i](x)), dropout_, is_training());
    }
    return layers_.back()(x);
  }
  DenseNetwork Weights() const {
    DenseNetwork network;
    for (const auto& layer : layers_) network.layers.push_back(ToLayer(layer));
    return network;
  }

 private:
  double dropout_;
  std::vector<torch::nn::Linear> layers_;
};

torch::Tensor AbsoluteLoss(const torch::Tensor& output, const torch::Tensor& target,
                           const torch::Tensor& weight) {
  return ((output - target).abs().mean(1) * weight).sum() / weight.sum();
}

}  // namespace

struct RegressionTrainer::Torch : EpochsRun<Run, Torch, Network, RegressionOptions> {
  torch::Tensor inputs, targets, weights, held_inputs, held_targets, held_weights;
  torch::Tensor order;  // of the samples in this epoch

  int64_t DrawBatches() override {
    order = torch::randperm(inputs.size(0));
    return (inputs.size(0) + options.batch - 1) / options.batch;
  }

  torch::Tensor LossOf(int64_t b) override {
    const torch::Tensor rows = order.slice(0, b * options.batch, (b + 1) * options.batch);
    torch::Tensor x = inputs.index_select(0, rows);
    x = x + options.input_noise * torch::randn_like(x);
    return AbsoluteLoss(network->forward(x), targets.index_select(0, rows),
                        weights.index_select(0, rows));
  }

  double HeldLoss() override {
    torch::NoGradGuard no_grad;
    network->eval();
    return AbsoluteLoss(network->forward(held_inputs), held_targets, held_weights).item<double>();
  }
};

RegressionTrainer::RegressionTrainer(const RegressionSamples& training,
                                     const RegressionSamples& validation,
                                     const RegressionOptions& options)
    : Trainer(std::make_unique<Torch>()) {
  StartTraining(options);
  Torch& t = As<Torch>();
  t.options = options;
  t.inputs = ToTensor(training.inputs), t.targets = ToTensor(training.targets);
  t.weights = ToTensor(training.weights);
  t.held_inputs = ToTensor(validation.inputs), t.held_targets = ToTensor(validation.targets);
  t.held_weights = ToTensor(validation.weights);
  const int in = static_cast<int>(training.inputs.rows());
  const int out = static_cast<int>(training.targets.rows());
  auto network = std::make_shared<Network>(in, out, options);
  t.Start(std::move(network), std::make_shared<Network>(in, out, options));
}

DenseNetwork RegressionTrainer::Best() const { return As<Torch>().best->Weights(); }

}  // namespace pushid
