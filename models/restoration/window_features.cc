// models: the window's numbers.
#include "models/restoration/window_features.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "models/restoration/neighbour_features.h"

namespace pushid {
namespace {

constexpr std::array<int, 7> kSeenJoints = {kRightKnee,  kLeftKnee,  kRightAnkle, kLeftAnkle,
                                            kRightWrist, kLeftWrist, kBodyHead};
constexpr double kLongestTime = 2.0;  // s

constexpr int kPersonInputs = 6 + 3 * static_cast<int>(kSeenJoints.size());
constexpr int kPushInputs = 5;
constexpr int kShapeOutputs = 3 * (kBodyJoints - 1);

Eigen::MatrixXf PendulumInputs(const RestorationInput& person) {
  const auto path = TurnedPath(person, Heading(person.first_pose));
  Eigen::MatrixXd inputs(kWindowPendulumInputs, path.num_frames());
  for (int t = 0; t < path.num_frames(); ++t) {
    FillPendulumInputs(path, person.dt, t, inputs.col(t));
  }
  return inputs.cast<float>();
}

Eigen::MatrixXf PushInputs(const RestorationInput& person) {
  const Eigen::Matrix3d turn = TurnAboutZ(-Heading(person.first_pose));
  const Eigen::Vector3d velocity = turn * person.push.velocity;
  const Eigen::Vector3d away = turn * (person.push.place - person.first_pose.col(0));
  Eigen::Matrix<float, kPushInputs, 1> push;
  push << velocity.head<2>().cast<float>(), static_cast<float>(person.push.duration),
      away.head<2>().cast<float>();
  return push.replicate(1, static_cast<int>(person.q.size()));
}

}  // namespace

// Only the time differs from frame to frame.
Eigen::MatrixXf WindowPersonInputs(const RestorationInput& person) {
  const double heading = Heading(person.first_pose);
  const Eigen::Matrix3d turn = TurnAboutZ(-heading);
  const Vector4<double> first = TurnedPendulum(person.q[0], -heading);
  const double leg = LegLength(person.first_pose);
  Eigen::MatrixXf inputs(kPersonInputs, static_cast<int>(person.q.size()));
  for (int t = 0; t < static_cast<int>(inputs.cols()); ++t) {
    int row = 0;
    const auto add = [&](double value) { inputs(row++, t) = static_cast<float>(value); };
    add(std::clamp(t * person.dt - person.push_start, 0.0, kLongestTime));
    add(person.body.mass), add(person.body.rod_length), add(leg);
    add(first[2]), add(first[3]);
    for (const int joint : kSeenJoints) {
      const Eigen::Vector3d place =
          turn * (person.first_pose.col(joint) - person.first_pose.col(0));
      for (int i = 0; i < 3; ++i) add(place[i]);
    }
  }
  return inputs;
}

int WindowInputRows(RestorationView view) {
  if (view == RestorationView::kPose) return kPersonInputs + kPushInputs;
  return kWindowPendulumInputs + kPersonInputs +
         (view == RestorationView::kNeighbours ? kNeighbourInputs : 0);
}

int WindowOutputRows(RestorationView view) {
  return kShapeOutputs + (view == RestorationView::kPose ? 3 : 0);
}

Eigen::MatrixXf WindowInputs(const std::vector<RestorationInput>& people, int n,
                             RestorationView view) {
  const RestorationInput& person = people[n];
  Eigen::MatrixXf inputs(WindowInputRows(view), static_cast<int>(person.q.size()));
  switch (view) {
    case RestorationView::kPendulum:
      inputs << PendulumInputs(person), WindowPersonInputs(person);
      break;
    case RestorationView::kNeighbours:
      inputs << PendulumInputs(person), WindowPersonInputs(person), NeighbourInputs(people, n);
      break;
    case RestorationView::kPose:
      inputs << WindowPersonInputs(person), PushInputs(person);
      break;
  }
  return inputs;
}

Eigen::MatrixXf WindowTargets(const RestorationInput& person, const BodyMotion& motion,
                              RestorationView view) {
  const Eigen::Matrix3d turn = TurnAboutZ(-Heading(person.first_pose));
  Eigen::MatrixXf targets(WindowOutputRows(view), static_cast<int>(motion.size()));
  for (int t = 0; t < static_cast<int>(motion.size()); ++t) {
    for (int j = 1; j < kBodyJoints; ++j) {
      const Eigen::Vector3d shape = motion[t].col(j) - motion[t].col(0) -
                                    (person.first_pose.col(j) - person.first_pose.col(0));
      targets.block<3, 1>(3 * (j - 1), t) = (turn * shape).cast<float>();
    }
    if (view != RestorationView::kPose) continue;
    const Eigen::Vector3d way = motion[t].col(0) - person.first_pose.col(0);
    targets.block<3, 1>(kShapeOutputs, t) = (turn * way).cast<float>();
  }
  return targets;
}

BodyMotion MotionFromOutputs(const RestorationInput& person, const Eigen::MatrixXf& outputs,
                             RestorationView view) {
  const Eigen::Matrix3d turn = TurnAboutZ(Heading(person.first_pose));
  BodyMotion motion(outputs.cols());
  for (int t = 0; t < static_cast<int>(motion.size()); ++t) {
    Eigen::Vector3d hip = TipAt(person, t);
    if (view == RestorationView::kPose) {
      hip = person.first_pose.col(0) + turn * outputs.block<3, 1>(kShapeOutputs, t).cast<double>();
    }
    motion[t].col(0) = hip;
    for (int j = 1; j < kBodyJoints; ++j) {
      motion[t].col(j) = hip + (person.first_pose.col(j) - person.first_pose.col(0)) +
                         turn * outputs.block<3, 1>(3 * (j - 1), t).cast<double>();
    }
  }
  return motion;
}

}  // namespace pushid
