// models: states of people, motion words, and the classifier of states.
#include "models/restoration/group_motion.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "models/decompositions.h"

namespace pushid {
namespace {

constexpr double kStepSpeed = 0.35, kPushSpeed = 0.08;  // m/s
constexpr double kLeanAngle = 5.0 * M_PI / 180.0;
constexpr double kReach = 0.35;  // m
constexpr int kNobody = -1;

Eigen::Vector3d Upright(const Pose& pose) {
  return (pose.col(kBodyHip) - 0.5 * (pose.col(kRightAnkle) + pose.col(kLeftAnkle))).normalized();
}

int InFront(const std::vector<BodyMotion>& people, size_t of) {
  int front = kNobody;
  double nearest = 0.0;
  for (size_t n = 0; n < people.size(); ++n) {
    const Eigen::Vector2d d = (people[n].front() - people[of].front()).col(kBodyHip).head<2>();
    if (!(d.x() > 0.0 && std::abs(d.y()) < d.x())) continue;
    if (front != kNobody && d.norm() >= nearest) continue;
    front = static_cast<int>(n);
    nearest = d.norm();
  }
  return front;
}

// The symbol of frame t > 0.
int PostureSymbol(const BodyMotion& body, size_t t, double dt) {
  for (const int ankle : {kRightAnkle, kLeftAnkle}) {
    const Eigen::Vector3d way = body[t].col(ankle) - body[t - 1].col(ankle);
    if (way.head<2>().norm() > kStepSpeed * dt) return kStep;
  }
  const double cosine = Upright(body[0]).dot(Upright(body[t]));
  return std::acos(std::clamp(cosine, -1.0, 1.0)) > kLeanAngle ? kLean : kStand;
}

bool Pushes(const BodyMotion& body, const BodyMotion& front, size_t t, double dt) {
  if (!(body[t](0, kBodyHip) - body[t - 1](0, kBodyHip) > kPushSpeed * dt)) return false;
  const Eigen::Vector3d back = front[t].col(kUpperSpine);
  return (body[t].col(kRightWrist) - back).norm() < kReach ||
         (body[t].col(kLeftWrist) - back).norm() < kReach;
}

constexpr double kLeastWay = 1e-7;   // m
constexpr double kRounding = 1e-12;  // m^2, of the bound by means
constexpr int kLast = -1;

double Alike(const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
  const double a = std::max(u.norm(), kLeastWay), b = std::max(v.norm(), kLeastWay);
  return 0.5 * (u.dot(v) / (a * b) + 1.0) * std::min(a, b) / std::max(a, b);
}

template <typename Word>
double Score(const Word& a, const Word& b) {
  double sum = 0.0;
  for (int t = 1; t < kWordFrames; ++t) {
    const Eigen::VectorXd u = a.col(t) - a.col(t - 1), v = b.col(t) - b.col(t - 1);
    for (int i = 0; i < kWordSize; i += 3) sum += Alike(u.segment<3>(i), v.segment<3>(i));
  }
  return sum / ((kWordFrames - 1) * static_cast<double>(kWordJoints.size()));
}

constexpr double kHalfWindow = 0.25;    // s
constexpr double kPenalty = 1e-3;       // per sample
constexpr double kLeastSpread = 1e-6;   // of a feature
constexpr double kLeastGesture = 1e-3;  // m/s; if nobody moves, all others have the same weight
constexpr int kEvery = 3;               // every third frame is used: adjacent ones are nearly equal
constexpr int kMostSteps = 30;

using Features = Eigen::Matrix<double, kStateFeatures, 1>;

// What the features of others need of a person at one frame.
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

// The features of the person alone.
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

// Adds the features of the others.
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

// Means over +-half columns, from cumulative sums.
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

std::vector<Symbols> SocialStates(const std::vector<BodyMotion>& people, double dt) {
  std::vector<Symbols> all;
  for (size_t n = 0; n < people.size(); ++n) {
    const int front = InFront(people, n);
    Symbols symbols(people[n].size(), kStand);
    for (size_t t = 1; t < symbols.size(); ++t) {
      const bool pushes = front != kNobody && Pushes(people[n], people[front], t, dt);
      symbols[t] = (pushes ? kPushStanding : kStand) + PostureSymbol(people[n], t, dt);
    }
    if (symbols.size() > 1) symbols[0] = symbols[1];
    all.push_back(std::move(symbols));
  }
  return all;
}

StateFunction SocialStateFunction() {
  StateFunction states{{}, SocialStates};
  for (const auto& row : Names(SocialState{})) states.names.push_back(row.name);
  return states;
}

MotionWords::Word MotionWords::WordAt(const BodyMotion& motion, size_t begin) {
  const Pose& first = motion[begin];
  Eigen::Vector3d origin = 0.5 * (first.col(kRightHip) + first.col(kLeftHip));
  origin.z() = 0.0;
  const Eigen::Vector3d across = first.col(kLeftHip) - first.col(kRightHip);
  const Eigen::Matrix3d turn = TurnAboutZ(-std::atan2(across.y(), across.x()));
  Word word;
  for (int t = 0; t < kWordFrames; ++t) {
    for (size_t i = 0; i < kWordJoints.size(); ++i) {
      word.block<3, 1>(3 * static_cast<int>(i), t) =
          turn * (motion[begin + t].col(kWordJoints[i]) - origin);
    }
  }
  return word;
}

MotionWords::MotionWords(const std::vector<BodyMotion>& motions) {
  std::vector<Word> words;
  std::vector<int> following;
  for (const BodyMotion& motion : motions) {
    for (size_t t = 0; t + kWordFrames <= motion.size(); ++t) {
      const bool is_last = t + kWordFrames == motion.size();
      words.push_back(WordAt(motion, t));
      following.push_back(is_last ? kLast : static_cast<int>(words.size()));
    }
  }
  Mean centre = Mean::Zero();
  std::vector<Mean> means;
  for (const Word& word : words) means.push_back(word.rowwise().mean());
  for (const Mean& mean : means) centre += mean / static_cast<double>(means.size());
  Eigen::Matrix<double, kWordSize, kWordSize> spread;
  spread.setZero();
  for (const Mean& mean : means) spread += (mean - centre) * (mean - centre).transpose();
  // Eigenvalues ascend; the widest axis comes first here.
  axes_ = DecomposeSymmetric(spread).vectors.rowwise().reverse().transpose();
  for (Mean& mean : means) mean = axes_ * mean;
  std::vector<int> order(words.size()), place(words.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&means](int a, int b) { return means[a][0] < means[b][0]; });
  for (size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<int>(i);
  for (const int i : order) {
    words_.push_back(words[i]);
    places_.push_back(means[i]);
    next_.push_back(following[i] == kLast ? kLast : place[following[i]]);
  }
}

int MotionWords::Nearest(const Word& word, int first) const {
  const Mean at = axes_ * word.rowwise().mean();
  int nearest = first;
  double least = (words_[first] - word).squaredNorm();
  const auto within = [&least](double squared_gap) {
    return kWordFrames * squared_gap <= least + kRounding;
  };
  const auto look = [&](int i) {
    double gap = 0.0;
    for (int k = 0; k < kWordSize; ++k) {
      const double d = places_[i][k] - at[k];
      gap += d * d;
      if (k % 4 == 3 && !within(gap)) return;
    }
    if (!within(gap)) return;
    const double distance = (words_[i] - word).squaredNorm();
    if (distance > least || (distance == least && i >= nearest)) return;
    least = distance;
    nearest = i;
  };
  const auto less = [](const Mean& mean, double value) { return mean[0] < value; };
  const int middle = static_cast<int>(
      std::lower_bound(places_.begin(), places_.end(), at[0], less) - places_.begin());
  const auto near = [&](int i) { return within(std::pow(places_[i][0] - at[0], 2)); };
  for (int i = middle; i < size() && near(i); ++i) look(i);
  for (int i = middle - 1; i >= 0 && near(i); --i) look(i);
  return nearest;
}

std::vector<double> MotionWords::Scores(const BodyMotion& motion) const {
  std::vector<double> scores;
  int nearest = kLast;
  for (size_t t = 0; t + kWordFrames <= motion.size(); ++t) {
    const Word word = WordAt(motion, t);
    // The successor of the previous word's nearest word is usually near.
    const int first = nearest == kLast || next_[nearest] == kLast ? 0 : next_[nearest];
    nearest = Nearest(word, first);
    scores.push_back(Score(word, words_[nearest]));
  }
  return scores;
}

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
    // The weights are ordered row by row.
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

}  // namespace pushid
