// models: windows, what is known of all of them, and the trainers of particles and of siMLPe.
#include <algorithm>

#include "models/generators/particle_module_torch.h"

namespace pushid {
namespace {

constexpr float kLeastSpread = 1e-4f;  // m; of a coordinate that hardly moves

}  // namespace

ParticleWindows::ParticleWindows(const ParticleLayout& layout,
                                 const std::vector<LearntParticles>& motions,
                                 const ParticleTrainingOptions& options)
    : options_(options) {
  const int window = options.observed + options.predicted;
  std::vector<torch::Tensor> frames;
  int64_t row = 0;
  for (const bool mirror : {false, true}) {
    for (const LearntParticles& motion : motions) {
      const int64_t count = motion.motion.cols();
      frames.push_back(ToTensor(mirror ? Mirrored(motion.motion, layout) : motion.motion));
      for (int64_t start = 0; !mirror && start + window <= count; ++start) {
        const size_t group = static_cast<size_t>(motion.group);
        if (by_group_.size() <= group) by_group_.resize(group + 1);
        all_.push_back(row + start);
        by_group_[group].push_back(row + start);
      }
      row += count;
    }
    if (!mirror) mirrored_rows_ = row;
  }
  if (motions.empty()) return;
  frames_ = torch::cat(frames);
  double sum = 0.0;
  for (const auto& places : by_group_) {
    sum += std::sqrt(static_cast<double>(places.size()));
    group_share_.push_back(sum);
  }
  for (double& share : group_share_) share /= sum;
}

torch::Tensor ParticleWindows::Draw() const {
  const torch::Tensor random = torch::rand({options_.batch, 3}, torch::kFloat64);
  const auto drawn = random.accessor<double, 2>();
  std::vector<int64_t> places;
  for (int i = 0; i < options_.batch; ++i) {
    const size_t group =
        std::upper_bound(group_share_.begin(), group_share_.end() - 1, drawn[i][0]) -
        group_share_.begin();
    const auto& among = by_group_[group];
    const size_t place = static_cast<size_t>(drawn[i][1] * static_cast<double>(among.size()));
    places.push_back(among[place] + (drawn[i][2] < options_.mirrored ? mirrored_rows_ : 0));
  }
  return Gather(places);
}

torch::Tensor ParticleWindows::Some(int most) const {
  const size_t step = std::max<size_t>(1, all_.size() / static_cast<size_t>(most));
  std::vector<int64_t> places;
  for (size_t i = 0; i < all_.size(); i += step) places.push_back(all_[i]);
  return Gather(places);
}

torch::Tensor ParticleWindows::Gather(const std::vector<int64_t>& places) const {
  const int64_t count = static_cast<int64_t>(places.size());
  const int64_t window = options_.observed + options_.predicted;
  const torch::Tensor rows = torch::tensor(places).unsqueeze(1) + torch::arange(window);
  return frames_.index_select(0, rows.flatten()).reshape({count, window, frames_.size(1)});
}

ParticleNetwork ParticleStatistics(const ParticleLayout& layout,
                                   const std::vector<LearntParticles>& motions,
                                   const ParticleTrainingOptions& options) {
  const int size = layout.num_coordinates();
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(size), squares = sum, steps = sum;
  double frames = 0.0;
  for (const LearntParticles& motion : motions) {
    if (motion.motion.cols() < 2) continue;
    for (const Trajectories& side : {motion.motion, Mirrored(motion.motion, layout)}) {
      const Eigen::MatrixXd all = side.cast<double>();
      const Eigen::Index last = all.cols() - 1;
      sum += all.rowwise().sum();
      squares += all.array().square().matrix().rowwise().sum();
      steps += (all.rightCols(last) - all.leftCols(last)).array().square().matrix().rowwise().sum();
      frames += static_cast<double>(all.cols());
    }
  }
  frames = std::max(frames, 1.0);
  const Eigen::VectorXd mean = sum / frames;
  const auto spread = [](const Eigen::VectorXd& square) -> Eigen::VectorXf {
    return square.cwiseMax(0.0).cwiseSqrt().cast<float>().cwiseMax(kLeastSpread);
  };
  ParticleNetwork network;
  network.structure = options.structure;
  network.pose_mean = mean.cast<float>();
  network.pose_spread = spread(squares / frames - mean.cwiseProduct(mean));
  network.step_spread = spread(steps / frames);
  return network;
}

namespace {

constexpr int kScatterBatches = 32;  // thousands of windows for the correlations of the noise

torch::Tensor NoJitter(const torch::Tensor& batch) {
  return torch::zeros({batch.size(0), 1, batch.size(2)});
}

}  // namespace

struct ParticleTrainer::Torch : WindowsRun<Run, Torch, ParticleTrainingOptions> {
  Torch(const ParticleLayout& layout, const std::vector<LearntParticles>& learnt,
        const std::vector<LearntParticles>& held, const ParticleTrainingOptions& given)
      : WindowsRun(layout, learnt, held, given),
        statistics(ParticleStatistics(layout, learnt, options)) {}

