// models: frames of the chain and back.
#include "models/restoration/cvae_features.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "models/restoration/body.h"

namespace pushid {

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

}  // namespace

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

}  // namespace pushid
