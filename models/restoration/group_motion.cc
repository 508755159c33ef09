// models: symbols of people in a crowd.
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

// Of frame t > 0.
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

namespace {

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

}  // namespace

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
  // Eigenvalues ascend: the widest axis is the last, and is to come first.
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
    // The nearest of the word before, a frame on, is hardly ever far.
    const int first = nearest == kLast || next_[nearest] == kLast ? 0 : next_[nearest];
    nearest = Nearest(word, first);
    scores.push_back(Score(word, words_[nearest]));
  }
  return scores;
}

}  // namespace pushid