  ParticleNetwork statistics;
  std::shared_ptr<ParticleModule> module;
  std::shared_ptr<ParticleCritic> critic;
  std::unique_ptr<torch::optim::AdamW> drift, noise, critics;

  template <typename Fields>
  void Keep(Fields* fields) {
    fields->Part("module", module.get());
    fields->Part("drift", drift.get());
    fields->Part("noise", noise.get());
    if (critic) {
      fields->Part("critic", critic.get());
      fields->Part("critics", critics.get());
    }
    fields->Numbers("step", &step);
  }

  int AllSteps() const override {
    return options.steps + (options.together ? 0 : options.noise_steps);
  }
  bool InDrift(int of_step) const { return of_step < options.steps; }
  int StageEnd(int of_step) const override { return InDrift(of_step) ? options.steps : AllSteps(); }
  const char* Stage(int of_step) const override {
    return options.together ? "drift and noise" : InDrift(of_step) ? "drift" : "noise";
  }

  std::unique_ptr<torch::optim::AdamW> Adam(const std::vector<torch::Tensor>& parameters) const {
    return MakeOptimizer(parameters, options.learning_rate, 0.0);
  }

  torch::Tensor Jitter(const torch::Tensor& batch) const {
    return options.jitter * torch::randn({batch.size(0), 1, batch.size(2)});
  }

  // drawn: w_1:K of Eq. 6 as printed.
  torch::Tensor NoiseLossOf(const torch::Tensor& batch, const torch::Tensor& jitter,
                            const torch::Tensor& drawn = {}) const {
    const int first =
        std::min(options.together ? kFirstTransition : kFirstNoiseStep, options.observed);
    const auto [misses, hidden] = module->Misses(batch, jitter, first, options.together);
    const torch::Tensor w = drawn.defined() ? drawn.narrow(1, first, misses.size(1)) : drawn;
    const torch::Tensor charge = TransitionLoss(
        options.noise_loss, misses, module->LogNoise(hidden), module->NoiseBelow(hidden), w);
    return charge.sum() / static_cast<double>(charge.numel());
  }

  std::vector<torch::Tensor> Trained() const {
    std::vector<torch::Tensor> parameters = module->DriftParameters();
    if (!options.together) return parameters;
    for (const torch::Tensor& of_noise : module->NoiseParameters()) parameters.push_back(of_noise);
    return parameters;
  }

  void ImproveAt(double rate, torch::optim::AdamW* optimizer,
                 const std::vector<torch::Tensor>& parameters, const torch::Tensor& loss) {
    SetLearningRate(optimizer, rate);
    Improve(optimizer, loss, parameters, options.clip);
  }

