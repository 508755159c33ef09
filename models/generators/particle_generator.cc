// models: particle networks, the ridge and siMLPe, and their blend.
#include "models/generators/particle_generator.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "models/decompositions.h"

namespace pushid {
namespace {

using Array = Eigen::ArrayXXf;

Array Sigmoid(const Eigen::Ref<const Array>& x) { return 1.0f / (1.0f + (-x).exp()); }

std::vector<Trajectories> Empty(const std::vector<ObservedMotion>& people, int count, int frames) {
  return std::vector<Trajectories>(people.size() * static_cast<size_t>(count),
                                   Trajectories::Zero(people.front().frames.rows(), frames));
}

// `last`: the column of the last observed frame.
Eigen::VectorXf Features(const Trajectories& motion, Eigen::Index last) {
  const Eigen::Index size = motion.rows();
  Eigen::VectorXf features(size * (1 + kRidgeDisplacements));
  features.head(size) = motion.col(last);
  for (int k = 0; k < kRidgeDisplacements; ++k) {
    features.segment((k + 1) * size, size) = motion.col(last - k) - motion.col(last - k - 1);
  }
  return features;
}

// Layer norm: each column to mean 0 and variance 1, then scale and shift by row.
Eigen::MatrixXf Normed(const Eigen::MatrixXf& values, const SimlpeBlock& block) {
  Eigen::MatrixXf normed = values.rowwise() - values.colwise().mean();
  const Eigen::RowVectorXf variance = normed.array().square().colwise().mean();
  normed.array().rowwise() /= (variance.array() + kNormSmooth).sqrt();
  normed.array().colwise() *= block.scale.array();
  return normed.colwise() + block.shift;
}

}  // namespace

ParticleRollout::ParticleRollout(const ParticleNetwork& network,
                                 const std::vector<ObservedMotion>& people, int copies,
                                 const Eigen::MatrixXf* jitter, const NormalSource* normal)
    : network_(network), people_(people), copies_(copies), jitter_(jitter) {
  const Eigen::Index count = static_cast<Eigen::Index>(people.size()) * copies;
  const int size = network.num_coordinates();
  hidden_ = memory_ = Eigen::MatrixXf::Zero(kParticleHidden, count);
  history_ = Eigen::MatrixXf::Zero(kSkipSteps * size, count);
  log_likelihood_ = Eigen::VectorXf::Zero(count);
  log_mix_ = network.noise_mix.diagonal().array().log().sum();
  for (Eigen::Index t = 0; t < people.front().frames.cols(); ++t) {
    Eigen::MatrixXf pose(size, count);
    for (Eigen::Index n = 0; n < count; ++n) pose.col(n) = people[n / copies].frames.col(t);
    if (t == 0) pose_ = pose;
    Observe(pose, normal);
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
  const Array inner = AppliedByEigen(network_.correction_hidden, features);
  const Eigen::MatrixXf elu = (inner > 0.0f).select(inner, inner.exp() - 1.0f);
  correction_ = AppliedByEigen(network_.correction, elu);
}

Eigen::MatrixXf ParticleRollout::Mapped(const Eigen::MatrixXf& noise) {
  const Array log_noise =
      AppliedByEigen(network_.noise, hidden_).array().min(kLargestLogNoise).max(kLeastLogNoise);
  const float constant = 0.5f * std::log(2.0f * static_cast<float>(M_PI));
  log_likelihood_ -=
      (log_noise + 0.5f * noise.array().square() + constant).colwise().sum().matrix().transpose();
  log_likelihood_.array() -= log_mix_;
  const bool mixed = network_.noise_mix.size() > 0;
  Eigen::MatrixXf mapped =
      mixed ? Eigen::MatrixXf(network_.noise_mix.triangularView<Eigen::Lower>() * noise) : noise;
  mapped.array() *= log_noise.exp();
  if (!network_.structure.noisy_input) return mapped;
  using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::MatrixXf below = AppliedByEigen(network_.noise_below, hidden_);
  for (Eigen::Index n = 0; n < noise.cols(); ++n) {
    const Eigen::Map<const Rows> g(below.col(n).data(), noise.rows(), noise.rows());
    mapped.col(n) += g.triangularView<Eigen::StrictlyLower>() * noise.col(n);
  }
  return mapped;
}

void ParticleRollout::Observe(const Eigen::MatrixXf& pose, const NormalSource* normal) {
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
  if (normal != nullptr) {
    Eigen::MatrixXf noise(size, count);
    for (float& value : noise.reshaped()) value = static_cast<float>((*normal)());
    inputs += Mapped(noise);
  }
  ++frame_;
  const Array in = AppliedByEigen(network_.input, inputs),
              own = AppliedByEigen(network_.recurrent, hidden_);
  const int h = kParticleHidden;
  if (structure.lstm) {
    const Array gates = in + own;
    memory_ = Sigmoid(gates.middleRows(h, h)) * memory_.array() +
              Sigmoid(gates.topRows(h)) * gates.middleRows(2 * h, h).tanh();
    hidden_ = Sigmoid(gates.bottomRows(h)) * memory_.array().tanh();
    return;
  }
  const Array reset = Sigmoid(in.topRows(h) + own.topRows(h));
  const Array update = Sigmoid(in.middleRows(h, h) + own.middleRows(h, h));
  const Array fresh = (in.bottomRows(h) + reset * own.bottomRows(h)).tanh();
  hidden_ = (1.0f - update) * fresh + update * hidden_.array();
}

const Eigen::MatrixXf& ParticleRollout::Step(const Eigen::MatrixXf* noise) {
  Eigen::MatrixXf next = AppliedByEigen(network_.drift, hidden_);
  if (network_.structure.HasSkip()) next.noalias() += network_.skip * history_;
  if (noise != nullptr) {
    log_likelihood_.setZero();
    next += Mapped(*noise);
  }
  const bool steps = network_.structure.summed;
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
  return Eigen::MatrixXf::NullaryExpr(kCorrectionTerms, observed, [=](double k, double t) {
    return static_cast<float>(std::sqrt(2.0 / observed) *
                              std::cos(M_PI * k * (t + 0.5) / observed));
  });
}

Eigen::MatrixXf CorrectionSines(int frames) {
  return Eigen::MatrixXf::NullaryExpr(kCorrectionTerms, frames, [=](double k, double before) {
    return static_cast<float>(std::sin(M_PI * (k + 0.5) * (before + 1.0) / frames));
  });
}

void ListTensors(const std::string& prefix, ParticleNetwork* network, TensorFields* fields) {
  const int coordinates = network->num_coordinates();
  const ParticleStructure& structure = network->structure;
  fields->Matrix(prefix + "pose_mean", coordinates, 1, &network->pose_mean);
  fields->Matrix(prefix + "pose_spread", coordinates, 1, &network->pose_spread);
  fields->Matrix(prefix + "step_spread", coordinates, 1, &network->step_spread);
  fields->Layer(prefix + "input", structure.NumInputs(coordinates), structure.NumGates(),
                &network->input);
  fields->Layer(prefix + "recurrent", kParticleHidden, structure.NumGates(), &network->recurrent);
  fields->Layer(prefix + "drift", kParticleHidden, coordinates, &network->drift);
  fields->Layer(prefix + "noise", kParticleHidden, coordinates, &network->noise);
  if (structure.noisy_input) {
    fields->Layer(prefix + "noise_below", kParticleHidden, coordinates * coordinates,
                  &network->noise_below);
  } else {
    fields->Matrix(prefix + "noise_mix", coordinates, coordinates, &network->noise_mix);
  }
  if (structure.corrected_frames > 0) {
    const int terms = kCorrectionTerms * coordinates;
    fields->Layer(prefix + "correction_hidden", kParticleHidden + terms, kCorrectionHidden,
                  &network->correction_hidden);
    fields->Layer(prefix + "correction", kCorrectionHidden, terms, &network->correction);
  }
  if (structure.HasSkip()) {
    fields->Matrix(prefix + "skip", coordinates, kSkipSteps * coordinates, &network->skip);
  }
}

ParticleGenerator::ParticleGenerator(ParticleLayout layout, std::vector<ParticleNetwork> members,
                                     BlendPartners partners,
                                     const ParticleGeneratorOptions& options)
    : layout_(std::move(layout)),
      members_(std::move(members)),
      partners_(std::move(partners)),
      options_(options) {}

std::vector<Trajectories> ParticleGenerator::MeanOfMembers(
    const std::vector<ObservedMotion>& people, int frames) const {
  std::vector<Trajectories> motions = Empty(people, 1, frames);
  const float share = 1.0f / static_cast<float>(members_.size());
  for (const ParticleNetwork& member : members_) {
    ParticleRollout rollout(member, people);
    for (int t = 0; t < frames; ++t) {
      const Eigen::MatrixXf& poses = rollout.Step();
      for (size_t n = 0; n < people.size(); ++n) {
        motions[n].col(t) += share * poses.col(static_cast<Eigen::Index>(n));
      }
    }
  }
  return motions;
}

void ParticleGenerator::Blend(const std::vector<ObservedMotion>& people,
                              std::vector<Trajectories>* motions) const {
  const Eigen::Index frames = motions->front().cols();
  const Eigen::ArrayXf fading =
      (-Eigen::ArrayXf::LinSpaced(frames, 1.0f, static_cast<float>(frames)) / kBlendFrames).exp();
  // Moves a forecast towards its partner, by a share for each frame.
  const auto blend = [](const Eigen::ArrayXf& share, const Trajectories& partner,
                        const Trajectories& members, Trajectories* motion) {
    *motion += (partner - members) * share.matrix().asDiagonal();
  };
  for (size_t n = 0; n < people.size(); ++n) {
    const Trajectories members = (*motions)[n], &seen = people[n].frames;
    if (options_.ridge_share > 0.0) {
      blend(static_cast<float>(options_.ridge_share) * fading,
            partners_.ridge.Forecast(seen).leftCols(frames), members, &(*motions)[n]);
    }
    if (options_.simlpe_share > 0.0) {
      Trajectories sum = Trajectories::Zero(seen.rows(), frames);
      for (const SimlpeNetwork& one : partners_.simlpe) {
        sum += one.Forecast(seen, static_cast<int>(frames));
      }
      blend(static_cast<float>(options_.simlpe_share) * (1.0f - fading),
            sum / static_cast<float>(partners_.simlpe.size()), members, &(*motions)[n]);
    }
  }
}

void ParticleGenerator::Finish(const ObservedMotion& person, Trajectories* motion) const {
  if (!options_.project_bones) return;
  ProjectBones(person.frames.rightCols(1), layout_, motion);
}

std::vector<Trajectories> ParticleGenerator::Forecast(const std::vector<ObservedMotion>& people,
                                                      int frames) const {
  if (people.empty()) return {};
  std::vector<Trajectories> motions = MeanOfMembers(people, frames);
  Blend(people, &motions);
  for (size_t n = 0; n < people.size(); ++n) Finish(people[n], &motions[n]);
  return motions;
}

std::vector<std::vector<SampledFuture>> ParticleGenerator::Sample(
    const std::vector<ObservedMotion>& people, int frames, int count,
    const NormalSource& normal) const {
  std::vector<std::vector<SampledFuture>> futures(people.size());
  if (people.empty() || count <= 0) return futures;
  const std::vector<Trajectories> mean = MeanOfMembers(people, frames);
  std::vector<Trajectories> blend = mean;
  Blend(people, &blend);
  const int num_members = static_cast<int>(members_.size());
  for (int m = 0; m < num_members; ++m) {
    const int share = count / num_members + (m < count % num_members ? 1 : 0);
    if (share == 0) continue;
    std::vector<Trajectories> motions = Empty(people, share, frames);
    Eigen::MatrixXf jitter(layout_.num_coordinates(), static_cast<Eigen::Index>(motions.size()));
    for (float& value : jitter.reshaped()) value = static_cast<float>(options_.jitter * normal());
    const bool goes_in = members_[m].structure.noisy_input;
    ParticleRollout rollout(members_[m], people, share, &jitter, goes_in ? &normal : nullptr);
    Eigen::VectorXf log_likelihood = rollout.log_likelihood();
    const float memory = static_cast<float>(options_.noise_memory);
    Eigen::MatrixXf noise = Eigen::MatrixXf::Zero(jitter.rows(), jitter.cols()), fresh = noise;
    for (int t = 0; t < frames; ++t) {
      const float fresh_share = t == 0 ? 1.0f : std::sqrt(1.0f - memory * memory);
      if (!goes_in) {
        for (float& value : fresh.reshaped()) value = static_cast<float>(normal());
        noise = memory * noise + fresh_share * fresh;
      }
      const Eigen::MatrixXf& poses = rollout.Step(goes_in ? nullptr : &noise);
      if (!goes_in) {
        // The density of correlated noise, relative to white noise of the same values.
        Eigen::VectorXf change =
            0.5f * (noise.colwise().squaredNorm() - fresh.colwise().squaredNorm()).transpose();
        change.array() -= static_cast<float>(noise.rows()) * std::log(fresh_share);
        log_likelihood += rollout.log_likelihood() + change;
      }
      for (size_t i = 0; i < motions.size(); ++i) {
        motions[i].col(t) = poses.col(static_cast<Eigen::Index>(i));
      }
    }
    for (size_t i = 0; i < motions.size(); ++i) {
      const size_t n = i / static_cast<size_t>(share);
      motions[i] += blend[n] - mean[n];
      Finish(people[n], &motions[i]);
      futures[n].push_back(
          {std::move(motions[i]), static_cast<double>(log_likelihood(static_cast<int>(i)))});
    }
  }
  return futures;
}

Trajectories RidgeForecast::Forecast(const Trajectories& observed) const {
  const Eigen::Index last = observed.cols() - 1;
  const Eigen::VectorXf change = weights * Features(observed, last) + bias;
  const Eigen::Map<const Eigen::MatrixXf> frames(change.data(), observed.rows(),
                                                 change.size() / observed.rows());
  return frames.colwise() + observed.col(last);
}

void RidgeFit::Add(const Trajectories& motion, int observed, int frames) {
  const Eigen::Index size = motion.rows(), windows = motion.cols() - observed - frames + 1;
  if (windows <= 0) return;
  const Eigen::Index inputs = size * (1 + kRidgeDisplacements), outputs = size * frames;
  if (count_ == 0.0) {
    features_squared_ = Eigen::MatrixXd::Zero(inputs, inputs);
    targets_by_features_ = Eigen::MatrixXd::Zero(outputs, inputs);
    feature_sum_ = Eigen::VectorXd::Zero(inputs), target_sum_ = Eigen::VectorXd::Zero(outputs);
  }
  Eigen::MatrixXd x(inputs, windows), y(outputs, windows);
  for (Eigen::Index i = 0; i < windows; ++i) {
    const Eigen::Index last = i + observed - 1;
    x.col(i) = Features(motion, last).cast<double>();
    const Eigen::MatrixXf future = motion.middleCols(last + 1, frames).colwise() - motion.col(last);
    y.col(i) = Eigen::Map<const Eigen::VectorXf>(future.data(), outputs).cast<double>();
  }
  features_squared_.noalias() += x * x.transpose();
  targets_by_features_.noalias() += y * x.transpose();
  feature_sum_ += x.rowwise().sum(), target_sum_ += y.rowwise().sum();
  count_ += static_cast<double>(windows);
}

RidgeForecast RidgeFit::Solve(double penalty) const {
  const Eigen::VectorXd mean_x = feature_sum_ / count_, mean_y = target_sum_ / count_;
  Eigen::MatrixXd squared = features_squared_ - count_ * mean_x * mean_x.transpose();
  squared.diagonal().array() += penalty;
  const Eigen::MatrixXd products = targets_by_features_ - count_ * mean_y * mean_x.transpose();
  const Eigen::MatrixXd weights =
      SolveSymmetric(squared, Eigen::MatrixXd(products.transpose())).transpose();
  return {weights.cast<float>(), (mean_y - weights * mean_x).cast<float>()};
}

Trajectories SimlpeNetwork::Forecast(const Trajectories& seen, int frames) const {
  const int given = observed();
  const Eigen::MatrixXf transform = CosineTransform(given).cast<float>();
  Trajectories motion = seen.rightCols(given);
  while (motion.cols() < given + frames) {
    const Eigen::MatrixXf last = motion.rightCols(given);
    Eigen::MatrixXf poses = last.colwise() - pose_mean;
    poses.array().colwise() /= pose_spread.array();
    Eigen::MatrixXf state = Applied(input, poses * transform.transpose());
    for (const SimlpeBlock& block : blocks) {
      state += Normed(Applied(block.mix, state.transpose()).transpose(), block);
    }
    const Eigen::MatrixXf moved = pose_spread.asDiagonal() * Applied(output, state) * transform;
    motion.conservativeResize(Eigen::NoChange, motion.cols() + given);
    motion.rightCols(given) = moved.colwise() + last.col(given - 1);
  }
  return motion.middleCols(given, frames);
}

void ListTensors(const std::string& prefix, SimlpeNetwork* network, TensorFields* fields) {
  const int observed = network->observed();
  const int coordinates = static_cast<int>(network->pose_mean.size());
  fields->Matrix(prefix + "pose_mean", coordinates, 1, &network->pose_mean);
  fields->Positive(prefix + "pose_spread", coordinates, &network->pose_spread);
  fields->Layer(prefix + "input", coordinates, coordinates, &network->input);
  fields->Layer(prefix + "output", coordinates, coordinates, &network->output);
  for (size_t i = 0; i < network->blocks.size(); ++i) {
    SimlpeBlock& block = network->blocks[i];
    const std::string of_block = prefix + "block" + std::to_string(i);
    fields->Layer(of_block + ".mix", observed, observed, &block.mix);
    fields->Matrix(of_block + ".scale", coordinates, 1, &block.scale);
    fields->Matrix(of_block + ".shift", coordinates, 1, &block.shift);
  }
}

}  // namespace pushid
