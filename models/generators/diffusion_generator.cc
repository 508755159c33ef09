// models: the diffusion network, its inputs, and the sampling of groups.
#include "models/generators/diffusion_generator.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace pushid {
namespace {

constexpr float kLeastHipScale = 0.05f, kLeastJointScale = 0.02f;  // m
constexpr float kForceUnit = 10.0f;                                // N/kg
constexpr float kUsualMass = 80.0f, kUsualHip = 1.0f;              // kg, m
constexpr float kFirstPoseShare = 0.5f;
constexpr float kFramesUnit = 15.0f;

// Joints relative to the hip; the hip's rows stay.
Trajectories FromHip(const Trajectories& frames) {
  Trajectories seen = frames;
  for (int j = 1; j < kBodyJoints; ++j) seen.middleRows(3 * j, 3) -= frames.topRows(3);
  return seen;
}

// Displacements of FromHip since frame 0, m.
Trajectories Moved(const ObservedMotion& person) {
  Trajectories moved = FromHip(person.frames);
  moved.colwise() -= Eigen::VectorXf(moved.col(0));
  return moved;
}

// Rows in the person's own frames, in m.
Eigen::MatrixXf OwnRows(const ObservedMotion& person) {
  Eigen::MatrixXf rows(kOwnFrameRows, person.frames.cols());
  const Trajectories seen = FromHip(person.frames);
  for (Eigen::Index t = 0; t < rows.cols(); ++t) {
    const double heading = Heading(person.frames.col(t).cast<double>().reshaped(3, kBodyJoints));
    const Eigen::Matrix3f back = TurnAboutZ(-heading).cast<float>();
    rows.col(t).head(3) = seen.col(t).head(3) - seen.col(0).head(3);
    for (int j = 1; j < kBodyJoints; ++j) {
      rows.col(t).segment<3>(3 * j) = back * seen.col(t).segment<3>(3 * j);
    }
    rows.col(t).tail<2>() << static_cast<float>(std::cos(heading)),
        static_cast<float>(std::sin(heading));
  }
  return rows;
}

Trajectories FromOwnRows(const Eigen::MatrixXf& rows, const ObservedMotion& person) {
  Trajectories frames(kMotionRows, rows.cols());
  for (Eigen::Index t = 0; t < rows.cols(); ++t) {
    const Eigen::Vector3f hip = person.frames.col(0).head<3>() + rows.col(t).head<3>();
    // Estimated cosine and sine do not exactly have length 1.
    const Eigen::Matrix3f there =
        TurnAboutZ(std::atan2(rows(kOwnFrameRows - 1, t), rows(kOwnFrameRows - 2, t)))
            .cast<float>();
    frames.col(t).head<3>() = hip;
    for (int j = 1; j < kBodyJoints; ++j) {
      frames.col(t).segment<3>(3 * j) = hip + there * rows.col(t).segment<3>(3 * j);
    }
  }
  return frames;
}

Eigen::VectorXf ByCoordinate(const JointScales& scales) {
  return scales.transpose().replicate<3, 1>().reshaped();
}

bool IsPushed(const ObservedMotion& person) {
  return person.controls.size() > 0 && (person.controls.array() != 0.0f).any();
}

// The mean place of the pushed people, or of all if nobody is pushed.
Eigen::Vector2f Source(const std::vector<ObservedMotion>& group) {
  Eigen::Vector2f pushed = Eigen::Vector2f::Zero(), all = pushed;
  int count = 0;
  for (const ObservedMotion& person : group) {
    all += person.place / static_cast<float>(group.size());
    if (!IsPushed(person)) continue;
    pushed += person.place;
    ++count;
  }
  return count > 0 ? Eigen::Vector2f(pushed / static_cast<float>(count)) : all;
}

Eigen::MatrixXf PushOf(const std::vector<ObservedMotion>& group, int frames) {
  Eigen::MatrixXf push = Eigen::MatrixXf::Zero(kPushRows, frames);
  for (const ObservedMotion& person : group) {
    if (person.controls.size() == 0) continue;
    const Eigen::Index count = std::min<Eigen::Index>(frames, person.controls.cols());
    push.leftCols(count) += person.controls.leftCols(count);
  }
  return push;
}

constexpr float kNear = 0.8f, kSide = 0.1f, kAlone = 0.1f;  // m, m, weight of seeing nobody

void ApplySilu(Eigen::MatrixXf* values) {
  auto v = values->array();
  v /= 1.0f + (-v).exp();
}

// The kTaps frames of each convolution one below the other, at every `stride`-th frame.
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

Eigen::MatrixXf Perceptron(const DenseLayer& first, const DenseLayer& second,
                           const Eigen::MatrixXf& values) {
  Eigen::MatrixXf hidden = Applied(first, values);
  ApplySilu(&hidden);
  return Applied(second, hidden);
}

// Indices of people, sorted by x, then y.
std::vector<int> ByPlace(const std::vector<ObservedMotion>& people) {
  std::vector<int> order(people.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&people](int a, int b) {
    const Eigen::Vector2f &p = people[a].place, &q = people[b].place;
    return std::pair(p.x(), p.y()) < std::pair(q.x(), q.y());
  });
  return order;
}