  double DriftStep() {
    const torch::Tensor batch = windows.Draw();
    const torch::Tensor jitter = Jitter(batch);
    const double share =
        options.constant_rate ? 1.0 : RateShareToZero(step, options.steps, options.warm_up);
    const double rate = options.learning_rate * share;
    torch::Tensor drawn;
    if (options.together) {
      drawn = torch::randn({batch.size(0), options.observed, batch.size(2)});
    }
    const torch::Tensor forecast =
        module->Forecast(batch, jitter, options.observed, options.predicted, drawn);
    torch::Tensor loss = losses(forecast, batch);
    if (options.together) {
      const torch::Tensor seen = batch.narrow(1, 0, options.observed);
      loss = loss + options.transitions * NoiseLossOf(seen, jitter, drawn);
    }
    const double shown = loss.item<double>();
    if (critic) {
      const torch::Tensor last = batch.narrow(1, options.observed - 1, 1);
      const torch::Tensor made = critic->Features(forecast, last);
      const torch::Tensor real =
          critic->Features(batch.narrow(1, options.observed, options.predicted), last);
      ImproveAt(rate, critics.get(), critic->parameters(),
                critic->Loss(made.detach(), real, torch::rand({real.size(0), 1})));
      loss = loss - options.critic * critic->Score(made);
    }
    ImproveAt(rate, drift.get(), Trained(), kLossUnits * loss);
    return shown;
  }

  double NoiseStep() {
    const torch::Tensor batch = windows.Draw();
    const torch::Tensor loss = NoiseLossOf(batch, Jitter(batch));
    const double share =
        RateShareToZero(step - options.steps, options.noise_steps, options.warm_up);
    ImproveAt(options.learning_rate * share, noise.get(), module->NoiseParameters(), loss);
    return loss.item<double>();
  }

  double Step() override { return InDrift(step) ? DriftStep() : NoiseStep(); }

  // The correlations of the noise: of what the drift misses, on windows drawn as in training.
  void Finish() override {
    if (AllSteps() == options.steps) return;  // no noise was learned by itself
    torch::NoGradGuard no_grad;
    const int first = std::min(kFirstNoiseStep, options.observed);
    Eigen::MatrixXd scatter =
        Eigen::MatrixXd::Zero(statistics.num_coordinates(), statistics.num_coordinates());
    for (int i = 0; i < kScatterBatches; ++i) {
      const torch::Tensor batch = windows.Draw();
      const auto [misses, hidden] = module->Misses(batch, Jitter(batch), first);
      const torch::Tensor scaled = (misses * (-module->LogNoise(hidden)).exp()).flatten(0, 1);
      scatter += ToMatrix(torch::matmul(scaled.t(), scaled)).cast<double>();
    }
    module->SetScatter(scatter);
  }

  double LossOfHeld(const torch::Tensor& batch, int of_step) override {
    const torch::Tensor none = NoJitter(batch);
    if (!InDrift(of_step)) return NoiseLossOf(batch, none).item<double>();
    return losses(module->Forecast(batch, none, options.observed, options.predicted), batch)
        .item<double>();
  }
};

ParticleTrainer::ParticleTrainer(const ParticleLayout& layout,
                                 const std::vector<LearntParticles>& learnt,
                                 const std::vector<LearntParticles>& held,
                                 const ParticleTrainingOptions& options)
    : Trainer(std::make_unique<Torch>(layout, learnt, held, options)) {
  StartTraining(options);
  Torch& t = As<Torch>();
  t.module = std::make_shared<ParticleModule>(t.statistics);
  t.drift = t.Adam(t.Trained());
  t.noise = t.Adam(t.module->NoiseParameters());
  if (options.critic <= 0.0) return;
  t.critic = std::make_shared<ParticleCritic>(layout.num_coordinates() * options.predicted,
                                              ToTensor(t.statistics.pose_spread));
  t.critics = t.Adam(t.critic->parameters());
}

ParticleNetwork ParticleTrainer::Network() const {
  const Torch& t = As<Torch>();
  return t.module->Network(t.statistics);
}

Trajectories ParticleTrainer::Forecast(const ObservedMotion& person, int frames) const {
  torch::NoGradGuard no_grad;
  const torch::Tensor batch = ToTensor(person.frames).unsqueeze(0);
  const torch::Tensor forecast = As<Torch>().module->Forecast(
      batch, NoJitter(batch), static_cast<int>(person.frames.cols()), frames);
  return ToMatrix(forecast.squeeze(0)).transpose();
}

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

  torch::Tensor Loss(const torch::Tensor& batch, double jitter) {
    const torch::Tensor past = batch.narrow(1, 0, options.observed);
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

  double LossOfHeld(const torch::Tensor& batch, int) override {
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
