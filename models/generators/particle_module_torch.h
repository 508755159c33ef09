// models: the particles' network as a LibTorch module. Included by *_torch.cc files alone.
#pragma once

#include <Eigen/Cholesky>

#include "models/generators/generator_trainers.h"
#include "models/restoration/support_torch.h"

namespace pushid {

// Windows to learn from: frames of [batch, frame, coordinate], controls alike, and which frames
// there are (the rest repeats the last).
struct ParticleBatch {
  torch::Tensor frames, controls, present;
};

class ParticleModule : public torch::nn::Module {
 public:
  explicit ParticleModule(const ParticleNetwork& start)
      : structure_(start.structure), size_(start.num_coordinates()) {
    const int gates = structure_.NumGates() * kParticleHidden;
    const double bound = 1.0 / std::sqrt(static_cast<double>(kParticleHidden));
    const auto uniform = [bound](std::vector<int64_t> shape) {
      return (2.0 * torch::rand(shape) - 1.0) * bound;
    };
    pose_mean_ = ToTensor(start.pose_mean);
    pose_spread_ = ToTensor(start.pose_spread);
    step_spread_ = ToTensor(start.step_spread);
    control_spread_ = ToTensor(start.control_spread);
    input_ = register_parameter("input", uniform({gates, structure_.NumInputs(size_)}));
    recurrent_ = register_parameter("recurrent", uniform({gates, kParticleHidden}));
    input_bias_ = register_parameter("input_bias", uniform({gates}));
    recurrent_bias_ = register_parameter("recurrent_bias", uniform({gates}));
    drift_ = register_parameter("drift", torch::zeros({size_, kParticleHidden}));
    drift_bias_ = register_parameter("drift_bias", torch::zeros({size_}));
    if (structure_.HasSkip()) {
      const torch::Tensor older = torch::zeros({size_, (kSkipSteps - 1) * size_});
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
  }

  std::vector<torch::Tensor> DriftParameters() const {
    std::vector<torch::Tensor> all = {input_,          recurrent_, input_bias_,
                                      recurrent_bias_, drift_,     drift_bias_};
    if (structure_.HasSkip()) all.push_back(skip_);
    if (structure_.corrected_frames > 0) {
      for (const auto& layer : {correction_hidden_, correction_}) {
        all.insert(all.end(), {layer->weight, layer->bias});
      }
    }
    return all;
  }
  std::vector<torch::Tensor> NoiseParameters() const { return {noise_, noise_bias_}; }

  // Frames forecast after the first `observed`, [batch, frame, coordinate]. jitter: [batch, 1,
  // coordinate], in spreads. noise: e of every frame, [batch, frame, coordinate], of a sampled
  // path; undefined: the path without noise.
  torch::Tensor Forecast(const ParticleBatch& batch, const torch::Tensor& jitter, int observed,
                         int predicted, const torch::Tensor& noise = {}) const {
    const torch::Tensor past = batch.frames.narrow(1, 0, observed);
    const torch::Tensor steps = Steps(past);
    std::vector<torch::Tensor> state = Run(Inputs(steps, past, batch.controls, 0, jitter));
    const torch::Tensor correction = Correction(past, state[0], jitter, predicted);
    torch::Tensor pose = past.select(1, observed - 1), history = LastSteps(steps, observed);
    const torch::Tensor still = jitter.squeeze(1);
    std::vector<torch::Tensor> poses;
    for (int t = 0; t < predicted; ++t) {
      if (t > 0) {
        const torch::Tensor last = history.narrow(1, 0, size_);
        Move(Input(last, pose, batch.controls, observed + t - 1, still), &state);
      }
      torch::Tensor next = Drift(state[0], history);
      if (noise.defined()) next = next + LogNoise(state[0]).exp() * noise.select(1, t);
      const torch::Tensor moved = structure_.PredictsSteps() ? pose + step_spread_ * next
                                                             : pose_mean_ + pose_spread_ * next;
      const torch::Tensor step = structure_.PredictsSteps() ? next : (moved - pose) / step_spread_;
      history = torch::cat({step, history.narrow(1, 0, (kSkipSteps - 1) * size_)}, 1);
      pose = moved;
      poses.push_back(pose);
    }
    return torch::stack(poses, 1) + correction;
  }

  // Of the true motion: what the drift misses, e = p_{t+1} - f, and the hidden states, for t from
  // `first` - 1 on. drift_learns: off: no gradients reach the drift and the cell.
  std::pair<torch::Tensor, torch::Tensor> Misses(const ParticleBatch& batch,
                                                 const torch::Tensor& jitter, int first,
                                                 bool drift_learns = false) const {
    torch::AutoGradMode gradients(drift_learns && torch::GradMode::is_enabled());
    const torch::Tensor steps = Steps(batch.frames);
    const int64_t frames = batch.frames.size(1);
    const torch::Tensor before = batch.frames.narrow(1, 0, frames - 1);
    torch::Tensor hidden;
    Run(Inputs(steps.narrow(1, 0, frames - 1), before, batch.controls, 0, jitter), &hidden);
    std::vector<torch::Tensor> misses;
    for (int64_t t = first; t < frames; ++t) {
      const torch::Tensor drift = Drift(hidden.select(1, t - 1), LastSteps(steps, t));
      const torch::Tensor truth = structure_.PredictsSteps()
                                      ? steps.select(1, t)
                                      : (batch.frames.select(1, t) - pose_mean_) / pose_spread_;
      misses.push_back(truth - drift);
    }
    return {torch::stack(misses, 1), hidden.narrow(1, first - 1, frames - first)};
  }

  torch::Tensor LogNoise(const torch::Tensor& hidden) const {
    return torch::clamp(torch::matmul(hidden, noise_.t()) + noise_bias_, kLeastLogNoise,
                        kLargestLogNoise);
  }

  // scatter: of misses over their noise, summed over frames; its correlations become those of the
  // noise.
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
    if (structure_.correlated_noise) network.noise_mix = ToMatrix(noise_mix_);
    if (structure_.corrected_frames > 0) {
      network.correction_hidden = ToLayer(correction_hidden_);
      network.correction = ToLayer(correction_);
    }
    if (structure_.HasSkip()) network.skip = ToMatrix(skip_);
    return network;
  }

