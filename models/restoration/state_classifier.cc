// models: annotated states found in motion.
#include "models/restoration/state_classifier.h"

#include <algorithm>
#include <cmath>

#include "models/decompositions.h"

namespace pushid {
namespace {

constexpr double kHalfWindow = 0.25;    // s
constexpr double kPenalty = 1e-3;       // a sample
constexpr double kLeastSpread = 1e-6;   // of a feature
constexpr double kLeastGesture = 1e-3;  // m/s; where nobody moves, all others count alike
constexpr int kEvery = 3;               // frames; neighbours say the same
constexpr int kMostSteps = 30;

using Features = Eigen::Matrix<double, kStateFeatures, 1>;

// Of one person at one frame, of what others see.
struct Look {
  Eigen::Vector2d place = Eigen::Vector2d::Zero(), faces = Eigen::Vector2d::Zero();
  double gesture = 0.0;  // m/s
};

Eigen::Vector2d SquareTo(const Eigen::Vector3d& right, const Eigen::Vector3d& left) {
  const Eigen::Vector2d across = (left - right).head<2>();
  return Eigen::Vector2d(across.y(), -across.x()).stableNormalized();
}

double AngleBetween(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0));
}

double WristSpeed(const Pose& now, const Pose& before, int wrist, double dt) {
  const Eigen::Vector3d way =
      (now.col(wrist) - now.col(kBodyHip)) - (before.col(wrist) - before.col(kBodyHip));
  return way.norm() / dt;
}

double GroundSpeed(const Pose& now, const Pose& before, int joint, double dt) {
  return (now - before).col(joint).head<2>().norm() / dt;
}

Look LookOf(const Pose& now, const Pose& before, double dt) {
  return {
      now.col(kBodyHip).head<2>(), SquareTo(now.col(kRightShoulder), now.col(kLeftShoulder)),
      std::max(WristSpeed(now, before, kRightWrist, dt), WristSpeed(now, before, kLeftWrist, dt))};
}

// The person's own part.
Features Own(const Pose& now, const Pose& before, double dt) {
  const double right = WristSpeed(now, before, kRightWrist, dt);
  const double left = WristSpeed(now, before, kLeftWrist, dt);
  const Eigen::Vector2d faces = SquareTo(now.col(kRightShoulder), now.col(kLeftShoulder));
  const Eigen::Vector3d upright =
      now.col(kBodyHip) - 0.5 * (now.col(kRightAnkle) + now.col(kLeftAnkle));
  Features x = Features::Zero();
  x.head<9>() << right + left, std::max(right, left),
      std::max(now(2, kRightWrist), now(2, kLeftWrist)) - now(2, kBodyHip), 0.0,
      std::max(GroundSpeed(now, before, kRightAnkle, dt), GroundSpeed(now, before, kLeftAnkle, dt)),
      GroundSpeed(now, before, kBodyHip, dt), std::atan2(upright.head<2>().norm(), upright.z()),
      AngleBetween(faces, SquareTo(before.col(kRightShoulder), before.col(kLeftShoulder))) / dt,
      AngleBetween(faces, SquareTo(now.col(kRightHip), now.col(kLeftHip)));
  return x;
}

double Reach(const Pose& of, const Pose& other) {
  const Eigen::Vector3d back = other.col(kUpperSpine);
  return std::min((of.col(kRightWrist) - back).norm(), (of.col(kLeftWrist) - back).norm());
}

// Of the others to a person.
void AddOthers(const std::vector<const Pose*>& poses, const std::vector<Look>& looks, size_t n,
               Features* x) {
  double reach = INFINITY, facing = 0.0, least = INFINITY, gestures = 0.0, most = 0.0, to = 0.0;
  for (size_t m = 0; m < looks.size(); ++m) {
    if (m == n) continue;
    const Eigen::Vector2d way = (looks[m].place - looks[n].place).stableNormalized();
    const double faced = -looks[m].faces.dot(way);
    reach = std::min(reach, Reach(*poses[n], *poses[m]));
    facing += faced;
    least = std::min(least, faced);
    gestures += looks[m].gesture;
    most = std::max(most, looks[m].gesture);
    to += (looks[m].gesture + kLeastGesture) * looks[n].faces.dot(way);
  }
  if (looks.size() < 2) return;
  const double others = static_cast<double>(looks.size()) - 1.0;
  (*x)[3] = reach;
  x->tail<5>() << facing / others, least, gestures / others, most,
      to / (gestures + others * kLeastGesture);
}

// Means over +-half columns, by sums from the beginning.
Eigen::MatrixXd Smoothed(const Eigen::MatrixXd& raw, Eigen::Index half) {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(raw.rows(), raw.cols() + 1);
  for (Eigen::Index t = 0; t < raw.cols(); ++t) sums.col(t + 1) = sums.col(t) + raw.col(t);
  Eigen::MatrixXd smooth(raw.rows(), raw.cols());
  for (Eigen::Index t = 0; t < raw.cols(); ++t) {
    const Eigen::Index from = std::max<Eigen::Index>(0, t - half);
    const Eigen::Index to = std::min(raw.cols(), t + half + 1);
    smooth.col(t) = (sums.col(to) - sums.col(from)) / static_cast<double>(to - from);
  }
  return smooth;
}

