// models: the particle network as a LibTorch module, and its losses. Included by *_torch.cc files
// alone.
#pragma once

#include <Eigen/Cholesky>

#include "models/generators/generator_trainers.h"
#include "models/restoration/support_torch.h"

namespace pushid {

// Training windows are tensors [batch, frame, coordinate].

// sum_j g^ij w^j of `draws` w. log_noise: log g^ii. below: NoiseBelow.
inline Tensor MappedNoise(const Tensor& log_noise, const Tensor& below, const Tensor& draws) {
  const Tensor own = log_noise.exp() * draws;
  if (!below.defined()) return own;
  return own + torch::matmul(below.tril(-1), draws.unsqueeze(-1)).squeeze(-1);
}

// The loss of transitions by coordinate (NoiseLoss). misses: errors of the drift, p - f; drawn: w.
inline Tensor TransitionLoss(NoiseLoss loss, const Tensor& misses, const Tensor& log_noise,
                             const Tensor& below, const Tensor& drawn) {
  if (loss == NoiseLoss::kDrawn) return (misses - MappedNoise(log_noise, below, drawn)).square();
  if (!below.defined()) return log_noise + 0.5 * misses.square() * (-2.0 * log_noise).exp();
  const Tensor g = below.tril(-1) + torch::diag_embed(log_noise.exp());
  const Tensor w = torch::linalg_solve_triangular(g, misses.unsqueeze(-1), false);
  return log_noise + 0.5 * w.squeeze(-1).square();
}

class ParticleModule : public torch::nn::Module {
 public:
  explicit ParticleModule(const ParticleNetwork& start)
      : structure_(start.structure), size_(start.num_coordinates()) {
    const int gates = structure_.NumGates();
    const double bound = 1.0 / std::sqrt(static_cast<double>(kParticleHidden));
    const auto uniform = [bound](std::vector<int64_t> shape) {
      return (2.0 * torch::rand(shape) - 1.0) * bound;
    };
    pose_mean_ = ToTensor(start.pose_mean);
    pose_spread_ = ToTensor(start.pose_spread);
    step_spread_ = ToTensor(start.step_spread);
    input_ = register_parameter("input", uniform({gates, structure_.NumInputs(size_)}));
    recurrent_ = register_parameter("recurrent", uniform({gates, kParticleHidden}));
    input_bias_ = register_parameter("input_bias", uniform({gates}));
    recurrent_bias_ = register_parameter("recurrent_bias", uniform({gates}));
    drift_ = register_parameter("drift", torch::zeros({size_, kParticleHidden}));
    drift_bias_ = register_parameter("drift_bias", torch::zeros({size_}));
    if (structure_.HasSkip()) {
      const Tensor older = torch::zeros({size_, (kSkipSteps - 1) * size_});
      skip_ = register_parameter("skip", torch::cat({torch::eye(size_), older}, 1));
    }
    if (structure_.corrected_frames > 0) {
      const int terms = kCorrectionTerms * static_cast<int>(size_);
      correction_hidden_ = register_module(
          "correction_hidden", torch::nn::Linear(kParticleHidden + terms, kCorrectionHidden));
      correction_ = register_module("correction", torch::nn::Linear(kCorrectionHidden, terms));
      torch::nn::init::zeros_(correction_->weight);
      torch::nn::init::zeros_(correction_->bias);
      sines_ = ToTensor(CorrectionSines(structure_.corrected_frames));
    }
    noise_ = register_parameter("noise", torch::zeros({size_, kParticleHidden}));
    noise_bias_ = register_parameter("noise_bias", torch::full({size_}, -1.0));
    noise_mix_ = register_buffer("noise_mix", torch::eye(size_));
    if (!structure_.noisy_input) return;
    noise_below_ =
        register_module("noise_below", torch::nn::Linear(kParticleHidden, size_ * size_));
    torch::nn::init::zeros_(noise_below_->weight);
    torch::nn::init::zeros_(noise_below_->bias);
  }

  std::vector<Tensor> DriftParameters() const {
    std::vector<Tensor> all = {input_,          recurrent_, input_bias_,
                               recurrent_bias_, drift_,     drift_bias_};
    if (structure_.HasSkip()) all.push_back(skip_);
    if (structure_.corrected_frames > 0) {
      for (const auto& layer : {correction_hidden_, correction_}) {
        all.insert(all.end(), {layer->weight, layer->bias});
      }
    }
    return all;
  }
  std::vector<Tensor> NoiseParameters() const {
    if (!structure_.noisy_input) return {noise_, noise_bias_};
    return {noise_, noise_bias_, noise_below_->weight, noise_below_->bias};
  }