 private:
  // p_t of every frame; the first has none.
  torch::Tensor Steps(const torch::Tensor& frames) const {
    const int64_t count = frames.size(1);
    const torch::Tensor moved = (frames.narrow(1, 1, count - 1) - frames.narrow(1, 0, count - 1));
    return torch::cat({torch::zeros_like(frames.narrow(1, 0, 1)), moved / step_spread_}, 1);
  }
  // The last nine before frame `end`, newest first, as far as there are any.
  torch::Tensor LastSteps(const torch::Tensor& steps, int64_t end) const {
    std::vector<torch::Tensor> last;
    for (int64_t k = 1; k <= kSkipSteps; ++k) {
      last.push_back(end - k >= 0 ? steps.select(1, end - k)
                                  : torch::zeros_like(steps.select(1, 0)));
    }
    return torch::cat(last, 1);
  }
  torch::Tensor Inputs(const torch::Tensor& steps, const torch::Tensor& frames,
                       const torch::Tensor& controls, int64_t first,
                       const torch::Tensor& jitter) const {
    std::vector<torch::Tensor> parts;
    if (structure_.particles) parts.push_back(steps);
    if (structure_.poses) parts.push_back((frames - pose_mean_) / pose_spread_ + jitter);
    if (structure_.controls > 0) {
      parts.push_back(controls.narrow(1, first, frames.size(1)) / control_spread_);
    }
    return torch::cat(parts, 2);
  }
  torch::Tensor Input(const torch::Tensor& step, const torch::Tensor& pose,
                      const torch::Tensor& controls, int64_t frame,
                      const torch::Tensor& jitter) const {
    return Inputs(step.unsqueeze(1), pose.unsqueeze(1), controls, frame, jitter.unsqueeze(1))
        .squeeze(1);
  }
  // Of all frames forecast, [batch, frame, coordinate]; hidden: after the last that was seen.
  torch::Tensor Correction(const torch::Tensor& past, const torch::Tensor& hidden,
                           const torch::Tensor& jitter, int predicted) const {
    if (structure_.corrected_frames == 0) return torch::zeros({1});
    const torch::Tensor seen = (past - pose_mean_) / pose_spread_ + jitter;
    const torch::Tensor cosines = ToTensor(SeenCosines(static_cast<int>(past.size(1)))).t();
    const torch::Tensor features = torch::cat({hidden, torch::matmul(cosines, seen).flatten(1)}, 1);
    const torch::Tensor inner = torch::elu(
        torch::addmm(correction_hidden_->bias, features, correction_hidden_->weight.t()));
    const torch::Tensor terms = torch::addmm(correction_->bias, inner, correction_->weight.t())
                                    .reshape({past.size(0), kCorrectionTerms, size_});
    const torch::Tensor frames =
        torch::arange(predicted).clamp_max(structure_.corrected_frames - 1);
    return pose_spread_ * torch::matmul(sines_.index_select(0, frames), terms);
  }
  torch::Tensor Drift(const torch::Tensor& hidden, const torch::Tensor& history) const {
    torch::Tensor drift = torch::addmm(drift_bias_, hidden, drift_.t());
    return structure_.HasSkip() ? torch::addmm(drift, history, skip_.t()) : drift;
  }
  // The cell over all frames: hidden state (and memory) after the last; all of them on request.
  std::vector<torch::Tensor> Run(const torch::Tensor& inputs, torch::Tensor* all = nullptr) const {
    const torch::Tensor zero = torch::zeros({1, inputs.size(0), kParticleHidden});
    const std::vector<torch::Tensor> weights = {input_, recurrent_, input_bias_, recurrent_bias_};
    if (structure_.cell == ParticleCell::kGru) {
      const auto [hidden, last] =
          torch::gru(inputs, zero, weights, true, 1, 0.0, is_training(), false, true);
      if (all != nullptr) *all = hidden;
      return {last.squeeze(0)};
    }
    const auto [hidden, last, memory] =
        torch::lstm(inputs, {zero, zero}, weights, true, 1, 0.0, is_training(), false, true);
    if (all != nullptr) *all = hidden;
    return {last.squeeze(0), memory.squeeze(0)};
  }
  void Move(const torch::Tensor& input, std::vector<torch::Tensor>* state) const {
    if (structure_.cell == ParticleCell::kGru) {
      (*state)[0] =
          torch::gru_cell(input, (*state)[0], input_, recurrent_, input_bias_, recurrent_bias_);
      return;
    }
    const auto [hidden, memory] = torch::lstm_cell(input, {(*state)[0], (*state)[1]}, input_,
                                                   recurrent_, input_bias_, recurrent_bias_);
    *state = {hidden, memory};
  }

