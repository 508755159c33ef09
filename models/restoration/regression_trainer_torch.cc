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

torch::Tensor Loss(const torch::Tensor& output, const torch::Tensor& target,
                   const torch::Tensor& weight) {
  return ((output - target).abs().mean(1) * weight).sum() / weight.sum();
}

}  // namespace

struct RegressionTrainer::Torch {
  RegressionOptions options;
  torch::Tensor inputs, targets, weights, held_inputs, held_targets, held_weights;
  std::shared_ptr<Network> network, best;
  std::unique_ptr<torch::optim::AdamW> optimizer;
  int epoch = 0, best_epoch = 0;
  double best_loss = 1e30;

  int64_t BatchesPerEpoch() const { return (inputs.size(0) + options.batch - 1) / options.batch; }
  void KeepBest() {
    torch::NoGradGuard no_grad;
    for (size_t i = 0; i < network->parameters().size(); ++i) {
      best->parameters()[i].copy_(network->parameters()[i]);
    }
  }
};

RegressionTrainer::RegressionTrainer(const RegressionSamples& training,
                                     const RegressionSamples& validation,
                                     const RegressionOptions& options)
    : torch_(std::make_unique<Torch>()) {
  torch::set_num_threads(options.num_threads);
  torch::manual_seed(options.seed);
  Torch& t = *torch_;
  t.options = options;
  t.inputs = ToTensor(training.inputs), t.targets = ToTensor(training.targets);
  t.weights = ToTensor(training.weights);
  t.held_inputs = ToTensor(validation.inputs), t.held_targets = ToTensor(validation.targets);
  t.held_weights = ToTensor(validation.weights);
  const int in = static_cast<int>(training.inputs.rows());
  const int out = static_cast<int>(training.targets.rows());
  t.network = std::make_shared<Network>(in, out, options);
  t.best = std::make_shared<Network>(in, out, options);
  t.KeepBest();
  t.optimizer = std::make_unique<torch::optim::AdamW>(
      t.network->parameters(),
      torch::optim::AdamWOptions(options.learning_rate).weight_decay(options.weight_decay));
}

RegressionTrainer::~RegressionTrainer() = default;

bool RegressionTrainer::Done() const {
  return torch_->epoch >= torch_->options.epochs ||
         torch_->epoch - torch_->best_epoch >= torch_->options.patience;
}

TrainingPoint RegressionTrainer::RunEpoch() {
  Torch& t = *torch_;
  const int64_t batches = t.BatchesPerEpoch();
  const torch::Tensor order = torch::randperm(t.inputs.size(0));
  double sum = 0.0;
  t.network->train();
  for (int64_t b = 0; b < batches; ++b) {
    const double done = (t.epoch + static_cast<double>(b) / batches) / t.options.epochs;
    SetLearningRate(t.optimizer.get(), t.options.learning_rate * OneCycle(done));
    const torch::Tensor rows = order.slice(0, b * t.options.batch, (b + 1) * t.options.batch);
    torch::Tensor x = t.inputs.index_select(0, rows);
    x = x + t.options.input_noise * torch::randn_like(x);
    const torch::Tensor loss = Loss(t.network->forward(x), t.targets.index_select(0, rows),
                                    t.weights.index_select(0, rows));
    t.optimizer->zero_grad();
    loss.backward();
    t.optimizer->step();
    sum += loss.item<double>();
  }
  ++t.epoch;
  torch::NoGradGuard no_grad;
  t.network->eval();
  const double held =
      Loss(t.network->forward(t.held_inputs), t.held_targets, t.held_weights).item<double>();
  if (held < t.best_loss) {
    t.best_loss = held;
    t.best_epoch = t.epoch;
    t.KeepBest();
  }
  return {t.epoch, sum / static_cast<double>(batches), held};
}

DenseNetwork RegressionTrainer::Best() const { return torch_->best->Weights(); }

std::string RegressionTrainer::State() const {
  torch::serialize::OutputArchive archive, network, best, optimizer;
  torch_->network->save(network);
  torch_->best->save(best);
  torch_->optimizer->save(optimizer);
  archive.write("network", network);
  archive.write("best", best);
  archive.write("optimizer", optimizer);
  archive.write("counts",
                torch::tensor({static_cast<double>(torch_->epoch),
                               static_cast<double>(torch_->best_epoch), torch_->best_loss},
                              torch::kFloat64));
  archive.write("random", at::detail::getDefaultCPUGenerator().get_state());
  return Archived(archive);
}

bool RegressionTrainer::Resume(const std::string& state) {
  try {
    std::istringstream stream(state);
    torch::serialize::InputArchive archive, network, best, optimizer;
    archive.load_from(stream);
    archive.read("network", network);
    archive.read("best", best);
    archive.read("optimizer", optimizer);
    torch_->network->load(network);
    torch_->best->load(best);
    torch_->optimizer->load(optimizer);
    torch::Tensor counts, random;
    archive.read("counts", counts);
    archive.read("random", random);
    auto generator = at::detail::getDefaultCPUGenerator();
    generator.set_state(random);
    torch_->epoch = static_cast<int>(counts[0].item<double>());
    torch_->best_epoch = static_cast<int>(counts[1].item<double>());
    torch_->best_loss = counts[2].item<double>();
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace pushid
