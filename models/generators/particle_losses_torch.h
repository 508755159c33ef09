// models: what a forecast of particles is charged. Included by *_torch.cc files alone.
#pragma once

#include "models/generators/particle_module_torch.h"

namespace pushid {

class ParticleLosses {
 public:
  ParticleLosses(const ParticleLayout& layout, const ParticleTrainingOptions& options)
      : options_(options) {
    const int64_t count = layout.num_particles();
    weights_ = torch::tensor(layout.weights);
    weights_ = weights_ / weights_.sum();
    frames_ = torch::ones({options.predicted});
    if (!options.even_frames) {
      frames_ = 1.0 / torch::arange(1, options.predicted + 1, torch::kFloat32);
    }
    parents_ = torch::zeros({count}, torch::kInt64);
    has_bone_ = torch::zeros({count});
    fixed_ = torch::zeros({count, 3});
    is_fixed_ = torch::zeros({count, 1});
    for (int64_t i = 0; i < count; ++i) {
      const int parent = layout.parents[static_cast<size_t>(i)];
      if (parent != kNoBone) has_bone_[i] = 1.0f;
      if (parent >= 0) parents_[i] = parent;
      if (parent != kFixedPoint) continue;
      is_fixed_[i][0] = 1.0f;
      for (int k = 0; k < 3; ++k) fixed_[i][k] = layout.fixed(k, i);
    }
  }

  // Of forecasts, [batch, frame, coordinate], against the windows they belong to; m.
  torch::Tensor operator()(const torch::Tensor& forecast, const ParticleBatch& batch) const {
    const torch::Tensor truth = batch.frames.narrow(1, options_.observed, options_.predicted);
    const torch::Tensor present = batch.present.narrow(1, options_.observed, options_.predicted);
    const torch::Tensor share = frames_ * present;
    const auto mean = [&](const torch::Tensor& by_frame) {
      return (by_frame * share).sum() / share.sum();
    };
    const torch::Tensor squares = (Points(forecast) - Points(truth)).square().sum(3);
    const torch::Tensor weights = weights_.to(squares.scalar_type());
    torch::Tensor loss =
        options_.distance * mean(torch::matmul((squares + kSmooth).sqrt(), weights));
    if (options_.squared > 0.0) {
      loss = loss + options_.squared * mean(torch::matmul(squares, weights));
    }
    if (options_.changes > 0.0) {
      const auto changes = [](const torch::Tensor& of) { return Points(of).diff(1, 1); };
      const torch::Tensor misfit = changes(forecast) - changes(truth);
      const torch::Tensor distances = (misfit.square().sum(3) + kSmooth).sqrt();
      const torch::Tensor share_of = share.narrow(1, 1, options_.predicted - 1);
      loss = loss + options_.changes * (torch::matmul(distances, weights) * share_of).sum() /
                        share_of.sum();
    }
    if (options_.bones > 0.0) {
      const torch::Tensor misfit = (Bones(forecast) - Bones(truth)).abs() * has_bone_;
      loss = loss + options_.bones * mean(misfit.sum(2) / has_bone_.sum());
    }
    return loss;
  }

 private:
  static constexpr double kSmooth = 1e-12;  // m^2; a root has no derivative at 0

  static torch::Tensor Points(const torch::Tensor& motion) {
    return motion.reshape({motion.size(0), motion.size(1), motion.size(2) / 3, 3});
  }
  torch::Tensor Bones(const torch::Tensor& motion) const {
    const torch::Tensor points = Points(motion);
    const torch::Tensor starts =
        points.index_select(2, parents_) * (1.0 - is_fixed_) + fixed_ * is_fixed_;
    return ((points - starts).square().sum(3) + kSmooth).sqrt();
  }

  const ParticleTrainingOptions& options_;
  torch::Tensor weights_, frames_, parents_, has_bone_, fixed_, is_fixed_;
};

// A training on windows: of particles, and of siMLPe.
template <typename Run, typename Self, typename Options>
struct WindowsRun : StepsRun<Run, Self> {
  WindowsRun(const ParticleLayout& layout, const std::vector<LearntParticles>& learnt,
             const std::vector<LearntParticles>& held, const Options& given)
      : options(given),
        windows(layout, learnt, options),
        held_windows(layout, held, options),
        losses(layout, options) {}

  Options options;
  ParticleWindows windows, held_windows;
  ParticleLosses losses;

  virtual double LossOfHeld(const ParticleBatch& batch, int of_step) = 0;
  double HeldLoss(int of_step) override {
    constexpr int kHeldWindows = 256;
    if (held_windows.num_windows() == 0) return std::nan("");
    torch::NoGradGuard no_grad;
    return LossOfHeld(held_windows.Some(kHeldWindows), of_step);
  }
};

// Of transitions, elementwise (NoiseLoss): `misses` of the drift, in the units of the noise.
inline torch::Tensor TransitionLoss(NoiseLoss loss, const torch::Tensor& misses,
                                    const torch::Tensor& log_noise) {
  switch (loss) {
    case NoiseLoss::kLikelihood:
      return log_noise + 0.5 * misses.square() * (-2.0 * log_noise).exp();
    case NoiseLoss::kSquared:
      return misses.square() + (2.0 * log_noise).exp();
    case NoiseLoss::kDrawn:
      break;
  }
  return (misses - log_noise.exp() * torch::randn_like(misses)).square();
}

// A Wasserstein critic of whole forecasts (SDE's Eq. 12): three layers of 256 on what moves from
// the last observed frame on, in the pose's spreads.
class ParticleCritic : public torch::nn::Module {
 public:
  ParticleCritic(int64_t inputs, torch::Tensor spread) : spread_(std::move(spread)) {
    layers_ = register_module(
        "layers", torch::nn::Sequential(torch::nn::Linear(inputs, kWidth), torch::nn::ELU(),
                                        torch::nn::Linear(kWidth, kWidth), torch::nn::ELU(),
                                        torch::nn::Linear(kWidth, kWidth), torch::nn::ELU(),
                                        torch::nn::Linear(kWidth, 1)));
  }
  torch::Tensor Features(const torch::Tensor& forecast, const torch::Tensor& last) const {
    return ((forecast - last) / spread_).flatten(1);
  }
  torch::Tensor Score(const torch::Tensor& features) { return layers_->forward(features).mean(); }

  // The critic's own loss: forecasts below truths, with a slope of 1 in between.
  torch::Tensor Loss(const torch::Tensor& forecast, const torch::Tensor& truth) {
    const torch::Tensor share = torch::rand({truth.size(0), 1});
    const torch::Tensor between =
        (share * truth + (1.0 - share) * forecast).detach().requires_grad_(true);
    const torch::Tensor slope =
        torch::autograd::grad({layers_->forward(between).sum()}, {between}, {}, true, true)[0];
    return Score(forecast) - Score(truth) + kPenalty * (slope.norm(2, 1) - 1.0).square().mean();
  }

 private:
  static constexpr int64_t kWidth = 256;
  static constexpr double kPenalty = 10.0;
  torch::Tensor spread_;
  torch::nn::Sequential layers_{nullptr};
};

}  // namespace pushid
