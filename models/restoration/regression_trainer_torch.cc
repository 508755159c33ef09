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

// By epochs of batches; `best` has the weights of the epoch with the least held-out loss.
struct RegressionTrainer::Torch : KeptRun<Run, Torch> {
  RegressionOptions options;
  std::shared_ptr<Network> network, best;
  std::unique_ptr<torch::optim::AdamW> optimizer;
  torch::Tensor inputs, targets, weights, held_inputs, held_targets, held_weights;
  int epoch = 0, best_epoch = 0;
  double best_loss = 1e30;

  bool Done() const override {
    return epoch >= options.epochs || epoch - best_epoch >= options.patience;
  }
  double ShareDone() const override { return static_cast<double>(epoch) / options.epochs; }

  torch::Tensor LossOf(const torch::Tensor& rows) {
    torch::Tensor x = inputs.index_select(0, rows);
    x = x + options.input_noise * torch::randn_like(x);
    return AbsoluteLoss(network->forward(x), targets.index_select(0, rows),
                        weights.index_select(0, rows));
  }

  double HeldLoss() {
    torch::NoGradGuard no_grad;
    network->eval();
    return AbsoluteLoss(network->forward(held_inputs), held_targets, held_weights).item<double>();
  }

  TrainingPoint RunRound() override {
    const torch::Tensor order = torch::randperm(inputs.size(0));
    const int64_t batches = (inputs.size(0) + options.batch - 1) / options.batch;
    double sum = 0.0;
    network->train();
    for (int64_t b = 0; b < batches; ++b) {
      const double done = (epoch + static_cast<double>(b) / batches) / options.epochs;
      SetLearningRate(optimizer.get(), options.learning_rate * OneCycle(done));
      const torch::Tensor loss = LossOf(order.slice(0, b * options.batch, (b + 1) * options.batch));
      Improve(optimizer.get(), loss);
      sum += loss.item<double>();
    }
    ++epoch;
    const double held_loss = HeldLoss();
    if (held_loss < best_loss) {
      best_loss = held_loss;
      best_epoch = epoch;
      CopyWeights(*network, best.get());
    }
    return {epoch, sum / static_cast<double>(batches), held_loss};
  }

  template <typename Fields>
  void Keep(Fields* fields) {
    fields->Part("network", network.get());
    fields->Part("best", best.get());
    fields->Part("optimizer", optimizer.get());
    fields->Numbers("judged", &best_epoch, &best_loss);
    fields->Numbers("step", &epoch);
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
  t.network = std::make_shared<Network>(in, out, options);
  t.best = std::make_shared<Network>(in, out, options);  // drawn as well: a seed keeps its numbers
  CopyWeights(*t.network, t.best.get());
  t.optimizer = MakeOptimizer(t.network->parameters(), options.learning_rate, options.weight_decay);
}

DenseNetwork RegressionTrainer::Best() const { return As<Torch>().best->Weights(); }

}  // namespace pushid
