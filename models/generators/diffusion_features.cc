// models: groups to features and back.
#include "models/generators/diffusion_features.h"

#include <algorithm>
#include <cmath>

namespace pushid {
namespace {

constexpr float kLeastHipScale = 0.05f, kLeastJointScale = 0.02f;  // m
constexpr float kForceUnit = 10.0f;                                // N/kg
constexpr float kUsualMass = 80.0f, kUsualHip = 1.0f;              // kg, m
constexpr float kFirstPoseShare = 0.5f;
constexpr float kFramesUnit = 15.0f;

// Joints seen from the hip; the hip's own rows are its place.
Trajectories FromHip(const Trajectories& frames) {
  Trajectories seen = frames;
  for (int j = 1; j < kBodyJoints; ++j) seen.middleRows(3 * j, 3) -= frames.topRows(3);
  return seen;
}

// Since frame 0; m.
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
    // The two are not exactly of length 1 where a network estimates them.
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

// Where the push comes from: the pushed people's place, or the middle where nobody is pushed.
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

}  // namespace

JointScales JointScalesOf(const std::vector<std::vector<ObservedMotion>>& groups) {
  JointScales squares = JointScales::Zero();
  float frames = 0.0f;
  for (const auto& group : groups) {
    for (const ObservedMotion& person : group) {
      const Trajectories moved = Moved(person);
      for (int j = 0; j < kBodyJoints; ++j) {
        squares[j] += moved.middleRows(3 * j, 3).squaredNorm() / 3.0f;
      }
      frames += static_cast<float>(moved.cols());
    }
  }
  JointScales scales = (squares / std::max(1.0f, frames)).cwiseSqrt().cwiseMax(kLeastJointScale);
  scales[kBodyHip] = std::max(scales[kBodyHip], kLeastHipScale);
  return scales;
}

Scaling FirstPoseScalingOf(const std::vector<std::vector<ObservedMotion>>& groups) {
  Eigen::MatrixXf poses(kFirstPoseRows, 0);
  for (const auto& group : groups) {
    for (const ObservedMotion& person : group) {
      poses.conservativeResize(Eigen::NoChange, poses.cols() + 1);
      poses.rightCols(1) = FromHip(person.frames.leftCols(1)).bottomRows(kFirstPoseRows);
    }
  }
  return ScalingOf(poses, kLeastJointScale);
}

MotionScales OwnFrameScalesOf(const std::vector<std::vector<ObservedMotion>>& groups) {
  constexpr double kLeastSpread = 1e-3;  // m, or of a cosine: rows that hardly move
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(kOwnFrameRows), squares = sum;
  double frames = 0.0;
  for (const auto& group : groups) {
    for (const ObservedMotion& person : group) {
      const Eigen::ArrayXXd rows = OwnRows(person).cast<double>();
      sum += rows.rowwise().sum();
      squares += rows.square().rowwise().sum();
      frames += static_cast<double>(rows.cols());
    }
  }
  const Eigen::ArrayXd mean = sum / std::max(1.0, frames);
  MotionScales scales(JointScalesOf(groups));
  scales.mean = mean.cast<float>();
  scales.spread = (squares / std::max(1.0, frames) - mean.square())
                      .max(kLeastSpread * kLeastSpread)
                      .sqrt()
                      .cast<float>();
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
  // theta leans towards +x, phi towards -y; the push itself is not of another size.
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

std::vector<ObservedMotion> PushedBy(std::vector<ObservedMotion> group, double factor) {
  for (ObservedMotion& person : group) person.controls *= static_cast<float>(factor);
  return group;
}

}  // namespace pushid
