// models: frames of LDP's chain and back, and the chain, forward.
#include "models/restoration/cvae_restoration.h"

#include <cmath>
#include <iterator>
#include <numeric>

#include "models/restoration/body.h"

namespace pushid {
namespace {

// Where positions are measured from.
Eigen::Vector3d OriginOf(const RestorationInput& person, const Pose& pose,
                         CvaeCoordinates coordinates) {
  return coordinates == CvaeCoordinates::kTip ? pose.col(0) : person.first_pose.col(0);
}

double Wrapped(double angle) { return std::remainder(angle, 2.0 * M_PI); }

// What both halves share of one frame, in the heading's frame.
struct FrameParts {
  Eigen::Vector2d way;
  double facing_change = 0.0;
  Pose positions, changes;
  std::array<Rotation6d, kBodyJoints> rotations;
};

void Fill(const FrameParts& parts, const std::vector<int>& joints, int frame,
          Eigen::MatrixXf* out) {
  const int n = static_cast<int>(joints.size());
  if (n == 0) return;
  auto column = out->col(frame);
  column.head<2>() = parts.way.cast<float>();
  column[2] = static_cast<float>(parts.facing_change);
  for (int i = 0; i < n; ++i) {
    column.segment<3>(3 + 3 * i) = parts.positions.col(joints[i]).cast<float>();
    column.segment<3>(3 + 3 * (n + i)) = parts.changes.col(joints[i]).cast<float>();
    column.segment<6>(3 + 6 * (n + i)) = parts.rotations[joints[i]].cast<float>();
  }
}

void TakePositions(const Eigen::MatrixXf& frames, const std::vector<int>& joints, int frame,
                   Pose* pose) {
  for (size_t i = 0; i < joints.size(); ++i) {
    pose->col(joints[i]) = frames.block<3, 1>(3 + 3 * static_cast<int>(i), frame).cast<double>();
  }
}

bool SameRate(double a, double b) { return std::abs(a / b - 1.0) < 1e-3; }

// No rows without a pendulum; a column per frame all the same.
Eigen::MatrixXf ScaledPendulum(const CvaeWeights& weights, const RestorationInput& person) {
  const Eigen::MatrixXf frames = PendulumFrames(person, weights.layout);
  return weights.layout.pendulum ? weights.pendulum.Scaled(frames) : frames;
}

Eigen::MatrixXf Stacked(const Eigen::MatrixXf& above, const Eigen::MatrixXf& below) {
  Eigen::MatrixXf both(above.rows() + below.rows(), above.cols());
  both << above, below;
  return both;
}

Eigen::MatrixXf Apply(const DenseLayer& layer, const Eigen::MatrixXf& inputs) {
  Eigen::MatrixXf out(layer.weights.rows(), inputs.cols());
  out.noalias() = layer.weights * inputs;
  out.colwise() += layer.bias;
  return out;
}

// Sum over the experts of share x output.
Eigen::MatrixXf Blend(const DenseLayer& experts, const Eigen::MatrixXf& inputs,
                      const Eigen::MatrixXf& shares) {
  const Eigen::MatrixXf all = Apply(experts, inputs);
  const Eigen::Index rows = all.rows() / kExperts;
  Eigen::MatrixXf mixed = Eigen::MatrixXf::Zero(rows, inputs.cols());
  for (int e = 0; e < kExperts; ++e) {
    mixed.array() += all.middleRows(e * rows, rows).array().rowwise() * shares.row(e).array();
  }
  return mixed;
}

// e^x over the sum, column by column.
Eigen::MatrixXf Softmax(const Eigen::MatrixXf& values) {
  Eigen::MatrixXf shares = values.rowwise() - values.colwise().maxCoeff();
  shares = shares.array().exp();
  const Eigen::RowVectorXf sums = shares.colwise().sum();
  shares.array().rowwise() /= sums.array();
  return shares;
}

// The next frame by the sampler, or the mean over draws of z where there is no pendulum.
Eigen::MatrixXf NextFrame(const CvaeSampler& sampler, const CvaeDecoder& decoder,
                          const Eigen::MatrixXf& condition, const Eigen::MatrixXf& pendulum,
                          const Eigen::MatrixXf& draws) {
  if (pendulum.rows() > 0)
    return decoder.Evaluate(sampler.Evaluate(condition, pendulum, draws), condition);
  const Eigen::Index people = condition.cols();
  Eigen::MatrixXf sum = decoder.Evaluate(draws.leftCols(people), condition);
  for (int k = 1; k < kCvaeDraws; ++k) {
    sum += decoder.Evaluate(draws.middleCols(k * people, people), condition);
  }
  return sum / static_cast<float>(kCvaeDraws);
}

void ListSampler(const std::string& name, int condition, CvaeSampler* sampler,
                 TensorFields* fields) {
  fields->Layer(name + ".first", condition + kPendulumFrame, kCvaeHidden, &sampler->first);
  fields->Layer(name + ".second", kCvaeHidden + kPendulumFrame, kCvaeHidden, &sampler->second);
  const int last = kCvaeHidden + kPendulumFrame;
  fields->Layer(name + ".mean", last, kLatent, &sampler->mean);
  fields->Layer(name + ".log_variance", last, kLatent, &sampler->log_variance);
}

void ListDecoder(const std::string& name, int condition, int frame, CvaeDecoder* decoder,
                 TensorFields* fields) {
  fields->Network(name + ".gate", 3, kLatent + condition, kExperts, &decoder->gate);
  fields->Layer(name + ".first", kLatent + condition, kExperts * kCvaeHidden, &decoder->first);
  fields->Layer(name + ".second", kLatent + kCvaeHidden, kExperts * kCvaeHidden, &decoder->second);
  fields->Layer(name + ".last", kLatent + kCvaeHidden, kExperts * frame, &decoder->last);
}

void ListTensors(CvaeWeights* weights, TensorFields* fields) {
  const CvaeLayout& layout = weights->layout;
  const int lower = layout.LowerFrame(), upper = layout.UpperFrame();
  const int condition = layout.UpperCondition();
  fields->Scales("lower", lower, &weights->lower);
  if (layout.halves) fields->Scales("upper", upper, &weights->upper);
  if (layout.pendulum) {
    fields->Scales("pendulum", kPendulumFrame, &weights->pendulum);
    ListSampler("lower_sampler", lower, &weights->lower_sampler, fields);
    if (layout.halves) ListSampler("upper_sampler", condition, &weights->upper_sampler, fields);
  }
  ListDecoder("lower_decoder", lower, lower, &weights->lower_decoder, fields);
  if (!layout.halves) return;
  ListDecoder("upper_decoder", condition, upper, &weights->upper_decoder, fields);
}

}  // namespace

const std::vector<int>& CvaeLayout::LowerJoints() const {
  static const std::vector<int> lower(std::begin(kLowerJoints), std::end(kLowerJoints));
  static const std::vector<int> all = [] {
    std::vector<int> joints(kBodyJoints);
    std::iota(joints.begin(), joints.end(), 0);
    return joints;
  }();
  return halves ? lower : all;
}

const std::vector<int>& CvaeLayout::UpperJoints() const {
  static const std::vector<int> upper(std::begin(kUpperJoints), std::end(kUpperJoints));
  static const std::vector<int> none;
  return halves ? upper : none;
}

int CvaeLayout::PendulumFrame() const { return pendulum ? kPendulumFrame : 0; }

Eigen::MatrixXf PendulumFrames(const RestorationInput& person, const CvaeLayout& layout) {
  const double heading = Heading(person.first_pose);
  const Eigen::Matrix3d turn = TurnAboutZ(-heading);
  const int frames = static_cast<int>(person.q.size());
  Eigen::MatrixXf out = Eigen::MatrixXf::Zero(layout.PendulumFrame(), frames);
  if (!layout.pendulum) return out;
  const Vector4<double> first = TurnedPendulum(person.q[0], -heading);
  const int from[7] = {0, 1, 2, 3, 4, 5, 6};  // what the changes are of
  for (int t = 0; t < frames; ++t) {
    Vector4<double> q = TurnedPendulum(person.q[t], -heading);
    q.head<2>() -= first.head<2>();
    const Eigen::Vector3d end = turn * (TipAt(person, t) - person.first_pose.col(0));
    auto column = out.col(t);
    column.head<4>() = q.cast<float>();
    column.segment<3>(4) = end.cast<float>();
    column[7] = static_cast<float>(person.BodyAt(t).rod_length);
    if (t == 0) continue;
    for (int i = 0; i < 7; ++i) column[8 + i] = column[from[i]] - out(from[i], t - 1);
  }
  return out;
}

BodyFrames FramesOf(const RestorationInput& person, const BodyMotion& motion,
                    const CvaeLayout& layout) {
  const Eigen::Matrix3d turn = TurnAboutZ(-Heading(person.first_pose));
  const int frames = static_cast<int>(motion.size());
  BodyFrames out{Eigen::MatrixXf(layout.LowerFrame(), frames),
                 Eigen::MatrixXf(layout.UpperFrame(), frames)};
  FrameParts parts;
  Pose before = Pose::Zero();
  for (int t = 0; t < frames; ++t) {
    const Pose& pose = motion[t];
    const Pose& last = motion[std::max(0, t - 1)];
    parts.way = (turn * (pose.col(0) - last.col(0))).head<2>();
    parts.facing_change = Wrapped(Heading(pose) - Heading(last));
    parts.positions = turn * (pose.colwise() - OriginOf(person, pose, layout.Origin()));
    parts.changes = Pose::Zero();
    if (t > 0) parts.changes = (parts.positions - before) * kCvaeRate;
    before = parts.positions;
    const PosedSkeleton posed = FitSkeleton(person.first_pose, pose);
    for (int j = 0; j < kBodyJoints; ++j) {
      parts.rotations[j] = ToRotation6d(turn * posed.rotations[j] * turn.transpose());
    }
    Fill(parts, layout.LowerJoints(), t, &out.lower);
    Fill(parts, layout.UpperJoints(), t, &out.upper);
  }
  return out;
}

BodyMotion MotionFromFrames(const RestorationInput& person, const BodyFrames& frames,
                            const CvaeLayout& layout) {
  const Eigen::Matrix3d turn = TurnAboutZ(Heading(person.first_pose));
  BodyMotion motion(frames.lower.cols());
  for (int t = 0; t < static_cast<int>(motion.size()); ++t) {
    Pose pose;
    TakePositions(frames.upper, layout.UpperJoints(), t, &pose);
    TakePositions(frames.lower, layout.LowerJoints(), t, &pose);  // the hip is the lower body's
    pose = turn * pose;
    if (layout.Origin() == CvaeCoordinates::kLdp) {
      motion[t] = pose.colwise() + person.first_pose.col(0);
    } else {
      const Eigen::Vector3d move = TipAt(person, t) - pose.col(0);
      motion[t] = pose.colwise() + move;
    }
  }
  return motion;
}

RestorationInput Resampled(const RestorationInput& person, double dt) {
  if (SameRate(person.dt, dt)) return person;
  RestorationInput other = person;
  other.dt = dt;
  const double end = static_cast<double>(person.q.size() - 1) * person.dt;
  int frames = 0;
  while (frames * dt < end + dt) ++frames;
  other.q = ResampledPath(person.q, person.dt, dt, frames);
  if (!person.lengths.empty()) {
    other.lengths = ResampledPath(person.lengths, person.dt, dt, frames);
  }
  return other;
}

BodyMotion Resampled(const BodyMotion& motion, double motion_dt, double dt, int frames) {
  if (SameRate(motion_dt, dt) && static_cast<int>(motion.size()) == frames) return motion;
  return ResampledPath(motion, motion_dt, dt, frames);
}

int CvaeRestoration::NumDraws() const {
  if (!weights_.layout.pendulum) return kCvaeDraws;
  return latent_ == CvaeLatent::kDraw ? 1 : 0;
}

std::vector<BodyMotion> CvaeRestoration::Restore(
    const std::vector<RestorationInput>& people) const {
  const int n = static_cast<int>(people.size());
  std::vector<RestorationInput> at_rate;
  std::vector<Eigen::MatrixXf> pendulums;
  std::vector<BodyFrames> frames;
  const CvaeLayout& layout = weights_.layout;
  Eigen::MatrixXf lower(layout.LowerFrame(), n), upper(layout.UpperFrame(), n);
  Eigen::MatrixXf pendulum(layout.PendulumFrame(), n), draws(kLatent, NumDraws() * n);
  int longest = 0;
  for (int i = 0; i < n; ++i) {
    at_rate.push_back(Resampled(people[i], 1.0 / kCvaeRate));
    pendulums.push_back(ScaledPendulum(weights_, at_rate[i]));
    const int count = static_cast<int>(pendulums[i].cols());
    const BodyFrames first = FramesOf(at_rate[i], {people[i].first_pose}, layout);
    lower.col(i) = weights_.lower.Scaled(first.lower);
    if (layout.halves) upper.col(i) = weights_.upper.Scaled(first.upper);
    frames.push_back(
        {Eigen::MatrixXf(layout.LowerFrame(), count), Eigen::MatrixXf(layout.UpperFrame(), count)});
    longest = std::max(longest, count);
  }
  const NormalSource normal = draws.size() > 0 ? draws_() : nullptr;
  const auto draw = [&] {
    for (float& z : draws.reshaped()) z = static_cast<float>(normal());
  };
  for (int t = 0; t < longest; ++t) {
    if (t > 0) {
      for (int i = 0; i < n; ++i) {
        pendulum.col(i) = pendulums[i].col(std::min<Eigen::Index>(t, pendulums[i].cols() - 1));
      }
      draw();
      StepLower(weights_, pendulum, draws, &lower);
      if (layout.halves) draw();
      StepUpper(weights_, pendulum, draws, lower, &upper);
    }
    for (int i = 0; i < n; ++i) {
      if (t >= frames[i].lower.cols()) continue;
      frames[i].lower.col(t) = weights_.lower.Unscaled(lower.col(i));
      if (layout.halves) frames[i].upper.col(t) = weights_.upper.Unscaled(upper.col(i));
    }
  }
  std::vector<BodyMotion> motions;
  for (int i = 0; i < n; ++i) {
    const BodyMotion motion = MotionFromFrames(at_rate[i], frames[i], layout);
    motions.push_back(
        Resampled(motion, 1.0 / kCvaeRate, people[i].dt, static_cast<int>(people[i].q.size())));
  }
  return motions;
}

Eigen::MatrixXf CvaeSampler::Evaluate(const Eigen::MatrixXf& condition,
                                      const Eigen::MatrixXf& pendulum,
                                      const Eigen::MatrixXf& eps) const {
  Eigen::MatrixXf hidden = Apply(first, Stacked(condition, pendulum));
  ApplyElu(&hidden);
  hidden = Apply(second, Stacked(hidden, pendulum));
  ApplyElu(&hidden);
  hidden = Stacked(hidden, pendulum);
  const Eigen::MatrixXf mu = Apply(mean, hidden);
  if (eps.size() == 0) return mu;
  return mu + (0.5f * Apply(log_variance, hidden).array()).exp().matrix().cwiseProduct(eps);
}

Eigen::MatrixXf CvaeDecoder::Evaluate(const Eigen::MatrixXf& z,
                                      const Eigen::MatrixXf& condition) const {
  const Eigen::MatrixXf inputs = Stacked(z, condition);
  const Eigen::MatrixXf shares = Softmax(gate.Evaluate(inputs));
  Eigen::MatrixXf hidden = Blend(first, inputs, shares);
  ApplyElu(&hidden);
  hidden = Blend(second, Stacked(z, hidden), shares);
  ApplyElu(&hidden);
  return Blend(last, Stacked(z, hidden), shares);
}

void StepLower(const CvaeWeights& weights, const Eigen::MatrixXf& pendulum,
               const Eigen::MatrixXf& draws, Eigen::MatrixXf* lower) {
  *lower = NextFrame(weights.lower_sampler, weights.lower_decoder, *lower, pendulum, draws);
}

void StepUpper(const CvaeWeights& weights, const Eigen::MatrixXf& pendulum,
               const Eigen::MatrixXf& draws, const Eigen::MatrixXf& lower, Eigen::MatrixXf* upper) {
  if (!weights.layout.halves) return;
  const Eigen::MatrixXf condition =
      Stacked(*upper, lower.middleRows(3, weights.layout.LowerPositions()));
  *upper = NextFrame(weights.upper_sampler, weights.upper_decoder, condition, pendulum, draws);
}

TensorList ToTensors(const CvaeWeights& weights) {
  CvaeWeights written = weights;
  TensorList tensors;
  TensorFields fields(&tensors);
  ListTensors(&written, &fields);
  return tensors;
}

CvaeWeights TakeCvae(const CvaeLayout& layout, TensorReader* reader) {
  CvaeWeights weights;
  weights.layout = layout;
  TensorFields fields(reader);
  ListTensors(&weights, &fields);
  return weights;
}

}  // namespace pushid
