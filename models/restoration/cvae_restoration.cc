// models: frames of LDP's chain and back, and the chain, forward.
#include "models/restoration/cvae_restoration.h"

#include <cmath>
#include <string>

#include "models/restoration/body.h"

namespace pushid {
namespace {

// The point that positions are measured from.
Eigen::Vector3d OriginOf(const RestorationInput& person, const Pose& pose,
                         CvaeCoordinates coordinates) {
  return coordinates == CvaeCoordinates::kTip ? pose.col(0) : person.first_pose.col(0);
}

double Wrapped(double angle) { return std::remainder(angle, 2.0 * M_PI); }

// `frames` values at dt, by linear interpolation of values at from_dt.
template <typename Value>
std::vector<Value> ResampledPath(const std::vector<Value>& values, double from_dt, double dt,
                                 int frames) {
  std::vector<Value> other;
  for (int t = 0; t < frames; ++t) other.push_back(ReadAt(values, t * dt / from_dt));
  return other;
}

bool SameRate(double a, double b) { return std::abs(a / b - 1.0) < 1e-3; }

// Sum over the experts of share x output.
Eigen::MatrixXf Blend(const DenseLayer& experts, const Eigen::MatrixXf& inputs,
                      const Eigen::MatrixXf& shares) {
  const Eigen::MatrixXf all = AppliedByEigen(experts, inputs);
  const Eigen::Index rows = all.rows() / kExperts;
  Eigen::MatrixXf mixed = Eigen::MatrixXf::Zero(rows, inputs.cols());
  for (int e = 0; e < kExperts; ++e) {
    mixed.array() += all.middleRows(e * rows, rows).array().rowwise() * shares.row(e).array();
  }
  return mixed;
}

Eigen::MatrixXf Softmax(const Eigen::MatrixXf& values) {
  Eigen::MatrixXf shares = values.rowwise() - values.colwise().maxCoeff();
  shares = shares.array().exp();
  const Eigen::RowVectorXf sums = shares.colwise().sum();
  shares.array().rowwise() /= sums.array();
  return shares;
}

}  // namespace

const std::vector<int>& CvaeLayout::Joints(int half) const {
  static const std::vector<int> joints[2] = {{0, 14, 15, 16, 17, 18, 19, 20, 21},
                                             {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13}};
  static const std::vector<int> all = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10,
                                       11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21};
  return halves ? joints[half] : all;
}

int CvaeLayout::PendulumFrame() const { return pendulum ? kPendulumFrame : 0; }

Eigen::MatrixXf PendulumFrames(const RestorationInput& person, const CvaeLayout& layout) {
  const double heading = Heading(person.first_pose);
  const Eigen::Matrix3d turn = TurnAboutZ(-heading);
  const int frames = static_cast<int>(person.q.size());
  Eigen::MatrixXf out = Eigen::MatrixXf::Zero(layout.PendulumFrame(), frames);
  if (!layout.pendulum) return out;
  const Vector4<double> first = TurnedPendulum(person.q[0], -heading);
  for (int t = 0; t < frames; ++t) {
    Vector4<double> q = TurnedPendulum(person.q[t], -heading);
    q.head<2>() -= first.head<2>();
    const Eigen::Vector3d end = turn * (TipAt(person, t) - person.first_pose.col(0));
    auto column = out.col(t);
    column.head<4>() = q.cast<float>();
    column.segment<3>(4) = end.cast<float>();
    column[7] = static_cast<float>(person.BodyAt(t).rod_length);
    if (t == 0) continue;
    column.tail<7>() = column.head<7>() - out.col(t - 1).head<7>();
  }
  return out;
}

