// models: particles moved on by their network.
#include "models/generators/particle_network.h"

#include <algorithm>
#include <cmath>

namespace pushid {
namespace {

using Array = Eigen::ArrayXXf;

Array Sigmoid(const Eigen::Ref<const Array>& x) { return 1.0f / (1.0f + (-x).exp()); }

Eigen::MatrixXf Apply(const DenseLayer& layer, const Eigen::MatrixXf& inputs) {
  return (layer.weights * inputs).colwise() + layer.bias;
}

}  // namespace

ParticleRollout::ParticleRollout(const ParticleNetwork& network,
                                 const std::vector<ObservedMotion>& people, int copies,
                                 const Eigen::MatrixXf* jitter)
    : network_(network), people_(people), copies_(copies), jitter_(jitter) {
  const Eigen::Index count = static_cast<Eigen::Index>(people.size()) * copies;
  const int size = network.num_coordinates();
  hidden_ = Eigen::MatrixXf::Zero(kParticleHidden, count);
  history_ = Eigen::MatrixXf::Zero(kSkipSteps * size, count);
  log_likelihood_ = Eigen::VectorXf::Zero(count);
  log_mix_ = network.noise_mix.diagonal().array().log().sum();
  for (Eigen::Index t = 0; t < people.front().frames.cols(); ++t) {
    Eigen::MatrixXf pose(size, count);
    for (Eigen::Index n = 0; n < count; ++n) pose.col(n) = people[n / copies].frames.col(t);
    if (t == 0) pose_ = pose;
    Observe(pose);
  }
  shown_ = pose_;
  if (network.structure.corrected_frames > 0) PrepareCorrection();
}

void ParticleRollout::PrepareCorrection() {
  const int size = network_.num_coordinates();
  const Eigen::MatrixXf cosines = SeenCosines(frame_);
  Eigen::MatrixXf features(kParticleHidden + kCorrectionTerms * size, hidden_.cols());
  features.topRows(kParticleHidden) = hidden_;
  for (Eigen::Index n = 0; n < hidden_.cols(); ++n) {
    Eigen::MatrixXf seen = people_[n / copies_].frames.colwise() - network_.pose_mean;
    seen.array().colwise() /= network_.pose_spread.array();
    if (jitter_ != nullptr) seen.colwise() += jitter_->col(n);
    const Eigen::MatrixXf terms = seen * cosines.transpose();
    features.col(n).tail(kCorrectionTerms * size) = terms.reshaped();
  }
  const Array inner = Apply(network_.correction_hidden, features);
  const Eigen::MatrixXf elu = (inner > 0.0f).select(inner, inner.exp() - 1.0f);
  correction_ = Apply(network_.correction, elu);
}

void ParticleRollout::Observe(const Eigen::MatrixXf& pose) {
  const ParticleStructure& structure = network_.structure;
  const int size = network_.num_coordinates();
  const Eigen::Index count = pose.cols();
  const Eigen::MatrixXf step = (pose - pose_).array().colwise() / network_.step_spread.array();
  if (structure.HasSkip()) {
    const Eigen::MatrixXf older = history_.topRows((kSkipSteps - 1) * size);
    history_.bottomRows((kSkipSteps - 1) * size) = older;
    history_.topRows(size) = step;
  }
  pose_ = pose;
  Eigen::MatrixXf inputs(structure.NumInputs(size), count);
  if (structure.particles) inputs.topRows(size) = step;
  if (structure.poses) {
    auto seen = inputs.middleRows(structure.particles ? size : 0, size);
    seen = (pose.colwise() - network_.pose_mean).array().colwise() / network_.pose_spread.array();
    if (jitter_ != nullptr) seen += *jitter_;
  }
  ++frame_;
  const Array in = Apply(network_.input, inputs), own = Apply(network_.recurrent, hidden_);
  const int h = kParticleHidden;
  const Array reset = Sigmoid(in.topRows(h) + own.topRows(h));
  const Array update = Sigmoid(in.middleRows(h, h) + own.middleRows(h, h));
  const Array fresh = (in.bottomRows(h) + reset * own.bottomRows(h)).tanh();
  hidden_ = (1.0f - update) * fresh + update * hidden_.array();
}

const Eigen::MatrixXf& ParticleRollout::Step(const Eigen::MatrixXf* noise) {
  Eigen::MatrixXf next = Apply(network_.drift, hidden_);
  if (network_.structure.HasSkip()) next.noalias() += network_.skip * history_;
  if (noise != nullptr) {
    const Array log_noise =
        Apply(network_.noise, hidden_).array().min(kLargestLogNoise).max(kLeastLogNoise);
    const bool mixed = network_.noise_mix.size() > 0;
    const Eigen::MatrixXf drawn =
        mixed ? Eigen::MatrixXf(network_.noise_mix.triangularView<Eigen::Lower>() * *noise)
              : *noise;
    next.array() += log_noise.exp() * drawn.array();
    const float constant = 0.5f * std::log(2.0f * static_cast<float>(M_PI));
    log_likelihood_ = -(log_noise + 0.5f * noise->array().square() + constant)
                           .colwise()
                           .sum()
                           .matrix()
                           .transpose();
    log_likelihood_.array() -= log_mix_;
  }
  const bool steps = network_.structure.particles;
  next.array().colwise() *= (steps ? network_.step_spread : network_.pose_spread).array();
  Observe(steps ? Eigen::MatrixXf(pose_ + next)
                : Eigen::MatrixXf(next.colwise() + network_.pose_mean));
  shown_ = pose_;
  ++step_;
  const int corrected = network_.structure.corrected_frames, size = network_.num_coordinates();
  if (corrected == 0) return shown_;
  const Eigen::VectorXf sines = CorrectionSines(corrected).col(std::min(step_, corrected) - 1);
  Eigen::MatrixXf moved = Eigen::MatrixXf::Zero(size, shown_.cols());
  for (int k = 0; k < kCorrectionTerms; ++k) {
    moved += sines[k] * correction_.middleRows(k * size, size);
  }
  shown_ += network_.pose_spread.asDiagonal() * moved;
  return shown_;
}

Eigen::MatrixXf SeenCosines(int observed) {
  Eigen::MatrixXf cosines(kCorrectionTerms, observed);
  for (int k = 0; k < kCorrectionTerms; ++k) {
    for (int t = 0; t < observed; ++t) {
      cosines(k, t) =
          static_cast<float>(std::sqrt(2.0 / observed) * std::cos(M_PI * k * (t + 0.5) / observed));
    }
  }
  return cosines;
}

Eigen::MatrixXf CorrectionSines(int frames) {
  Eigen::MatrixXf sines(kCorrectionTerms, frames);
  for (int k = 0; k < kCorrectionTerms; ++k) {
    for (int u = 1; u <= frames; ++u) {
      sines(k, u - 1) = static_cast<float>(std::sin(M_PI * (k + 0.5) * u / frames));
    }
  }
  return sines;
}

namespace {

void ListTensors(const std::string& name, int coordinates, ParticleNetwork* network,
                 TensorFields* fields) {
  const ParticleStructure& structure = network->structure;
  fields->Matrix(name + ".pose_mean", coordinates, 1, &network->pose_mean);
  fields->Matrix(name + ".pose_spread", coordinates, 1, &network->pose_spread);
  fields->Matrix(name + ".step_spread", coordinates, 1, &network->step_spread);
  fields->Layer(name + ".input", structure.NumInputs(coordinates), kParticleGates, &network->input);
  fields->Layer(name + ".recurrent", kParticleHidden, kParticleGates, &network->recurrent);
  fields->Layer(name + ".drift", kParticleHidden, coordinates, &network->drift);
  fields->Layer(name + ".noise", kParticleHidden, coordinates, &network->noise);
  if (structure.correlated_noise) {
    fields->Matrix(name + ".noise_mix", coordinates, coordinates, &network->noise_mix);
  }
  if (structure.corrected_frames > 0) {
    const int terms = kCorrectionTerms * coordinates;
    fields->Layer(name + ".correction_hidden", kParticleHidden + terms, kCorrectionHidden,
                  &network->correction_hidden);
    fields->Layer(name + ".correction", kCorrectionHidden, terms, &network->correction);
  }
  if (structure.HasSkip()) {
    fields->Matrix(name + ".skip", coordinates, kSkipSteps * coordinates, &network->skip);
  }
}

}  // namespace

void AddTensors(const std::string& name, const ParticleNetwork& network, TensorList* tensors) {
  ParticleNetwork written = network;
  TensorFields fields(tensors);
  ListTensors(name, network.num_coordinates(), &written, &fields);
}

ParticleNetwork TakeParticles(const std::string& name, const ParticleStructure& structure,
                              int coordinates, TensorReader* reader) {
  ParticleNetwork network;
  network.structure = structure;
  TensorFields fields(reader);
  ListTensors(name, coordinates, &network, &fields);
  return network;
}

}  // namespace pushid