void Draw(const std::vector<int>& order, const NormalSource& normal, Eigen::MatrixXf* noise) {
  const Eigen::Index frames = noise->cols() / static_cast<Eigen::Index>(order.size());
  for (const int n : order) {
    for (float& value : noise->middleCols(n * frames, frames).reshaped()) {
      value = static_cast<float>(normal());
    }
  }
}

constexpr double kLastTime = 1.0;  // of the last estimate, with hardly any noise

Pose PoseOf(const Trajectories& frames, Eigen::Index t) {
  return frames.col(t).cast<double>().reshaped(3, kBodyJoints);
}

// Fades the displacements from frame `first` on, to 1/e in `frames` frames.
void Settle(int first, double frames, Trajectories* motion) {
  const Trajectories before = *motion;
  for (Eigen::Index t = first; t < motion->cols(); ++t) {
    const double fade = std::exp(-static_cast<double>(t - first) / frames);
    motion->col(t) =
        motion->col(t - 1) + static_cast<float>(fade) * (before.col(t) - before.col(t - 1));
  }
}

const GroupChange kMirror = {true};

}  // namespace

MotionScales MotionScalesOf(const std::vector<std::vector<ObservedMotion>>& groups,
                            MotionFrame frame) {
  JointScales by_joint = JointScales::Zero();
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(kOwnFrameRows), squares = sum;
  std::vector<Eigen::VectorXf> first_poses;
  Eigen::Index frames = 0;
  for (const auto& group : groups) {
    for (const ObservedMotion& person : group) {
      const Trajectories moved = Moved(person);
      for (int j = 0; j < kBodyJoints; ++j) {
        by_joint[j] += moved.middleRows(3 * j, 3).squaredNorm() / 3.0f;
      }
      first_poses.emplace_back(FromHip(person.frames.leftCols(1)).bottomRows(kFirstPoseRows));
      frames += moved.cols();
      if (frame != MotionFrame::kOwn) continue;
      const Eigen::ArrayXXd rows = OwnRows(person).cast<double>();
      sum += rows.rowwise().sum();
      squares += rows.square().rowwise().sum();
    }
  }
  const double count = std::max(1.0, static_cast<double>(frames));
  MotionScales scales(
      (by_joint / static_cast<float>(count)).cwiseSqrt().cwiseMax(kLeastJointScale));
  scales.joints[kBodyHip] = std::max(scales.joints[kBodyHip], kLeastHipScale);
  Eigen::MatrixXf poses(kFirstPoseRows, static_cast<Eigen::Index>(first_poses.size()));
  for (size_t i = 0; i < first_poses.size(); ++i) poses.col(static_cast<int>(i)) = first_poses[i];
  scales.first_pose = ScalingOf(poses, kLeastJointScale);
  if (frame != MotionFrame::kOwn) return scales;
  constexpr double kLeastSpread = 1e-3;  // m, or of a cosine: rows that hardly move
  const Eigen::ArrayXd mean = sum / count;
  scales.mean = mean.cast<float>();
  const Eigen::ArrayXd variance = squares / count - mean.square();
  scales.spread = variance.max(kLeastSpread * kLeastSpread).sqrt().cast<float>();
  return scales;
}