  // The forecast after the first `observed` frames, [batch, frame, coordinate]. jitter: [batch, 1,
  // coordinate], in spreads. noise: w_1:K of noisy_input, [batch, frame, coordinate]; undefined: 0.
  Tensor Forecast(const Tensor& batch, const Tensor& jitter, int observed, int predicted,
                  const Tensor& noise = {}) const {
    const Tensor past = batch.narrow(1, 0, observed);
    const Tensor steps = Steps(past);
    CellState state = Run(Inputs(steps, past, jitter), noise).second;
    const Tensor correction = Correction(past, state.hidden, jitter, predicted);
    Tensor pose = past.select(1, observed - 1), history = LastSteps(steps, observed);
    const Tensor still = jitter.squeeze(1);
    std::vector<Tensor> poses;
    for (int t = 0; t < predicted; ++t) {
      if (t > 0) {
        const Tensor last = history.narrow(1, 0, size_);
        state = Advanced(Inputs(last, pose, still), state);
      }
      const Tensor next = Drift(state.hidden, history);
      const Tensor moved =
          structure_.summed ? pose + step_spread_ * next : pose_mean_ + pose_spread_ * next;
      const Tensor step = structure_.summed ? next : (moved - pose) / step_spread_;
      history = torch::cat({step, history.narrow(1, 0, (kSkipSteps - 1) * size_)}, 1);
      pose = moved;
      poses.push_back(pose);
    }
    return torch::stack(poses, 1) + correction;
  }

  // The drift's errors on the true motion, e = p_{t+1} - f, and the hidden states, for t from
  // `first` - 1 on. drift_learns: gradients reach the drift and the cell.
  std::pair<Tensor, Tensor> Misses(const Tensor& batch, const Tensor& jitter, int first,
                                   bool drift_learns = false) const {
    torch::AutoGradMode gradients(drift_learns && torch::GradMode::is_enabled());
    const Tensor steps = Steps(batch);
    const int64_t frames = batch.size(1);
    const Tensor before = batch.narrow(1, 0, frames - 1);
    const Tensor hidden = Run(Inputs(steps.narrow(1, 0, frames - 1), before, jitter)).first;
    std::vector<Tensor> misses;
    for (int64_t t = first; t < frames; ++t) {
      const Tensor drift = Drift(hidden.select(1, t - 1), LastSteps(steps, t));
      const Tensor truth =
          structure_.summed ? steps.select(1, t) : (batch.select(1, t) - pose_mean_) / pose_spread_;
      misses.push_back(truth - drift);
    }
    return {torch::stack(misses, 1), hidden.narrow(1, first - 1, frames - first)};
  }

  Tensor LogNoise(const Tensor& hidden) const {
    return torch::clamp(torch::matmul(hidden, noise_.t()) + noise_bias_, kLeastLogNoise,
                        kLargestLogNoise);
  }

  // g^ij, [.., i, j], of which only the part below the diagonal is used; undefined if g is
  // diagonal.
  Tensor NoiseBelow(const Tensor& hidden) const {
    if (!structure_.noisy_input) return {};
    std::vector<int64_t> shape = hidden.sizes().vec();
    shape.back() = size_, shape.push_back(size_);
    return torch::linear(hidden, noise_below_->weight, noise_below_->bias).reshape(shape);
  }

  // Sets the correlations of the noise to those of `scatter`, the sum over frames of e e^T, e: the
  // drift's errors over g.
  void SetScatter(const Eigen::MatrixXd& scatter) {
    const Eigen::VectorXd scale = scatter.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
    Eigen::MatrixXd correlations =
        (1.0 - kOwnNoise) * (scale.asDiagonal() * scatter * scale.asDiagonal());
    correlations.diagonal().setOnes();
    const Eigen::MatrixXd mix = correlations.llt().matrixL();
    noise_mix_.copy_(ToTensor(Eigen::MatrixXf(mix.transpose().cast<float>())));
  }

  ParticleNetwork Network(ParticleNetwork network) const {
    network.input = {ToMatrix(input_), ToVector(input_bias_)};
    network.recurrent = {ToMatrix(recurrent_), ToVector(recurrent_bias_)};
    network.drift = {ToMatrix(drift_), ToVector(drift_bias_)};
    network.noise = {ToMatrix(noise_), ToVector(noise_bias_)};
    if (structure_.noisy_input) {
      network.noise_below = ToLayer(noise_below_);
    } else {
      network.noise_mix = ToMatrix(noise_mix_);
    }
    if (structure_.corrected_frames > 0) {
      network.correction_hidden = ToLayer(correction_hidden_);
      network.correction = ToLayer(correction_);
    }
    if (structure_.HasSkip()) network.skip = ToMatrix(skip_);
    return network;
  }

