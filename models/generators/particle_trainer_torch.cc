// models: training of particles and of siMLPe: windows of motion, and the trainers.
#include <algorithm>

#include "models/generators/particle_module_torch.h"

namespace pushid {
namespace {

// Training windows, drawn by group, window and side (mirrored or not).
class ParticleWindows {
 public:
  ParticleWindows(const ParticleLayout& layout, const std::vector<LearntParticles>& motions,
                  const ParticleTrainingOptions& options)
      : options_(options) {
    const int window = options.observed + options.predicted;
    std::vector<Tensor> frames;
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

  bool empty() const { return all_.empty(); }

  Tensor Draw() const {
    const Tensor random = torch::rand({options_.batch, 3}, torch::kFloat64);
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

  // At most `most` windows, evenly spaced, none of them mirrored.
  Tensor Some(int most) const {
    const size_t step = std::max<size_t>(1, all_.size() / static_cast<size_t>(most));
    std::vector<int64_t> places;
    for (size_t i = 0; i < all_.size(); i += step) places.push_back(all_[i]);
    return Gather(places);
  }

 private:
  Tensor Gather(const std::vector<int64_t>& places) const {
    const int64_t count = static_cast<int64_t>(places.size());
    const int64_t window = options_.observed + options_.predicted;
    const Tensor rows = torch::tensor(places).unsqueeze(1) + torch::arange(window);
    return frames_.index_select(0, rows.flatten()).reshape({count, window, frames_.size(1)});
  }

  const ParticleTrainingOptions& options_;
  Tensor frames_;              // of all motions, then of all mirrored motions
  int64_t mirrored_rows_ = 0;  // number of rows before the mirrored motions
  std::vector<int64_t> all_;   // first rows of the windows
  std::vector<std::vector<int64_t>> by_group_;
  std::vector<double> group_share_;  // cumulative
};

constexpr double kLossUnits = 1e3;  // the gradient is clipped with the loss in mm

// The learning rate as a share of the largest: a linear warm-up, then a cosine down to zero.
double RateShareToZero(int step, int steps, int warm_up) {
  const int up = std::min(warm_up, std::max(1, steps / 2));
  if (step < up) return (step + 1.0) / up;
  return 0.5 * (1.0 + std::cos(M_PI * (step - up) / std::max(1, steps - up)));
}

// The common part of the trainings of particles and siMLPe.
template <typename Interface, typename Options>
struct WindowsTraining : StepsTraining<Interface> {
  WindowsTraining(const ParticleLayout& layout, const std::vector<LearntParticles>& learnt,
                  const std::vector<LearntParticles>& held, const Options& given)
      : options(given),
        windows(layout, learnt, options),
        held_windows(layout, held, options),
        losses(layout, options) {
    StartTraining(options);
  }

  Options options;
  ParticleWindows windows, held_windows;
  ParticleLosses losses;

  virtual double LossOfHeld(const Tensor& batch, int of_step) = 0;
  double HeldLoss(int of_step) override {
    constexpr int kHeldWindows = 256;
    if (held_windows.empty()) return std::nan("");
    torch::NoGradGuard no_grad;
    return LossOfHeld(held_windows.Some(kHeldWindows), of_step);
  }
};

// Means and spreads of poses and displacements, over the motions and their mirror images.
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
  static constexpr float kLeastSpread = 1e-4f;  // m; of a coordinate that hardly moves
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

constexpr int kScatterBatches = 32;  // for the correlations of the noise

Tensor NoJitter(const Tensor& batch) { return torch::zeros({batch.size(0), 1, batch.size(2)}); }

struct ParticleTraining : WindowsTraining<ParticleTrainer, ParticleTrainingOptions> {
  ParticleNetwork statistics;
  std::shared_ptr<ParticleModule> module;
  std::shared_ptr<ParticleCritic> critic;
  std::unique_ptr<AdamW> drift, noise, critics;

  ParticleTraining(const ParticleLayout& layout, const std::vector<LearntParticles>& learnt,
                   const std::vector<LearntParticles>& held, const ParticleTrainingOptions& given)
      : WindowsTraining(layout, learnt, held, given),
        statistics(ParticleStatistics(layout, learnt, options)) {
    module = std::make_shared<ParticleModule>(statistics);
    drift = Adam(Trained());
    noise = Adam(module->NoiseParameters());
    if (options.critic <= 0.0) return;
    critic = std::make_shared<ParticleCritic>(layout.num_coordinates() * options.predicted,
                                              ToTensor(statistics.pose_spread));
    critics = Adam(critic->parameters());
  }

  int AllSteps() const override {
    return options.steps + (options.together ? 0 : options.noise_steps);
  }
  bool InDrift(int of_step) const { return of_step < options.steps; }
  int StageEnd(int of_step) const override { return InDrift(of_step) ? options.steps : AllSteps(); }
  const char* Stage(int of_step) const override {
    return options.together ? "drift and noise" : InDrift(of_step) ? "drift" : "noise";
  }

  std::unique_ptr<AdamW> Adam(const std::vector<Tensor>& parameters) const {
    return MakeOptimizer(parameters, options.learning_rate, 0.0);
  }

  Tensor Jitter(const Tensor& batch) const {
    return options.jitter * torch::randn({batch.size(0), 1, batch.size(2)});
  }

  // drawn: w_1:K of Eq. 6 as printed.
  Tensor NoiseLossOf(const Tensor& batch, const Tensor& jitter, const Tensor& drawn = {}) const {
    const int first =
        std::min(options.together ? kFirstTransition : kFirstNoiseStep, options.observed);
    const auto [misses, hidden] = module->Misses(batch, jitter, first, options.together);
    const Tensor w = drawn.defined() ? drawn.narrow(1, first, misses.size(1)) : drawn;
    const Tensor charge = TransitionLoss(options.noise_loss, misses, module->LogNoise(hidden),
                                         module->NoiseBelow(hidden), w);
    return charge.sum() / static_cast<double>(charge.numel());
  }

  std::vector<Tensor> Trained() const {
    std::vector<Tensor> parameters = module->DriftParameters();
    if (!options.together) return parameters;
    for (const Tensor& of_noise : module->NoiseParameters()) parameters.push_back(of_noise);
    return parameters;
  }

  double DriftStep() {
    const Tensor batch = windows.Draw();
    const Tensor jitter = Jitter(batch);
    const double share =
        options.constant_rate ? 1.0 : RateShareToZero(step, options.steps, options.warm_up);
    const double rate = options.learning_rate * share;
    Tensor drawn;
    if (options.together) {
      drawn = torch::randn({batch.size(0), options.observed, batch.size(2)});
    }
    const Tensor forecast =
        module->Forecast(batch, jitter, options.observed, options.predicted, drawn);
    Tensor loss = losses(forecast, batch);
    if (options.together) {
      const Tensor seen = batch.narrow(1, 0, options.observed);
      loss = loss + options.transitions * NoiseLossOf(seen, jitter, drawn);
    }
    const double shown = loss.item<double>();
    if (critic) {
      const Tensor last = batch.narrow(1, options.observed - 1, 1);
      const Tensor made = critic->Features(forecast, last);
      const Tensor real =
          critic->Features(batch.narrow(1, options.observed, options.predicted), last);
      const Tensor own = critic->Loss(made.detach(), real, torch::rand({real.size(0), 1}));
      Improve(critics.get(), rate, own, critic->parameters(), options.clip);
      loss = loss - options.critic * critic->Score(made);
    }
    Improve(drift.get(), rate, kLossUnits * loss, Trained(), options.clip);
    return shown;
  }

  double NoiseStep() {
    const Tensor batch = windows.Draw();
    const Tensor loss = NoiseLossOf(batch, Jitter(batch));
    const double share =
        RateShareToZero(step - options.steps, options.noise_steps, options.warm_up);
    Improve(noise.get(), options.learning_rate * share, loss, module->NoiseParameters(),
            options.clip);
    return loss.item<double>();
  }

  double Step() override { return InDrift(step) ? DriftStep() : NoiseStep(); }

  // Sets the correlations of the noise from the drift's errors, on windows drawn as in training.
  void Finish() override {
    if (AllSteps() == options.steps) return;  // no separate training of the noise
    torch::NoGradGuard no_grad;
    const int first = std::min(kFirstNoiseStep, options.observed);
    Eigen::MatrixXd scatter =
        Eigen::MatrixXd::Zero(statistics.num_coordinates(), statistics.num_coordinates());
    for (int i = 0; i < kScatterBatches; ++i) {
      const Tensor batch = windows.Draw();
      const auto [misses, hidden] = module->Misses(batch, Jitter(batch), first);
      const Tensor scaled = (misses * (-module->LogNoise(hidden)).exp()).flatten(0, 1);
      scatter += ToMatrix(torch::matmul(scaled.t(), scaled)).cast<double>();
    }
    module->SetScatter(scatter);
  }

  double LossOfHeld(const Tensor& batch, int of_step) override {
    const Tensor none = NoJitter(batch);
    if (!InDrift(of_step)) return NoiseLossOf(batch, none).item<double>();
    return losses(module->Forecast(batch, none, options.observed, options.predicted), batch)
        .item<double>();
  }

  ParticleNetwork Network() const override { return module->Network(statistics); }

  Trajectories Forecast(const ObservedMotion& person, int frames) const override {
    torch::NoGradGuard no_grad;
    const Tensor batch = ToTensor(person.frames).unsqueeze(0);
    const Tensor forecast =
        module->Forecast(batch, NoJitter(batch), static_cast<int>(person.frames.cols()), frames);
    return ToMatrix(forecast.squeeze(0)).transpose();
  }
};

// State tensors are [coefficient, batch, coordinate], so that a block is one product.
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

  // past and the forecast: [batch, frame, coordinate]; jitter: [batch, 1, coordinate].
  Tensor Forecast(const Tensor& past, const Tensor& jitter) {
    const int64_t batch = past.size(0);
    const Tensor poses = (past - pose_mean_) / pose_spread_ + jitter;
    Tensor state = input_->forward(torch::matmul(transform_, poses)).transpose(0, 1);
    for (size_t i = 0; i < mixes_.size(); ++i) {
      const Tensor mixed = torch::addmm(mixes_[i]->bias.unsqueeze(1), mixes_[i]->weight,
                                        state.reshape({observed_, batch * size_}));
      state = state + norms_[i]->forward(mixed.reshape({observed_, batch, size_}));
    }
    const Tensor moved = torch::matmul(transform_.t(), output_->forward(state).transpose(0, 1));
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
  static constexpr double kSmallGain = 1e-2;  // initial forecasts hardly move

  int64_t size_, observed_;
  Tensor pose_mean_, pose_spread_, transform_;
  torch::nn::Linear input_{nullptr}, output_{nullptr};
  std::vector<torch::nn::Linear> mixes_;
  std::vector<torch::nn::LayerNorm> norms_;
};

struct SimlpeTraining : WindowsTraining<SimlpeTrainer, SimlpeTrainingOptions> {
  std::shared_ptr<SimlpeModule> module;
  std::unique_ptr<AdamW> optimizer;

  SimlpeTraining(const ParticleLayout& layout, const std::vector<LearntParticles>& learnt,
                 const std::vector<LearntParticles>& held, const SimlpeTrainingOptions& given)
      : WindowsTraining(layout, learnt, held, given),
        module(std::make_shared<SimlpeModule>(ParticleStatistics(layout, learnt, options),
                                              options.observed, options.blocks)),
        optimizer(
            MakeOptimizer(module->parameters(), options.learning_rate, options.weight_decay)) {}

  int AllSteps() const override { return options.steps; }
  const char* Stage(int) const override { return "perceptron"; }

  Tensor Loss(const Tensor& batch, double jitter) {
    const Tensor past = batch.narrow(1, 0, options.observed);
    const Tensor moved = jitter * torch::randn({past.size(0), 1, past.size(2)});
    return losses(module->Forecast(past, moved), batch);
  }

  double Step() override {
    const double rate =
        options.learning_rate * RateShareToZero(step, options.steps, options.warm_up);
    const Tensor loss = Loss(windows.Draw(), options.jitter);
    Improve(optimizer.get(), rate, kLossUnits * loss, module->parameters(), options.clip);
    return loss.item<double>();
  }

  double LossOfHeld(const Tensor& batch, int) override { return Loss(batch, 0.0).item<double>(); }

  SimlpeNetwork Network() const override { return module->Network(); }

  Trajectories Forecast(const Trajectories& seen) const override {
    torch::NoGradGuard no_grad;
    const Tensor past = ToTensor(seen).unsqueeze(0);
    return ToMatrix(module->Forecast(past, torch::zeros({1})).squeeze(0)).transpose();
  }
};

}  // namespace

std::unique_ptr<ParticleTrainer> ParticleTrainer::Make(const ParticleLayout& layout,
                                                       const std::vector<LearntParticles>& learnt,
                                                       const std::vector<LearntParticles>& held,
                                                       const ParticleTrainingOptions& options) {
  return std::make_unique<ParticleTraining>(layout, learnt, held, options);
}

std::unique_ptr<SimlpeTrainer> SimlpeTrainer::Make(const ParticleLayout& layout,
                                                   const std::vector<LearntParticles>& learnt,
                                                   const std::vector<LearntParticles>& held,
                                                   const SimlpeTrainingOptions& options) {
  return std::make_unique<SimlpeTraining>(layout, learnt, held, options);
}

}  // namespace pushid