Eigen::MatrixXf MotionRows(const ObservedMotion& person, const MotionScales& scales) {
  if (scales.own_frames()) {
    return scales.spread.cwiseInverse().asDiagonal() * (OwnRows(person).colwise() - scales.mean);
  }
  return ByCoordinate(scales.joints).cwiseInverse().asDiagonal() * Moved(person);
}

Trajectories FromMotionRows(const Eigen::MatrixXf& rows, const ObservedMotion& person,
                            const MotionScales& scales) {
  if (scales.own_frames()) {
    const Eigen::MatrixXf spread = scales.spread.asDiagonal() * rows;
    return FromOwnRows(spread.colwise() + scales.mean, person);
  }
  Trajectories frames = ByCoordinate(scales.joints).asDiagonal() * rows;
  frames.colwise() += Eigen::VectorXf(FromHip(person.frames.leftCols(1)));
  for (int j = 1; j < kBodyJoints; ++j) frames.middleRows(3 * j, 3) += frames.topRows(3);
  return frames;
}

GroupFeatures FeaturesOf(const std::vector<ObservedMotion>& group, const MotionScales& scales,
                         int observed, int frames, double dt) {
  GroupFeatures features;
  features.people = static_cast<int>(group.size());
  features.frames = frames;
  const int rows = scales.rows();
  features.given = Eigen::MatrixXf::Zero(GivenRows(rows), features.people * frames);
  features.statics.resize(kStaticRows, features.people);
  features.places.resize(2, features.people);
  const Eigen::MatrixXf push = PushOf(group, frames);
  const Eigen::Vector2f source = Source(group);
  const Eigen::Vector4f impulse = push.rowwise().sum() * static_cast<float>(dt);
  const float pushed_frames =
      static_cast<float>((push.array() != 0.0f).colwise().any().count()) / kFramesUnit;
  for (int n = 0; n < features.people; ++n) {
    const ObservedMotion& person = group[n];
    auto given = features.given.middleCols(n * frames, frames);
    if (observed > 0) {
      given.topLeftCorner(rows, observed) = MotionRows(person, scales).leftCols(observed);
      given.row(rows).head(observed).setOnes();
    }
    given.middleRows(rows + 1, kPushRows) = push / kForceUnit;
    const Trajectories first = FromHip(person.frames.leftCols(1));
    const Eigen::Vector2f from_source = person.place - source;
    const Eigen::MatrixXf pose = scales.first_pose.Scaled(first.bottomRows(kFirstPoseRows));
    features.statics.col(n) << kFirstPoseShare * pose, from_source, first(2, 0) - kUsualHip,
        person.mass / kUsualMass - 1.0f, IsPushed(person) ? 1.0f : 0.0f, impulse, pushed_frames;
    features.places.col(n) = person.place;
  }
  return features;
}