 private:
  // p_t of every frame; 0 at the first.
  Tensor Steps(const Tensor& frames) const {
    const int64_t count = frames.size(1);
    const Tensor moved = (frames.narrow(1, 1, count - 1) - frames.narrow(1, 0, count - 1));
    return torch::cat({torch::zeros_like(frames.narrow(1, 0, 1)), moved / step_spread_}, 1);
  }
  // The last nine displacements before frame `end`, newest first; 0 before frame 0.
  Tensor LastSteps(const Tensor& steps, int64_t end) const {
    std::vector<Tensor> last;
    for (int64_t k = 1; k <= kSkipSteps; ++k) {
      last.push_back(end - k >= 0 ? steps.select(1, end - k)
                                  : torch::zeros_like(steps.select(1, 0)));
    }
    return torch::cat(last, 1);
  }
  // Works on all frames, or on one.
  Tensor Inputs(const Tensor& steps, const Tensor& frames, const Tensor& jitter) const {
    std::vector<Tensor> parts;
    if (structure_.particles) parts.push_back(steps);
    if (structure_.poses) parts.push_back((frames - pose_mean_) / pose_spread_ + jitter);
    return torch::cat(parts, -1);
  }
  // The correction of all forecast frames, [batch, frame, coordinate]; hidden: after the last
  // observed frame.
  Tensor Correction(const Tensor& past, const Tensor& hidden, const Tensor& jitter,
                    int predicted) const {
    if (structure_.corrected_frames == 0) return torch::zeros({1});
    const Tensor seen = (past - pose_mean_) / pose_spread_ + jitter;
    const Tensor cosines = ToTensor(SeenCosines(static_cast<int>(past.size(1)))).t();
    const Tensor features = torch::cat({hidden, torch::matmul(cosines, seen).flatten(1)}, 1);
    const Tensor inner = torch::elu(
        torch::addmm(correction_hidden_->bias, features, correction_hidden_->weight.t()));
    const Tensor terms = torch::addmm(correction_->bias, inner, correction_->weight.t())
                             .reshape({past.size(0), kCorrectionTerms, size_});
    const Tensor frames = torch::arange(predicted).clamp_max(structure_.corrected_frames - 1);
    return pose_spread_ * torch::matmul(sines_.index_select(0, frames), terms);
  }
  Tensor Drift(const Tensor& hidden, const Tensor& history) const {
    Tensor drift = torch::addmm(drift_bias_, hidden, drift_.t());
    return structure_.HasSkip() ? torch::addmm(drift, history, skip_.t()) : drift;
  }
  struct CellState {
    Tensor hidden, memory;
  };
  CellState Advanced(const Tensor& input, const CellState& from) const {
    if (!structure_.lstm) {
      return {torch::gru_cell(input, from.hidden, input_, recurrent_, input_bias_, recurrent_bias_),
              {}};
    }
    const auto [hidden, memory] = torch::lstm_cell(input, {from.hidden, from.memory}, input_,
                                                   recurrent_, input_bias_, recurrent_bias_);
    return {hidden, memory};
  }
  // Runs the cell over all frames: all hidden states, and the last state. noise: as in Forecast.
  std::pair<Tensor, CellState> Run(const Tensor& inputs, const Tensor& noise = {}) const {
    const Tensor zero = torch::zeros({inputs.size(0), kParticleHidden});
    if (!structure_.lstm && !noise.defined()) {
      const std::vector<Tensor> weights = {input_, recurrent_, input_bias_, recurrent_bias_};
      const auto [all, last] =
          torch::gru(inputs, zero.unsqueeze(0), weights, true, 1, 0.0, is_training(), false, true);
      return {all, {last.squeeze(0), {}}};
    }
    CellState state = {zero, zero};
    std::vector<Tensor> all;
    for (int64_t t = 0; t < inputs.size(1); ++t) {
      Tensor input = inputs.select(1, t);
      if (noise.defined()) {
        input = input +
                MappedNoise(LogNoise(state.hidden), NoiseBelow(state.hidden), noise.select(1, t));
      }
      state = Advanced(input, state);
      all.push_back(state.hidden);
    }
    return {torch::stack(all, 1), state};
  }