BodyFrames FramesOf(const RestorationInput& person, const BodyMotion& motion,
                    const CvaeLayout& layout) {
  const Eigen::Matrix3d turn = TurnAboutZ(-Heading(person.first_pose));
  const int frames = static_cast<int>(motion.size());
  BodyFrames out;
  for (int half = 0; half < layout.num_halves(); ++half) {
    out.emplace_back(layout.Frame(half), frames);
  }
  Pose positions = Pose::Zero();
  for (int t = 0; t < frames; ++t) {
    const Pose &pose = motion[t], &last = motion[std::max(0, t - 1)], before = positions;
    positions = turn * (pose.colwise() - OriginOf(person, pose, layout.Origin()));
    Pose changes = Pose::Zero();
    if (t > 0) changes = (positions - before) * kCvaeRate;
    const FittedTree posed = FitSkeleton(person.first_pose, pose);
    for (int half = 0; half < layout.num_halves(); ++half) {
      const std::vector<int>& joints = layout.Joints(half);
      const int n = static_cast<int>(joints.size());
      Eigen::VectorXd frame(layout.Frame(half));
      frame.head<3>() << (turn * (pose.col(0) - last.col(0))).head<2>(),
          Wrapped(Heading(pose) - Heading(last));
      for (int i = 0; i < n; ++i) {
        const int j = joints[i];
        frame.segment<3>(3 + 3 * i) = positions.col(j);
        frame.segment<3>(3 + 3 * (n + i)) = changes.col(j);
        frame.segment<6>(3 + 6 * (n + i)) =
            ToRotation6d(turn * posed.rotations[j] * turn.transpose());
      }
      out[half].col(t) = frame.cast<float>();
    }
  }
  return out;
}

