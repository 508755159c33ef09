// models: the trainer of dense networks, in LibTorch.
#include <vector>

#include "models/restoration/regression_trainer.h"
#include "models/restoration/support_torch.h"

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

struct RegressionTrainer::Torch {
  RegressionOptions options;
  torch::Tensor inputs, targets, weights, held_inputs, held_targets, held_weights;
  Epochs<Network> epochs;

  int64_t BatchesPerEpoch() const { return (inputs.size(0) + options.batch - 1) / options.batch; }
};

RegressionTrainer::RegressionTrainer(const RegressionSamples& training,
                                     const RegressionSamples& validation,
                                     const RegressionOptions& options)
    : torch_(std::make_unique<Torch>()) {
  StartTraining(options);
  Torch& t = *torch_;
  t.options = options;
  t.inputs = ToTensor(training.inputs), t.targets = ToTensor(training.targets);
  t.weights = ToTensor(training.weights);
  t.held_inputs = ToTensor(validation.inputs), t.held_targets = ToTensor(validation.targets);
  t.held_weights = ToTensor(validation.weights);
  const int in = static_cast<int>(training.inputs.rows());
  const int out = static_cast<int>(training.targets.rows());
  auto network = std::make_shared<Network>(in, out, options);
  t.epochs.Start(std::move(network), std::make_shared<Network>(in, out, options),
                 options.learning_rate, options.weight_decay);
}

RegressionTrainer::~RegressionTrainer() = default;

bool RegressionTrainer::Done() const {
  return torch_->epochs.Done(torch_->options.epochs, torch_->options.patience);
}

double RegressionTrainer::ShareDone() const {
  return static_cast<double>(torch_->epochs.epoch) / torch_->options.epochs;
}

TrainingPoint RegressionTrainer::RunRound() {
  Torch& t = *torch_;
  const int64_t batches = t.BatchesPerEpoch();
  const torch::Tensor order = torch::randperm(t.inputs.size(0));
  double sum = 0.0;
  t.epochs.network->train();
  for (int64_t b = 0; b < batches; ++b) {
    const double done = (t.epochs.epoch + static_cast<double>(b) / batches) / t.options.epochs;
    SetLearningRate(t.epochs.optimizer.get(), t.options.learning_rate * OneCycle(done));
    const torch::Tensor rows = order.slice(0, b * t.options.batch, (b + 1) * t.options.batch);
    torch::Tensor x = t.inputs.index_select(0, rows);
    x = x + t.options.input_noise * torch::randn_like(x);
    const torch::Tensor loss =
        AbsoluteLoss(t.epochs.network->forward(x), t.targets.index_select(0, rows),
                     t.weights.index_select(0, rows));
    Improve(t.epochs.optimizer.get(), loss);
    sum += loss.item<double>();
  }
  ++t.epochs.epoch;
  torch::NoGradGuard no_grad;
  t.epochs.network->eval();
  const double held =
      AbsoluteLoss(t.epochs.network->forward(t.held_inputs), t.held_targets, t.held_weights)
          .item<double>();
  return t.epochs.Judged(sum / static_cast<double>(batches), held);
}

DenseNetwork RegressionTrainer::Best() const { return torch_->epochs.best->Weights(); }

std::string RegressionTrainer::State() const { return StateOf(&torch_->epochs); }

bool RegressionTrainer::Resume(const std::string& state) {
  return ResumeFrom(state, &torch_->epochs);
}

}  // namespace pushid