  ParticleStructure structure_;
  int64_t size_;
  torch::Tensor pose_mean_, pose_spread_, step_spread_, control_spread_;
  torch::Tensor input_, recurrent_, input_bias_, recurrent_bias_, drift_, drift_bias_, skip_;
  torch::Tensor noise_, noise_bias_, noise_mix_;
  torch::nn::Linear correction_hidden_{nullptr}, correction_{nullptr};
  torch::Tensor sines_;  // of the correction, a row a frame
};

class ParticleWindows {
 public:
  ParticleWindows(const ParticleLayout& layout, const std::vector<LearntParticles>& motions,
                  const ParticleTrainingOptions& options);

  int num_windows() const { return static_cast<int>(all_.size()); }
  // Drawn by group, window and side.
  ParticleBatch Draw() const;
  // At most `most` of all windows, evenly taken, none in the mirror.
  ParticleBatch Some(int most) const;

 private:
  struct Place {
    int64_t row, last_row;  // where the window begins, where its motion ends
  };
  ParticleBatch Gather(const std::vector<Place>& places) const;

  const ParticleTrainingOptions& options_;
  torch::Tensor frames_, controls_;  // of all motions below one another, then of all mirrored
  int64_t mirrored_rows_ = 0;        // where the mirrored begin
  std::vector<Place> all_;
  std::vector<std::vector<Place>> by_group_;
  std::vector<double> group_share_;  // summed up
};

// How particles and siMLPe are trained.
inline constexpr double kLossUnits = 1e3;  // the gradient is clipped with the loss in mm
// Share of the largest rate: up in a straight line, then down to nothing by a cosine.
inline double RateShareToZero(int step, int steps, int warm_up) {
  const int up = std::min(warm_up, std::max(1, steps / 2));
  if (step < up) return (step + 1.0) / up;
  return 0.5 * (1.0 + std::cos(M_PI * (step - up) / std::max(1, steps - up)));
}

// Means and spreads of poses and displacements, over the motions and their mirror images.
ParticleNetwork ParticleStatistics(const ParticleLayout& layout,
                                   const std::vector<LearntParticles>& motions,
                                   const ParticleTrainingOptions& options);

}  // namespace pushid