BodyMotion MotionFromFrames(const RestorationInput& person, const BodyFrames& frames,
                            const CvaeLayout& layout) {
  const Eigen::Matrix3d turn = TurnAboutZ(Heading(person.first_pose));
  BodyMotion motion(frames.front().cols());
  for (int t = 0; t < static_cast<int>(motion.size()); ++t) {
    Pose pose;
    for (int half = layout.num_halves() - 1; half >= 0; --half) {  // the hip is the lower body's
      const std::vector<int>& joints = layout.Joints(half);
      for (size_t i = 0; i < joints.size(); ++i) {
        pose.col(joints[i]) =
            frames[half].block<3, 1>(3 + 3 * static_cast<int>(i), t).cast<double>();
      }
    }
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

std::vector<BodyMotion> CvaeRestoration::Restore(
    const std::vector<RestorationInput>& people) const {
  const int n = static_cast<int>(people.size());
  const CvaeLayout& layout = weights_.layout;
  const int num_draws = !layout.pendulum ? kCvaeDraws : latent_ == CvaeLatent::kDraw ? 1 : 0;
  std::vector<RestorationInput> at_rate;
  std::vector<Eigen::MatrixXf> pendulums;
  std::vector<BodyFrames> frames;
  BodyFrames now;
  for (int half = 0; half < layout.num_halves(); ++half) now.emplace_back(layout.Frame(half), n);
  Eigen::MatrixXf pendulum(layout.PendulumFrame(), n), draws(kLatent, num_draws * n);
  Eigen::Index longest = 0;
  for (int i = 0; i < n; ++i) {
    at_rate.push_back(Resampled(people[i], 1.0 / kCvaeRate));
    pendulums.push_back(PendulumFrames(at_rate[i], layout));
    if (layout.pendulum) pendulums[i] = weights_.pendulum.Scaled(pendulums[i]);
    frames.push_back(FramesOf(at_rate[i], {people[i].first_pose}, layout));
    const Eigen::Index count = pendulums[i].cols();
    for (int half = 0; half < layout.num_halves(); ++half) {
      now[half].col(i) = weights_.halves[half].scaling.Scaled(frames[i][half]);
      frames[i][half].resize(Eigen::NoChange, count);
    }
    longest = std::max(longest, count);
  }
  const NormalSource normal = draws.size() > 0 ? draws_() : nullptr;
  for (Eigen::Index t = 0; t < longest; ++t) {
    for (int i = 0; t > 0 && i < n; ++i) {
      pendulum.col(i) = pendulums[i].col(std::min(t, pendulums[i].cols() - 1));
    }
    for (int half = 0; half < layout.num_halves(); ++half) {
      if (t > 0) {
        for (float& z : draws.reshaped()) z = static_cast<float>(normal());
        Step(weights_, static_cast<CvaeHalf>(half), pendulum, draws, now[kLowerHalf], &now[half]);
      }
      for (int i = 0; i < n; ++i) {
        if (t >= frames[i][half].cols()) continue;
        frames[i][half].col(t) = weights_.halves[half].scaling.Unscaled(now[half].col(i));
      }
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
  Eigen::MatrixXf hidden = AppliedByEigen(first, Stacked(condition, pendulum));
  ApplyElu(&hidden);
  hidden = AppliedByEigen(second, Stacked(hidden, pendulum));
  ApplyElu(&hidden);
  hidden = Stacked(hidden, pendulum);
  const Eigen::MatrixXf mu = AppliedByEigen(mean, hidden);
  if (eps.size() == 0) return mu;
  return mu +
         (0.5f * AppliedByEigen(log_variance, hidden).array()).exp().matrix().cwiseProduct(eps);
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

void Step(const CvaeWeights& weights, CvaeHalf half, const Eigen::MatrixXf& pendulum,
          const Eigen::MatrixXf& draws, const Eigen::MatrixXf& lower, Eigen::MatrixXf* frames) {
  const CvaeNetworks& networks = weights.halves[half];
  Eigen::MatrixXf condition = *frames;
  if (half == kUpperHalf) {
    condition = Stacked(condition, lower.middleRows(3, weights.layout.Positions(kLowerHalf)));
  }
  if (weights.layout.pendulum) {
    const Eigen::MatrixXf z = networks.sampler.Evaluate(condition, pendulum, draws);
    *frames = networks.decoder.Evaluate(z, condition);
    return;
  }
  const Eigen::Index people = condition.cols();
  *frames = networks.decoder.Evaluate(draws.leftCols(people), condition);
  for (int k = 1; k < kCvaeDraws; ++k) {
    *frames += networks.decoder.Evaluate(draws.middleCols(k * people, people), condition);
  }
  *frames /= static_cast<float>(kCvaeDraws);
}

void ListTensors(const std::string& prefix, CvaeWeights* weights, TensorFields* fields) {
  const CvaeLayout& layout = weights->layout;
  constexpr const char* kNames[2] = {"lower", "upper"};
  const auto each_half = [&](const char* part, auto list) {
    for (int half = 0; half < layout.num_halves(); ++half) {
      list(prefix + kNames[half] + part, half, &weights->halves[half]);
    }
  };
  each_half("", [&](const std::string& name, int half, CvaeNetworks* networks) {
    fields->Scales(name, layout.Frame(half), &networks->scaling);
  });
  if (layout.pendulum) {
    fields->Scales(prefix + "pendulum", kPendulumFrame, &weights->pendulum);
    each_half("_sampler.", [&](const std::string& name, int half, CvaeNetworks* networks) {
      CvaeSampler& sampler = networks->sampler;
      const int hidden = kCvaeHidden + kPendulumFrame;
      fields->Layer(name + "first", layout.Condition(half) + kPendulumFrame, kCvaeHidden,
                    &sampler.first);
      fields->Layer(name + "second", hidden, kCvaeHidden, &sampler.second);
      fields->Layer(name + "mean", hidden, kLatent, &sampler.mean);
      fields->Layer(name + "log_variance", hidden, kLatent, &sampler.log_variance);
    });
  }
  each_half("_decoder.", [&](const std::string& name, int half, CvaeNetworks* networks) {
    CvaeDecoder& decoder = networks->decoder;
    const int first = kLatent + layout.Condition(half), later = kLatent + kCvaeHidden;
    fields->Network(name + "gate", 3, first, kExperts, &decoder.gate);
    fields->Layer(name + "first", first, kExperts * kCvaeHidden, &decoder.first);
    fields->Layer(name + "second", later, kExperts * kCvaeHidden, &decoder.second);
    fields->Layer(name + "last", later, kExperts * layout.Frame(half), &decoder.last);
  });
}

}  // namespace pushid
