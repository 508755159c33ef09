// models: the trainer of siMLPe, in LibTorch.
#include "models/generators/particle_losses_torch.h"
#include "models/generators/simlpe_network.h"

namespace pushid {
namespace {

// Coefficients stand first, [coefficient, batch, coordinate]: a block is then one product.
class SimlpeModule : public torch::nn::Module {
 public:
  SimlpeModule(const ParticleNetwork& statistics, int observed, int blocks)
      : size_(statistics.num_coordinates()), observed_(observed) {
    pose_mean_ = ToTensor(statistics.pose_mean);
    pose_spread_ = ToTensor(statistics.pose_spread);
    transform_ = ToTensor(Eigen::MatrixXf(CosineTransform(observed).transpose().cast<float>()));
    input_ = register_module("input", torch::nn::Linear(size_, size_));
    output_ = register_module("output", torch::nn::Linear(size_, size_));
    torch::nn::init::xavier_uniform_(output_->weight, kSmallGain);
    torch::nn::init::zeros_(output_->bias);
    for (int i = 0; i < blocks; ++i) {
      const std::string name = std::to_string(i);
      mixes_.push_back(register_module("mix" + name, torch::nn::Linear(observed, observed)));
      torch::nn::init::xavier_uniform_(mixes_.back()->weight, kSmallGain);
      torch::nn::init::zeros_(mixes_.back()->bias);
      norms_.push_back(register_module(
          "norm" + name,
          torch::nn::LayerNorm(torch::nn::LayerNormOptions({size_}).eps(kNormSmooth))));
    }
  }

  // past: [batch, frame, coordinate], and so is the forecast. jitter: [batch, 1, coordinate].
  torch::Tensor Forecast(const torch::Tensor& past, const torch::Tensor& jitter) {
    const int64_t batch = past.size(0);
    const torch::Tensor poses = (past - pose_mean_) / pose_spread_ + jitter;
    torch::Tensor state = input_->forward(torch::matmul(transform_, poses)).transpose(0, 1);
    for (size_t i = 0; i < mixes_.size(); ++i) {
      const torch::Tensor mixed = torch::addmm(mixes_[i]->bias.unsqueeze(1), mixes_[i]->weight,
                                               state.reshape({observed_, batch * size_}));
      state = state + norms_[i]->forward(mixed.reshape({observed_, batch, size_}));
    }
    const torch::Tensor moved =
        torch::matmul(transform_.t(), output_->forward(state).transpose(0, 1));
    return past.narrow(1, observed_ - 1, 1) + pose_spread_ * moved;
  }

  SimlpeNetwork Network() const {
    SimlpeNetwork network = {
        ToVector(pose_mean_), ToVector(pose_spread_), ToLayer(input_), ToLayer(output_), {}};
    for (size_t i = 0; i < mixes_.size(); ++i) {
      network.blocks.push_back(
          {ToLayer(mixes_[i]), ToVector(norms_[i]->weight), ToVector(norms_[i]->bias)});
    }
    return network;
  }

 private:
  static constexpr double kSmallGain = 1e-2;  // the first forecast stands nearly still

  int64_t size_, observed_;
  torch::Tensor pose_mean_, pose_spread_, transform_;
  torch::nn::Linear input_{nullptr}, output_{nullptr};
  std::vector<torch::nn::Linear> mixes_;
  std::vector<torch::nn::LayerNorm> norms_;
};

}  // namespace

struct SimlpeTrainer::Torch : WindowsRun<Run, Torch, SimlpeTrainingOptions> {
  using WindowsRun::WindowsRun;

  std::shared_ptr<SimlpeModule> module;
  std::unique_ptr<torch::optim::AdamW> optimizer;

  template <typename Fields>
  void Keep(Fields* fields) {
    fields->Part("module", module.get());
    fields->Part("optimizer", optimizer.get());
    fields->Numbers("step", &step);
  }

  int AllSteps() const override { return options.steps; }
  const char* Stage(int) const override { return "perceptron"; }

  torch::Tensor Loss(const ParticleBatch& batch, double jitter) {
    const torch::Tensor past = batch.frames.narrow(1, 0, options.observed);
    const torch::Tensor moved = jitter * torch::randn({past.size(0), 1, past.size(2)});
    return losses(module->Forecast(past, moved), batch);
  }

  double Step() override {
    SetLearningRate(optimizer.get(),
                    options.learning_rate * RateShareToZero(step, options.steps, options.warm_up));
    const torch::Tensor loss = Loss(windows.Draw(), options.jitter);
    Improve(optimizer.get(), kLossUnits * loss, module->parameters(), options.clip);
    return loss.item<double>();
  }

  double LossOfHeld(const ParticleBatch& batch, int) override {
    return Loss(batch, 0.0).item<double>();
  }
};

SimlpeTrainer::SimlpeTrainer(const ParticleLayout& layout,
                             const std::vector<LearntParticles>& learnt,
                             const std::vector<LearntParticles>& held,
                             const SimlpeTrainingOptions& options)
    : Trainer(std::make_unique<Torch>(layout, learnt, held, options)) {
  StartTraining(options);
  Torch& t = As<Torch>();
  t.module = std::make_shared<SimlpeModule>(ParticleStatistics(layout, learnt, options),
                                            options.observed, options.blocks);
  t.optimizer = MakeOptimizer(t.module->parameters(), options.learning_rate, options.weight_decay);
}

SimlpeNetwork SimlpeTrainer::Network() const { return As<Torch>().module->Network(); }

Trajectories SimlpeTrainer::Forecast(const Trajectories& seen) const {
  torch::NoGradGuard no_grad;
  const torch::Tensor past = ToTensor(seen).unsqueeze(0);
  return ToMatrix(As<Torch>().module->Forecast(past, torch::zeros({1})).squeeze(0)).transpose();
}

}  // namespace pushid