std::vector<ObservedMotion> Changed(const std::vector<ObservedMotion>& group,
                                    const GroupChange& change) {
  const float side = change.mirrored ? -1.0f : 1.0f;
  const Eigen::Matrix3f turn = static_cast<float>(change.size) *
                               TurnAboutZ(change.turn).cast<float>() *
                               Eigen::Vector3f(1.0f, side, 1.0f).asDiagonal();
  // theta leans towards +x, phi towards -y; the push is not scaled.
  Eigen::Matrix4f of_push = Eigen::Matrix4f::Zero();
  const Eigen::Matrix2f flat = turn.topLeftCorner<2, 2>() / static_cast<float>(change.size);
  const Eigen::Matrix2f lean =
      Eigen::Vector2f(1.0f, -1.0f).asDiagonal() * flat * Eigen::Vector2f(1.0f, -1.0f).asDiagonal();
  of_push << flat, Eigen::Matrix2f::Zero(), Eigen::Matrix2f::Zero(), lean;
  std::vector<ObservedMotion> changed = group;
  for (size_t n = 0; n < group.size(); ++n) {
    const ObservedMotion& person = group[n];
    for (int j = 0; j < kBodyJoints; ++j) {
      const int from = change.mirrored ? MirroredJoint(j) : j;
      changed[n].frames.middleRows(3 * j, 3) = turn * person.frames.middleRows(3 * from, 3);
    }
    changed[n].place = turn.topLeftCorner<2, 2>() * person.place;
    if (person.controls.size() > 0) changed[n].controls = of_push * person.controls;
    if (person.pendulum.size() > 0) changed[n].pendulum = turn * person.pendulum;
  }
  return changed;
}

BlockWidths WidthsOf(int block, const DiffusionStructure& structure) {
  const int* down = kDownWidths;
  const int deepest = down[kDiffusionLevels - 1];
  const auto pooled = [&structure](int level) {
    return kDownWidths[level] * (structure.PoolsAfter(level) ? 1 + structure.NumViews() : 1);
  };
  if (block == 0) return {structure.NumInputs(), down[0]};
  if (block < kDiffusionLevels) return {down[block - 1], down[block]};
  if (block == kDiffusionLevels) return {pooled(kDiffusionLevels - 1), deepest};
  // Input on the way up: the level below, and the level's output on the way down.
  const int level = kDiffusionBlocks - 1 - block;
  const int below = block == kDiffusionLevels + 1 ? deepest : down[level + 1];
  return {below + pooled(level), down[level]};
}