  ParticleStructure structure_;
  int64_t size_;
  Tensor pose_mean_, pose_spread_, step_spread_;
  Tensor input_, recurrent_, input_bias_, recurrent_bias_, drift_, drift_bias_, skip_;
  Tensor noise_, noise_bias_, noise_mix_;
  torch::nn::Linear noise_below_{nullptr};
  torch::nn::Linear correction_hidden_{nullptr}, correction_{nullptr};
  Tensor sines_;  // of the correction, a row per frame
};

// The losses of forecasts.
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

  // forecast: [batch, frame, coordinate], m; batch: the windows.
  Tensor operator()(const Tensor& forecast, const Tensor& batch) const {
    const Tensor truth = batch.narrow(1, options_.observed, options_.predicted);
    const Tensor share = frames_ * torch::ones({batch.size(0), options_.predicted});
    const auto mean = [&](const Tensor& by_frame) {
      return (by_frame * share).sum() / share.sum();
    };
    const Tensor squares = (Points(forecast) - Points(truth)).square().sum(3);
    const Tensor weights = weights_.to(squares.scalar_type());
    Tensor loss = options_.distance * mean(torch::matmul((squares + kSmooth).sqrt(), weights));
    if (options_.squared > 0.0) {
      loss = loss + options_.squared * mean(torch::matmul(squares, weights));
    }
    if (options_.changes > 0.0) {
      const auto changes = [](const Tensor& of) { return Points(of).diff(1, 1); };
      const Tensor misfit = changes(forecast) - changes(truth);
      const Tensor distances = (misfit.square().sum(3) + kSmooth).sqrt();
      const Tensor share_of = share.narrow(1, 1, options_.predicted - 1);
      loss = loss + options_.changes * (torch::matmul(distances, weights) * share_of).sum() /
                        share_of.sum();
    }
    if (options_.bones > 0.0) {
      const Tensor misfit = (Bones(forecast) - Bones(truth)).abs() * has_bone_;
      loss = loss + options_.bones * mean(misfit.sum(2) / has_bone_.sum());
    }
    return loss;
  }

 private:
  static constexpr double kSmooth = 1e-12;  // m^2; a root has no derivative at 0

  static Tensor Points(const Tensor& motion) {
    return motion.reshape({motion.size(0), motion.size(1), motion.size(2) / 3, 3});
  }
  Tensor Bones(const Tensor& motion) const {
    const Tensor points = Points(motion);
    const Tensor starts = points.index_select(2, parents_) * (1.0 - is_fixed_) + fixed_ * is_fixed_;
    return ((points - starts).square().sum(3) + kSmooth).sqrt();
  }

  const ParticleTrainingOptions& options_;
  Tensor weights_, frames_, parents_, has_bone_, fixed_, is_fixed_;
};

// A Wasserstein critic of whole forecasts (SDE's Eq. 12). Its input are the displacements since the
// last observed frame, in spreads of the pose: two fully connected layers of 256, and a third for
// the score.
class ParticleCritic : public torch::nn::Module {
 public:
  ParticleCritic(int64_t inputs, Tensor spread) : spread_(std::move(spread)) {
    layers_ = register_module(
        "layers", torch::nn::Sequential(torch::nn::Linear(inputs, kWidth), torch::nn::ELU(),
                                        torch::nn::Linear(kWidth, kWidth), torch::nn::ELU(),
                                        torch::nn::Linear(kWidth, 1)));
  }
  Tensor Features(const Tensor& forecast, const Tensor& last) const {
    return ((forecast - last) / spread_).flatten(1);
  }
  Tensor Score(const Tensor& features) { return layers_->forward(features).mean(); }

  // The critic's own loss: the score of forecasts minus that of truths, with a penalty for slopes
  // other than 1 at `share`, [batch, 1], of the way from forecast to truth.
  Tensor Loss(const Tensor& forecast, const Tensor& truth, const Tensor& share) {
    const Tensor between = (share * truth + (1.0 - share) * forecast).detach().requires_grad_(true);
    const Tensor slope =
        torch::autograd::grad({layers_->forward(between).sum()}, {between}, {}, true, true)[0];
    return Score(forecast) - Score(truth) + kPenalty * (slope.norm(2, 1) - 1.0).square().mean();
  }

 private:
  static constexpr int64_t kWidth = 256;
  static constexpr double kPenalty = 10.0;
  Tensor spread_;
  torch::nn::Sequential layers_{nullptr};
};

}  // namespace pushid
