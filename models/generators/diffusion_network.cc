// models: forward through the diffusion network.
#include "models/generators/diffusion_network.h"

#include <cmath>

namespace pushid {
namespace {

constexpr float kNear = 0.8f, kSide = 0.1f, kAlone = 0.1f;  // m, m, weight of seeing nobody

void ApplySilu(Eigen::MatrixXf* values) {
  auto v = values->array();
  v /= 1.0f + (-v).exp();
}

// The three frames that a convolution sees below one another; every `stride`-th of them.
Eigen::MatrixXf Unfolded(const Eigen::MatrixXf& values, int frames, int stride) {
  const Eigen::Index channels = values.rows(), people = values.cols() / frames;
  const int count = frames / stride;
  Eigen::MatrixXf unfolded(kTaps * channels, people * count);
  for (Eigen::Index n = 0; n < people; ++n) {
    for (int k = 0; k < count; ++k) {
      for (int tap = 0; tap < kTaps; ++tap) {
        const int t = stride * k + tap - (kTaps - 1);
        auto to = unfolded.col(n * count + k).segment(tap * channels, channels);
        if (t < 0) {
          to.setZero();
        } else {
          to = values.col(n * frames + t);
        }
      }
    }
  }
  return unfolded;
}

Eigen::MatrixXf EverySecond(const Eigen::MatrixXf& values) {
  return values(Eigen::all, Eigen::seq(0, Eigen::last, 2));
}

Eigen::MatrixXf Below(const Eigen::MatrixXf& a, const Eigen::MatrixXf& b) {
  Eigen::MatrixXf both(a.rows() + b.rows(), a.cols());
  both << a, b;
  return both;
}

Eigen::MatrixXf Perceived(const DenseLayer& first, const DenseLayer& second,
                          const Eigen::MatrixXf& values) {
  Eigen::MatrixXf hidden = Applied(first, values);
  ApplySilu(&hidden);
  return Applied(second, hidden);
}

int StrideOf(int block) { return block < kDiffusionLevels ? 2 : 1; }

}  // namespace

BlockWidths WidthsOf(int block, const DiffusionStructure& structure) {
  const int* down = kDownWidths;
  const int deepest = down[kDiffusionLevels - 1];
  const auto pooled = [&structure](int level) {
    return kDownWidths[level] * (structure.PoolsAfter(level) ? 1 + structure.NumViews() : 1);
  };
  if (block == 0) return {structure.NumInputs(), down[0]};
  if (block < kDiffusionLevels) return {down[block - 1], down[block]};
  if (block == kDiffusionLevels) return {pooled(kDiffusionLevels - 1), deepest};
  // Up from the level below, beside what the level had on the way down.
  const int level = kDiffusionBlocks - 1 - block;
  const int below = block == kDiffusionLevels + 1 ? deepest : down[level + 1];
  return {below + pooled(level), down[level]};
}

std::vector<Eigen::MatrixXf> PoolingWeights(SocialPooling pooling, const Eigen::Matrix2Xf& places) {
  const Eigen::Index people = places.cols();
  if (pooling == SocialPooling::kMeanAll) {
    return {Eigen::MatrixXf::Constant(people, people, 1.0f / static_cast<float>(people))};
  }
  if (pooling == SocialPooling::kMean) {
    Eigen::MatrixXf others = Eigen::MatrixXf::Ones(people, people);
    others.diagonal().setZero();
    return {others / static_cast<float>(std::max<Eigen::Index>(1, people - 1))};
  }
  if (pooling != SocialPooling::kLocal) return {};
  Eigen::MatrixXf ahead = Eigen::MatrixXf::Zero(people, people), behind = ahead;
  for (Eigen::Index i = 0; i < people; ++i) {
    for (Eigen::Index j = 0; j < people; ++j) {
      if (i == j) continue;
      const Eigen::Vector2f d = places.col(j) - places.col(i);
      const float near = std::exp(-d.squaredNorm() / (kNear * kNear));
      const float in_front = 1.0f / (1.0f + std::exp(-d.x() / kSide));
      ahead(i, j) = near * in_front;
      behind(i, j) = near * (1.0f - in_front);
    }
  }
  for (Eigen::MatrixXf* view : {&ahead, &behind}) {
    const Eigen::VectorXf sums = view->rowwise().sum().array() + kAlone;
    *view = sums.cwiseInverse().asDiagonal() * *view;
  }
  return {ahead, behind};
}

Eigen::VectorXf TimeFeatures(double t) {
  constexpr int kHalf = kTimeWidth / 2;
  constexpr double kSlowest = 1e4;
  Eigen::VectorXf features(kTimeWidth);
  for (int i = 0; i < kHalf; ++i) {
    const double angle = t * std::pow(kSlowest, -static_cast<double>(i) / kHalf);
    features[i] = static_cast<float>(std::sin(angle));
    features[kHalf + i] = static_cast<float>(std::cos(angle));
  }
  return features;
}

GroupDenoiser::GroupDenoiser(const DiffusionNetwork& network, GroupFeatures features)
    : network_(network),
      features_(std::move(features)),
      frames_((features_.frames + kDiffusionFrames - 1) / kDiffusionFrames * kDiffusionFrames) {
  statics_ = Perceived(network.first_static, network.second_static, features_.statics);
  views_ = PoolingWeights(network.structure.pooling, features_.places);
}

GroupDenoiser::Values GroupDenoiser::Block(int index, const Values& in,
                                           const Eigen::MatrixXf& conditions) const {
  const DiffusionBlock& block = network_.blocks[index];
  const int stride = StrideOf(index), frames = in.frames / stride;
  Values out{Applied(block.first, Unfolded(in.data, in.frames, stride)), frames};
  ApplySilu(&out.data);
  const Eigen::MatrixXf film = Applied(block.film, conditions);
  const Eigen::Index width = out.data.rows();
  for (int n = 0; n < features_.people; ++n) {
    auto person = out.data.middleCols(n * frames, frames).array();
    person.colwise() *= 1.0f + film.col(n).head(width).array();
    person.colwise() += film.col(n).tail(width).array();
  }
  out.data = Applied(block.second, Unfolded(out.data, frames, 1));
  ApplySilu(&out.data);
  out.data += Applied(block.skip, stride == 2 ? EverySecond(in.data) : in.data);
  return out;
}

Eigen::MatrixXf GroupDenoiser::Attended(const DiffusionPool& pool, const Values& values) const {
  const int people = features_.people;
  const Eigen::MatrixXf queries = Applied(pool.query, values.data);
  const Eigen::MatrixXf keys = Applied(pool.key, values.data);
  const Eigen::MatrixXf shown = Applied(pool.value, values.data);
  const Eigen::Index width = values.data.rows() / kHeads;
  const float scale = 1.0f / std::sqrt(static_cast<float>(width));
  Eigen::MatrixXf seen(shown.rows(), shown.cols());
  for (int h = 0; h < kHeads; ++h) {
    const auto head = Eigen::seqN(h * width, width);
    for (int t = 0; t < values.frames; ++t) {
      const auto at = Eigen::seqN(t, people, values.frames);  // everybody's columns
      const Eigen::MatrixXf query = queries(head, at), key = keys(head, at);
      const Eigen::MatrixXf value = shown(head, at);
      Eigen::MatrixXf weights = scale * key.transpose() * query;
      for (int i = 0; i < people; ++i) {
        weights.col(i) = (weights.col(i).array() - weights.col(i).maxCoeff()).exp();
        weights.col(i) /= weights.col(i).sum();
      }
      seen(head, at) = value * weights;
    }
  }
  return Applied(pool.mixed, seen);
}

GroupDenoiser::Values GroupDenoiser::Pooled(int block, const Values& values) const {
  const DiffusionStructure& structure = network_.structure;
  if (!structure.PoolsAfter(block)) return values;
  const Eigen::Index width = values.data.rows(), size = width * values.frames;
  Eigen::MatrixXf seen(structure.NumViews() * width, values.data.cols());
  if (structure.AttendsAfter(block)) {
    seen = Attended(network_.pools[structure.join == SocialJoin::kBottleneck ? 0 : block], values);
  } else {
    // A person's frames below one another, a column per person.
    const Eigen::Map<const Eigen::MatrixXf> all(values.data.data(), size, features_.people);
    for (size_t v = 0; v < views_.size(); ++v) {
      const Eigen::MatrixXf sums = all * views_[v].transpose();
      seen.middleRows(static_cast<Eigen::Index>(v) * width, width) =
          Eigen::Map<const Eigen::MatrixXf>(sums.data(), width, values.data.cols());
    }
  }
  return {Below(values.data, seen), values.frames};
}

GroupDenoiser::Values GroupDenoiser::Doubled(const Values& values) const {
  Values doubled{Eigen::MatrixXf(values.data.rows(), 2 * values.data.cols()), 2 * values.frames};
  for (Eigen::Index k = 0; k < values.data.cols(); ++k) {
    const Eigen::Index before = k % values.frames == 0 ? k : k - 1;
    doubled.data.col(2 * k) = 0.5f * (values.data.col(before) + values.data.col(k));
    doubled.data.col(2 * k + 1) = values.data.col(k);
  }
  return doubled;
}

Eigen::MatrixXf GroupDenoiser::Estimate(const Eigen::MatrixXf& noisy, double t) const {
  const int people = features_.people, frames = features_.frames;
  const int motion = network_.structure.NumMotion();
  Values input{Eigen::MatrixXf::Zero(network_.structure.NumInputs(), people * frames_), frames_};
  for (int n = 0; n < people; ++n) {
    auto person = input.data.middleCols(n * frames_, frames);
    person.topRows(motion) = noisy.middleCols(n * frames, frames);
    person.bottomRows(features_.given.rows()) = features_.given.middleCols(n * frames, frames);
  }
  const Eigen::VectorXf time =
      Perceived(network_.first_time, network_.second_time, TimeFeatures(t));
  Eigen::MatrixXf conditions = statics_.colwise() + time;
  ApplySilu(&conditions);
  std::vector<Values> levels;
  for (int b = 0; b < kDiffusionLevels; ++b) {
    levels.push_back(Block(b, b == 0 ? input : levels.back(), conditions));
  }
  Values at = Block(kDiffusionLevels, Pooled(kDiffusionLevels - 1, levels.back()), conditions);
  for (int level = kDiffusionLevels - 2; level >= 0; --level) {
    at = Doubled(at);
    at.data = Below(at.data, Pooled(level, levels[level]).data);
    at = Block(kDiffusionBlocks - 1 - level, at, conditions);
  }
  at = Doubled(at);
  Eigen::MatrixXf out = Applied(network_.out, Unfolded(at.data, frames_, 1));
  out += Applied(network_.direct, input.data);
  Eigen::MatrixXf estimate(motion, people * frames);
  for (int n = 0; n < people; ++n) {
    estimate.middleCols(n * frames, frames) = out.middleCols(n * frames_, frames);
  }
  return estimate;
}

namespace {

void ListTensors(const std::string& name, DiffusionNetwork* network, TensorFields* fields) {
  const DiffusionStructure& structure = network->structure;
  fields->Positive(name + ".scales", kBodyJoints, &network->scales.joints);
  fields->Scales(name + ".first_pose", kFirstPoseRows, &network->scales.first_pose);
  if (structure.frame == MotionFrame::kOwn) {
    fields->Matrix(name + ".row_mean", kOwnFrameRows, 1, &network->scales.mean);
    fields->Positive(name + ".row_spread", kOwnFrameRows, &network->scales.spread);
  }
  fields->Layer(name + ".time0", kTimeWidth, kConditionWidth, &network->first_time);
  fields->Layer(name + ".time1", kConditionWidth, kConditionWidth, &network->second_time);
  fields->Layer(name + ".static0", kStaticRows, kConditionWidth, &network->first_static);
  fields->Layer(name + ".static1", kConditionWidth, kConditionWidth, &network->second_static);
  network->blocks.resize(kDiffusionBlocks);
  for (int b = 0; b < kDiffusionBlocks; ++b) {
    const BlockWidths widths = WidthsOf(b, structure);
    const std::string of_block = name + ".block" + std::to_string(b);
    DiffusionBlock& block = network->blocks[b];
    fields->Layer(of_block + ".first", kTaps * widths.in, widths.out, &block.first);
    fields->Layer(of_block + ".second", kTaps * widths.out, widths.out, &block.second);
    fields->Layer(of_block + ".skip", widths.in, widths.out, &block.skip);
    fields->Layer(of_block + ".film", kConditionWidth, 2 * widths.out, &block.film);
  }
  size_t p = 0;
  for (int b = 0; b < kDiffusionLevels; ++b) {
    if (!structure.AttendsAfter(b)) continue;
    const int width = WidthsOf(b, structure).out;
    const std::string of_pool = name + ".pool" + std::to_string(b);
    if (network->pools.size() <= p) network->pools.emplace_back();
    DiffusionPool& pool = network->pools[p++];
    fields->Layer(of_pool + ".query", width, width, &pool.query);
    fields->Layer(of_pool + ".key", width, width, &pool.key);
    fields->Layer(of_pool + ".value", width, width, &pool.value);
    fields->Layer(of_pool + ".mixed", width, width, &pool.mixed);
  }
  fields->Layer(name + ".out", kTaps * kDownWidths[0], structure.NumMotion(), &network->out);
  fields->Layer(name + ".direct", structure.NumInputs(), structure.NumMotion(), &network->direct);
}

}  // namespace

void AddTensors(const std::string& name, const DiffusionNetwork& network, TensorList* tensors) {
  DiffusionNetwork written = network;
  TensorFields fields(tensors);
  ListTensors(name, &written, &fields);
}

DiffusionNetwork TakeDiffusion(const std::string& name, const DiffusionStructure& structure,
                               TensorReader* reader) {
  DiffusionNetwork network;
  network.structure = structure;
  TensorFields fields(reader);
  ListTensors(name, &network, &fields);
  return network;
}

}  // namespace pushid
