// models: the trainer of particles, in LibTorch.
#include <algorithm>

#include "models/generators/particle_losses_torch.h"

namespace pushid {
namespace {

constexpr int kScatterBatches = 32;  // thousands of windows for the correlations of the noise

torch::Tensor NoJitter(const ParticleBatch& batch) {
  return torch::zeros({batch.frames.size(0), 1, batch.frames.size(2)});
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

  torch::Tensor Jitter(const ParticleBatch& batch) const {
    return options.jitter * torch::randn({batch.frames.size(0), 1, batch.frames.size(2)});
  }

  torch::Tensor NoiseLossOf(const ParticleBatch& batch, const torch::Tensor& jitter) const {
    const int first =
        std::min(options.together ? kFirstTransition : kFirstNoiseStep, options.observed);
    const auto [misses, hidden] = module->Misses(batch, jitter, first, options.together);
    const torch::Tensor share =
        batch.present.narrow(1, first, misses.size(1)).unsqueeze(2).expand_as(misses);
    const torch::Tensor charge =
        TransitionLoss(options.noise_loss, misses, module->LogNoise(hidden));
    return (charge * share).sum() / share.sum();
  }

  // What is observed of windows.
  ParticleBatch Observed(const ParticleBatch& batch) const {
    const auto seen = [this](const torch::Tensor& of) { return of.narrow(1, 0, options.observed); };
    return {seen(batch.frames), seen(batch.controls), seen(batch.present)};
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
    const ParticleBatch batch = windows.Draw();
    const torch::Tensor jitter = Jitter(batch);
    const double share =
        options.constant_rate ? 1.0 : RateShareToZero(step, options.steps, options.warm_up);
    const double rate = options.learning_rate * share;
    torch::Tensor drawn;
    if (options.together) {
      drawn = torch::randn({batch.frames.size(0), options.predicted, batch.frames.size(2)});
    }
    const torch::Tensor forecast =
        module->Forecast(batch, jitter, options.observed, options.predicted, drawn);
    torch::Tensor loss = losses(forecast, batch);
    if (options.together) {
      loss = loss + options.transitions * NoiseLossOf(Observed(batch), jitter);
    }
    const double shown = loss.item<double>();
    if (critic) {
      const torch::Tensor last = batch.frames.narrow(1, options.observed - 1, 1);
      const torch::Tensor made = critic->Features(forecast, last);
      const torch::Tensor real =
          critic->Features(batch.frames.narrow(1, options.observed, options.predicted), last);
      ImproveAt(rate, critics.get(), critic->parameters(), critic->Loss(made.detach(), real));
      loss = loss - options.critic * critic->Score(made);
    }
    ImproveAt(rate, drift.get(), Trained(), kLossUnits * loss);
    return shown;
  }

  double NoiseStep() {
    const ParticleBatch batch = windows.Draw();
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
      const ParticleBatch batch = windows.Draw();
      const auto [misses, hidden] = module->Misses(batch, Jitter(batch), first);
      const torch::Tensor present = batch.present.narrow(1, first, misses.size(1)).unsqueeze(2);
      const torch::Tensor scaled =
          (misses * present * (-module->LogNoise(hidden)).exp()).flatten(0, 1);
      scatter += ToMatrix(torch::matmul(scaled.t(), scaled)).cast<double>();
    }
    module->SetScatter(scatter);
  }

  double LossOfHeld(const ParticleBatch& batch, int of_step) override {
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
  ParticleBatch batch;
  batch.frames = ToTensor(person.frames).unsqueeze(0);
  batch.controls = ToTensor(person.controls).unsqueeze(0);
  const torch::Tensor forecast = As<Torch>().module->Forecast(
      batch, NoJitter(batch), static_cast<int>(person.frames.cols()), frames);
  return ToMatrix(forecast.squeeze(0)).transpose();
}

}  // namespace pushid
