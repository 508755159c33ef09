// models: the window network: its inputs and outputs, and the restored motion.
#include "models/restoration/window_restoration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace pushid {
namespace {

constexpr std::array<int, 7> kSeenJoints = {kRightKnee,  kLeftKnee,  kRightAnkle, kLeftAnkle,
                                            kRightWrist, kLeftWrist, kBodyHead};
constexpr double kLongestTime = 2.0;  // s

constexpr int kPersonInputs = 6 + 3 * static_cast<int>(kSeenJoints.size());
constexpr int kPushInputs = 5;
constexpr int kShapeOutputs = 3 * (kBodyJoints - 1);

constexpr std::array<int, 15> kWindowLags = {0, -2, -4, -6, -8, -12, -16, -24,
                                             2, 4,  6,  8,  12, 16,  24};
constexpr std::array<int, 5> kWindowRateLags = {0, -12, -6, 6, 12};
constexpr double kWindowLagRate = 60.0;  // Hz
static_assert(kWindowPendulumInputs == 4 * (kWindowLags.size() + kWindowRateLags.size()));

Eigen::MatrixXf PendulumInputs(const RestorationInput& person) {
  const auto path = TurnedPath(person, Heading(person.first_pose));
  const double frames_per_lag = 1.0 / (kWindowLagRate * person.dt);
  Eigen::MatrixXd inputs(kWindowPendulumInputs, path.num_frames());
  for (int t = 0; t < path.num_frames(); ++t) {
    const Vector4<double> now = path.At(t);
    int row = 0;
    for (const int lag : kWindowLags) {
      const Vector4<double> q = path.At(t + lag * frames_per_lag);
      const Vector4<double>& base = lag == 0 ? path.First() : now;
      inputs.col(t).segment<2>(row) = q.head<2>() - base.head<2>();
      inputs.col(t).segment<2>(row + 2) = q.tail<2>() - path.First().tail<2>();
      row += 4;
    }
    for (const int lag : kWindowRateLags) {
      inputs.col(t).segment<4>(row) = path.RateAt(t + lag * frames_per_lag);
      row += 4;
    }
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

// Inputs about the person; only the time and the length of a moving rod vary between frames.
Eigen::MatrixXf PersonInputs(const RestorationInput& person) {
  const double heading = Heading(person.first_pose);
  const Eigen::Matrix3d turn = TurnAboutZ(-heading);
  const Vector4<double> first = TurnedPendulum(person.q[0], -heading);
  const double leg = LegLength(person.first_pose);
  Eigen::MatrixXf inputs(kPersonInputs, static_cast<int>(person.q.size()));
  for (int t = 0; t < static_cast<int>(inputs.cols()); ++t) {
    int row = 0;
    const auto add = [&](double value) { inputs(row++, t) = static_cast<float>(value); };
    add(std::clamp(t * person.dt - person.push_start, 0.0, kLongestTime));
    add(person.body.mass), add(person.BodyAt(t).rod_length), add(leg);
    add(first[2]), add(first[3]);
    for (const int joint : kSeenJoints) {
      const Eigen::Vector3d place =
          turn * (person.first_pose.col(joint) - person.first_pose.col(0));
      for (int i = 0; i < 3; ++i) add(place[i]);
    }
  }
  return inputs;
}

constexpr std::array<int, 6> kLags = {0, -12, -6, 6, 12, 24};
constexpr double kFurthest = 2.0;    // m
constexpr double kNearLength = 1.0;  // m

double Nearness(const Eigen::Vector2d& away) {
  return std::exp(-away.squaredNorm() / (kNearLength * kNearLength));
}

// 0 ahead, 1 behind, 2 to the left, 3 to the right.
int QuarterOf(const Eigen::Vector2d& away) {
  if (std::abs(away.x()) >= std::abs(away.y())) return away.x() >= 0.0 ? 0 : 1;
  return away.y() > 0.0 ? 2 : 3;
}

// The path of the rod's tip (x, y); turned: the person's pendulum in the frame of a heading.
FramePath<Eigen::Vector2d> TipPath(const RestorationInput& person,
                                   const FramePath<Vector4<double>>& turned) {
  std::vector<Eigen::Vector2d> tips;
  for (int t = 0; t < turned.num_frames(); ++t) {
    tips.emplace_back(HipPosition(person.BodyAt(t), turned.At(t)).head<2>());
  }
  return {std::move(tips), person.dt};
}

// Indices of the nearest people in each quarter; -1: nobody.
std::array<int, kNeighbourQuarters> Nearest(const std::vector<RestorationInput>& people, int n,
                                            const Eigen::Matrix3d& turn) {
  std::array<int, kNeighbourQuarters> nearest;
  std::array<Eigen::Vector2d, kNeighbourQuarters> places;
  nearest.fill(-1);
  for (int k = 0; k < static_cast<int>(people.size()); ++k) {
    if (k == n) continue;
    const Eigen::Vector2d away = (turn * (TipAt(people[k], 0) - TipAt(people[n], 0))).head<2>();
    if (away.norm() > kFurthest) continue;
    const int quarter = QuarterOf(away);
    const auto rank = [](const Eigen::Vector2d& p) {
      return std::make_tuple(p.squaredNorm(), -p.y(), -p.x());
    };
    if (nearest[quarter] >= 0 && rank(away) >= rank(places[quarter])) continue;
    nearest[quarter] = k;
    places[quarter] = away;
  }
  return nearest;
}

}  // namespace

std::vector<BodyMotion> WindowRestoration::Restore(
    const std::vector<RestorationInput>& people) const {
  std::vector<BodyMotion> motions;
  for (int n = 0; n < static_cast<int>(people.size()); ++n) {
    const Eigen::MatrixXf inputs = weights_.inputs.Scaled(WindowInputs(people, n, weights_.view));
    motions.push_back(
        MotionFromOutputs(people[n], weights_.network.Evaluate(inputs), weights_.view));
  }
  return motions;
}

void ListTensors(const std::string& prefix, WindowWeights* weights, TensorFields* fields) {
  const int inputs = WindowInputRows(weights->view);
  fields->Scales(prefix + "inputs", inputs, &weights->inputs);
  fields->Network(prefix + "network", 3, inputs, WindowOutputRows(weights->view),
                  &weights->network);
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
      inputs << PendulumInputs(person), PersonInputs(person);
      break;
    case RestorationView::kNeighbours:
      inputs << PendulumInputs(person), PersonInputs(person), NeighbourInputs(people, n);
      break;
    case RestorationView::kPose:
      inputs << PersonInputs(person), PushInputs(person);
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

Eigen::MatrixXf NeighbourInputs(const std::vector<RestorationInput>& people, int n) {
  const RestorationInput& person = people[n];
  const double heading = Heading(person.first_pose);
  const auto nearest = Nearest(people, n, TurnAboutZ(-heading));
  const auto own = TipPath(person, TurnedPath(person, heading));
  const double frames_per_lag = 1.0 / (kWindowLagRate * person.dt);
  const int frames = static_cast<int>(person.q.size());
  Eigen::MatrixXf inputs = Eigen::MatrixXf::Zero(kNeighbourInputs, frames);
  for (int quarter = 0; quarter < kNeighbourQuarters; ++quarter) {
    if (nearest[quarter] < 0) continue;
    const RestorationInput& other = people[nearest[quarter]];
    const FramePath<Vector4<double>> path = TurnedPath(other, heading);
    const auto tip = TipPath(other, path);
    const auto away_at = [&](double frame) -> Eigen::Vector2d {
      return tip.At(frame) - own.At(frame);
    };
    const Eigen::Vector2d first = away_at(0.0);
    for (int t = 0; t < frames; ++t) {
      auto column = inputs.col(t).segment(quarter * kNumbersPerNeighbour, kNumbersPerNeighbour);
      int row = 0;
      const auto add = [&column, &row](double value) { column[row++] = static_cast<float>(value); };
      add(first.x()), add(first.y()), add(other.BodyAt(t).rod_length), add(Nearness(first));
      for (const int lag : kLags) {
        const Eigen::Vector2d away = away_at(t + lag * frames_per_lag);
        add(away.x() - first.x()), add(away.y() - first.y()), add(Nearness(away));
      }
      const Eigen::Vector2d velocity = tip.RateAt(t) - own.RateAt(t);
      add(velocity.x()), add(velocity.y());
      add(path.At(t)[2]), add(path.At(t)[3]);
    }
  }
  return inputs;
}

}  // namespace pushid