// Probabilities of each column's states.
Eigen::MatrixXd StateProbabilities(Eigen::MatrixXd scores) {
  scores.rowwise() -= Eigen::RowVectorXd(scores.colwise().maxCoeff());
  scores = scores.array().exp();
  scores.array().rowwise() /= scores.colwise().sum().eval().array();
  return scores;
}

}  // namespace

StateFeatures StateFeaturesOf(const std::vector<BodyMotion>& people, double dt) {
  const size_t frames = people.front().size();
  StateFeatures features(people.size(), Eigen::MatrixXd(kStateFeatures, frames));
  for (size_t t = 0; t < frames; ++t) {
    const size_t now = std::max<size_t>(t, 1), before = now - 1;  // frame 0 moves as frame 1
    std::vector<const Pose*> poses;
    std::vector<Look> looks;
    for (const BodyMotion& person : people) {
      poses.push_back(&person[std::min(now, frames - 1)]);
      looks.push_back(LookOf(*poses.back(), person[before], dt));
    }
    for (size_t n = 0; n < people.size(); ++n) {
      Features x = Own(*poses[n], people[n][before], dt);
      AddOthers(poses, looks, n, &x);
      features[n].col(static_cast<Eigen::Index>(t)) = x;
    }
  }
  const auto half = static_cast<Eigen::Index>(std::lround(kHalfWindow / dt));
  for (Eigen::MatrixXd& person : features) person = Smoothed(person, half);
  return features;
}

StateClassifier::StateClassifier(const std::vector<const Annotated*>& groups, int num_symbols) {
  std::vector<Eigen::VectorXd> columns;
  Symbols labels;
  for (const Annotated* group : groups) {
    for (size_t n = 0; n < group->features.size(); ++n) {
      for (size_t t = 0; t < group->states[n].size(); t += kEvery) {
        columns.push_back(group->features[n].col(static_cast<Eigen::Index>(t)));
        labels.push_back(group->states[n][t]);
      }
    }
  }
  const auto samples = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd all(kStateFeatures, samples);
  for (Eigen::Index i = 0; i < samples; ++i) all.col(i) = columns[i];
  mean_ = all.rowwise().mean();
  spread_ = (all.colwise() - mean_).array().square().rowwise().mean().sqrt().max(kLeastSpread);
  const Eigen::MatrixXd x = Standardized(all);
  const Eigen::Index d = x.rows();
  weights_ = Eigen::MatrixXd::Zero(num_symbols, d);
  const double penalty = kPenalty * static_cast<double>(samples);
  const auto cost = [&](const Eigen::MatrixXd& weights) {
    const Eigen::MatrixXd p = StateProbabilities(weights * x);
    double sum = 0.5 * penalty * weights.squaredNorm();
    for (Eigen::Index i = 0; i < samples; ++i) sum -= std::log(std::max(p(labels[i], i), 1e-300));
    return sum;
  };
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::MatrixXd p = StateProbabilities(weights_ * x);
    Eigen::MatrixXd error = p;
    for (Eigen::Index i = 0; i < samples; ++i) error(labels[i], i) -= 1.0;
    const Eigen::MatrixXd gradient = error * x.transpose() + penalty * weights_;
    // Of rows of weights one after the other.
    Eigen::MatrixXd hessian = penalty * Eigen::MatrixXd::Identity(num_symbols * d, num_symbols * d);
    for (int a = 0; a < num_symbols; ++a) {
      for (int b = 0; b <= a; ++b) {
        const Eigen::RowVectorXd w = p.row(a).array() * ((a == b ? 1.0 : 0.0) - p.row(b).array());
        hessian.block(a * d, b * d, d, d) += x * w.asDiagonal() * x.transpose();
      }
    }
    const Eigen::VectorXd flat = gradient.transpose().reshaped();
    Eigen::MatrixXd move = SolveSymmetric(hessian, flat).reshaped(d, num_symbols).transpose();
    for (const double now = cost(weights_); cost(weights_ - move) > now;) {
      move *= 0.5;
      if (move.cwiseAbs().maxCoeff() < 1e-9) break;
    }
    weights_ -= move;
    if (move.cwiseAbs().maxCoeff() < 1e-6) break;
  }
}

Eigen::MatrixXd StateClassifier::Standardized(const Eigen::MatrixXd& features) const {
  Eigen::MatrixXd x(features.rows() + 1, features.cols());
  x.topRows(features.rows()) = spread_.cwiseInverse().asDiagonal() * (features.colwise() - mean_);
  x.bottomRows(1).setOnes();
  return x;
}

std::vector<Symbols> StateClassifier::Of(const StateFeatures& features) const {
  std::vector<Symbols> states;
  for (const Eigen::MatrixXd& person : features) {
    const Eigen::MatrixXd scores = weights_ * Standardized(person);
    states.emplace_back(scores.cols());
    for (Eigen::Index t = 0; t < scores.cols(); ++t) {
      Eigen::Index best;
      scores.col(t).maxCoeff(&best);
      states.back()[t] = static_cast<int>(best);
    }
  }
  return states;
}

double ShareFound(const std::vector<Symbols>& found, const std::vector<Symbols>& states) {
  double right = 0.0, all = 0.0;
  for (size_t n = 0; n < states.size(); ++n) {
    for (size_t t = 0; t < states[n].size(); ++t) {
      right += found[n][t] == states[n][t] ? 1.0 : 0.0;
      all += 1.0;
    }
  }
  return right / std::max(1.0, all);
}

}  // namespace pushid