std::vector<Eigen::MatrixXf> PoolingWeights(SocialPooling pooling, const Eigen::Matrix2Xf& places) {
  const Eigen::Index people = places.cols();
  if (pooling == SocialPooling::kMeanAll) {
    return {Eigen::MatrixXf::Constant(people, people, 1.0f / static_cast<float>(people))};
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
  statics_ = Perceptron(network.first_static, network.second_static, features_.statics);
  views_ = PoolingWeights(network.structure.pooling, features_.places);
}

int GroupDenoiser::FramesOf(const Eigen::MatrixXf& values) const {
  return static_cast<int>(values.cols()) / features_.people;
}

Eigen::MatrixXf GroupDenoiser::Block(int index, const Eigen::MatrixXf& in,
                                     const Eigen::MatrixXf& conditions) const {
  const DiffusionBlock& block = network_.blocks[index];
  const int stride = index < kDiffusionLevels ? 2 : 1, frames = FramesOf(in) / stride;
  Eigen::MatrixXf out = Applied(block.first, Unfolded(in, FramesOf(in), stride));
  ApplySilu(&out);
  const Eigen::MatrixXf film = Applied(block.film, conditions);
  const Eigen::Index width = out.rows();
  for (int n = 0; n < features_.people; ++n) {
    auto person = out.middleCols(n * frames, frames).array();
    person.colwise() *= 1.0f + film.col(n).head(width).array();
    person.colwise() += film.col(n).tail(width).array();
  }
  out = Applied(block.second, Unfolded(out, frames, 1));
  ApplySilu(&out);
  out += Applied(block.skip, in(Eigen::all, Eigen::seq(0, Eigen::last, stride)));
  return out;
}

Eigen::MatrixXf GroupDenoiser::Attended(const DiffusionPool& pool,
                                        const Eigen::MatrixXf& values) const {
  const int people = features_.people;
  const Eigen::MatrixXf queries = Applied(pool.query, values);
  const Eigen::MatrixXf keys = Applied(pool.key, values);
  const Eigen::MatrixXf shown = Applied(pool.value, values);
  const Eigen::Index width = values.rows() / kHeads;
  const float scale = 1.0f / std::sqrt(static_cast<float>(width));
  const int frames = FramesOf(values);
  Eigen::MatrixXf seen(shown.rows(), shown.cols());
  for (int h = 0; h < kHeads; ++h) {
    const auto head = Eigen::seqN(h * width, width);
    for (int t = 0; t < frames; ++t) {
      const auto at = Eigen::seqN(t, people, frames);  // everybody's columns
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

Eigen::MatrixXf GroupDenoiser::Pooled(int block, const Eigen::MatrixXf& values) const {
  const DiffusionStructure& structure = network_.structure;
  if (!structure.PoolsAfter(block)) return values;
  const Eigen::Index width = values.rows(), size = width * FramesOf(values);
  Eigen::MatrixXf seen(structure.NumViews() * width, values.cols());
  if (structure.AttendsAfter(block)) {
    seen = Attended(network_.pools[structure.join == SocialJoin::kBottleneck ? 0 : block], values);
  } else {
    // All frames of a person in one column.
    const Eigen::Map<const Eigen::MatrixXf> all(values.data(), size, features_.people);
    for (size_t v = 0; v < views_.size(); ++v) {
      const Eigen::MatrixXf sums = all * views_[v].transpose();
      seen.middleRows(static_cast<Eigen::Index>(v) * width, width) =
          Eigen::Map<const Eigen::MatrixXf>(sums.data(), width, values.cols());
    }
  }
  return Stacked(values, seen);
}

Eigen::MatrixXf GroupDenoiser::Doubled(const Eigen::MatrixXf& values) const {
  Eigen::MatrixXf doubled(values.rows(), 2 * values.cols());
  for (Eigen::Index k = 0; k < values.cols(); ++k) {
    const Eigen::Index before = k % FramesOf(values) == 0 ? k : k - 1;
    doubled.col(2 * k) = 0.5f * (values.col(before) + values.col(k));
    doubled.col(2 * k + 1) = values.col(k);
  }
  return doubled;
}

Eigen::MatrixXf GroupDenoiser::Estimate(const Eigen::MatrixXf& noisy, double t) const {
  const int people = features_.people, frames = features_.frames;
  const int motion = network_.structure.NumMotion();
  Eigen::MatrixXf input = Eigen::MatrixXf::Zero(network_.structure.NumInputs(), people * frames_);
  for (int n = 0; n < people; ++n) {
    auto person = input.middleCols(n * frames_, frames);
    person.topRows(motion) = noisy.middleCols(n * frames, frames);
    person.bottomRows(features_.given.rows()) = features_.given.middleCols(n * frames, frames);
  }
  const Eigen::VectorXf time =
      Perceptron(network_.first_time, network_.second_time, TimeFeatures(t));
  Eigen::MatrixXf conditions = statics_.colwise() + time;
  ApplySilu(&conditions);
  std::vector<Eigen::MatrixXf> levels;
  for (int b = 0; b < kDiffusionLevels; ++b) {
    levels.push_back(Block(b, b == 0 ? input : levels.back(), conditions));
  }
  Eigen::MatrixXf at =
      Block(kDiffusionLevels, Pooled(kDiffusionLevels - 1, levels.back()), conditions);
  for (int level = kDiffusionLevels - 2; level >= 0; --level) {
    at = Block(kDiffusionBlocks - 1 - level, Stacked(Doubled(at), Pooled(level, levels[level])),
               conditions);
  }
  Eigen::MatrixXf out = Applied(network_.out, Unfolded(Doubled(at), frames_, 1));
  out += Applied(network_.direct, input);
  Eigen::MatrixXf estimate(motion, people * frames);
  for (int n = 0; n < people; ++n) {
    estimate.middleCols(n * frames, frames) = out.middleCols(n * frames_, frames);
  }
  return estimate;
}

void ListTensors(const std::string& prefix, DiffusionNetwork* network, TensorFields* fields) {
  const DiffusionStructure& structure = network->structure;
  fields->Positive(prefix + "scales", kBodyJoints, &network->scales.joints);
  fields->Scales(prefix + "first_pose", kFirstPoseRows, &network->scales.first_pose);
  if (structure.frame == MotionFrame::kOwn) {
    fields->Matrix(prefix + "row_mean", kOwnFrameRows, 1, &network->scales.mean);
    fields->Positive(prefix + "row_spread", kOwnFrameRows, &network->scales.spread);
  }
  fields->Layer(prefix + "time0", kTimeWidth, kConditionWidth, &network->first_time);
  fields->Layer(prefix + "time1", kConditionWidth, kConditionWidth, &network->second_time);
  fields->Layer(prefix + "static0", kStaticRows, kConditionWidth, &network->first_static);
  fields->Layer(prefix + "static1", kConditionWidth, kConditionWidth, &network->second_static);
  network->blocks.resize(kDiffusionBlocks);
  for (int b = 0; b < kDiffusionBlocks; ++b) {
    const BlockWidths widths = WidthsOf(b, structure);
    const std::string of_block = prefix + "block" + std::to_string(b);
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
    const std::string of_pool = prefix + "pool" + std::to_string(b);
    if (network->pools.size() <= p) network->pools.emplace_back();
    DiffusionPool& pool = network->pools[p++];
    fields->Layer(of_pool + ".query", width, width, &pool.query);
    fields->Layer(of_pool + ".key", width, width, &pool.key);
    fields->Layer(of_pool + ".value", width, width, &pool.value);
    fields->Layer(of_pool + ".mixed", width, width, &pool.mixed);
  }
  fields->Layer(prefix + "out", kTaps * kDownWidths[0], structure.NumMotion(), &network->out);
  fields->Layer(prefix + "direct", structure.NumInputs(), structure.NumMotion(), &network->direct);
}

Eigen::MatrixXf NoisedAgain(const Eigen::MatrixXf& estimate, const Eigen::MatrixXf& noise,
                            double u) {
  const double a = SignalShare(u);
  return static_cast<float>(std::sqrt(a)) * estimate +
         static_cast<float>(std::sqrt(1.0 - a)) * noise;
}

void PutPast(const std::vector<Eigen::MatrixXf>& past, Eigen::MatrixXf* estimate) {
  const Eigen::Index frames = estimate->cols() / static_cast<Eigen::Index>(past.size());
  for (size_t n = 0; n < past.size(); ++n) {
    estimate->middleCols(static_cast<Eigen::Index>(n) * frames, past[n].cols()) = past[n];
  }
}

DiffusionGenerator::DiffusionGenerator(ParticleLayout layout, std::vector<DiffusionNetwork> members,
                                       double dt, const DiffusionGeneratorOptions& options,
                                       std::function<NormalSource()> noise)
    : layout_(std::move(layout)),
      members_(std::move(members)),
      dt_(dt),
      options_(options),
      noise_(std::move(noise)) {}

std::vector<Trajectories> DiffusionGenerator::SampleWhole(const std::vector<ObservedMotion>& people,
                                                          const DiffusionNetwork& network,
                                                          int frames,
                                                          const NormalSource& normal) const {
  const int count = static_cast<int>(people.size());
  const int seen = static_cast<int>(people.front().frames.cols());
  const GroupDenoiser denoise(network, FeaturesOf(people, network.scales, seen, frames, dt_));
  std::vector<Eigen::MatrixXf> past;
  for (const ObservedMotion& person : people) past.push_back(MotionRows(person, network.scales));
  const std::vector<int> order = ByPlace(people);
  Eigen::MatrixXf fresh(network.structure.NumMotion(), count * frames), estimate;
  Draw(order, normal, &fresh);
  Eigen::MatrixXf noisy = fresh;
  for (int k = 0; k < options_.steps; ++k) {
    const double step = (kDiffusionTime - kLastTime) / std::max(1, options_.steps - 1);
    const double t = kDiffusionTime - k * step;
    const double u = k + 1 == options_.steps ? 0.0 : t - step;
    estimate = denoise.Estimate(noisy, t);
    // The last estimate keeps its own observed frames: the jump to the true ones fades afterwards.
    if (u <= 0.0) break;
    PutPast(past, &estimate);
    Draw(order, normal, &fresh);
    noisy = NoisedAgain(estimate, fresh, u);
  }
  std::vector<Trajectories> motions;
  for (int n = 0; n < count; ++n) {
    motions.push_back(
        FromMotionRows(estimate.middleCols(n * frames, frames), people[n], network.scales));
    if (options_.settle) Settle(options_.learnt_frames, options_.settling / dt_, &motions.back());
  }
  return motions;
}

Trajectories DiffusionGenerator::Finished(const ObservedMotion& person, Trajectories motion) const {
  const Eigen::Index seen = person.frames.cols();
  if (person.pendulum.size() > 0 && options_.blend > 0.0) {
    const Eigen::MatrixXf way = static_cast<float>(options_.blend) *
                                (person.pendulum.leftCols(motion.cols()) - motion.topRows(3));
    motion += way.replicate<kBodyJoints, 1>();
  }
  RestorationInput body;
  body.first_pose = PoseOf(person.frames, 0);
  body.dt = dt_;
  for (Eigen::Index t = 0; t < seen && seen > 1; ++t) body.seen.push_back(PoseOf(person.frames, t));
  BodyMotion poses;
  for (Eigen::Index t = 0; t < motion.cols(); ++t) poses.push_back(PoseOf(motion, t));
  Finish(body, options_.postprocess, &poses);
  for (Eigen::Index t = 0; t < motion.cols(); ++t) {
    motion.col(t) = poses[static_cast<size_t>(t)].reshaped().cast<float>();
  }
  return motion.rightCols(motion.cols() - seen);
}

std::vector<Trajectories> DiffusionGenerator::SampledMean(const std::vector<ObservedMotion>& people,
                                                          int frames) const {
  const NormalSource normal = noise_();
  const std::vector<ObservedMotion> mirrored = Changed(people, kMirror);
  std::vector<Trajectories> mean(people.size(), Trajectories::Zero(kMotionRows, frames));
  for (int k = 0; k < options_.averaged; ++k) {
    const bool other = options_.mirrored && k % 2 == 1;
    const DiffusionNetwork& network = Member(options_.mirrored ? k / 2 : k);
    const std::vector<Trajectories> sample =
        SampleWhole(other ? mirrored : people, network, frames, normal);
    for (size_t n = 0; n < people.size(); ++n) {
      mean[n] += other ? Changed({{sample[n]}}, kMirror).front().frames : sample[n];
    }
  }
  for (Trajectories& motion : mean) motion /= static_cast<float>(options_.averaged);
  return mean;
}

std::vector<Trajectories> DiffusionGenerator::Forecast(const std::vector<ObservedMotion>& people,
                                                       int frames) const {
  if (people.empty()) return {};
  const int whole = static_cast<int>(people.front().frames.cols()) + frames;
  std::vector<Trajectories> mean;
  if (options_.sampled && !options_.sampled->empty()) mean = *options_.sampled;
  if (mean.empty()) mean = SampledMean(people, whole);
  if (options_.sampled) *options_.sampled = mean;
  for (size_t n = 0; n < people.size(); ++n) mean[n] = Finished(people[n], std::move(mean[n]));
  return mean;
}

}  // namespace pushid
