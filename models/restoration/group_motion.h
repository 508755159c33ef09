// models: how bodies of a group move, for metrics: what people do as symbols, and how natural their
// motions look.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "models/enum_names.h"
#include "models/particles.h"
#include "models/restoration/body.h"

namespace pushid {

// States of people in a crowd, frame by frame, as one of six symbols:
//
//   3 * push + posture
//   posture  2 step: an ankle's horizontal speed is above 0.35 m/s; else
//            1 lean: the line from between the ankles to the hip has turned by more than 5 degrees
//              since frame 0; else
//            0 stand
//   push     1: a wrist is within 0.35 m of the upper spine of the person in front, and the
//            own hip goes forwards (+x) faster than 0.08 m/s
//
// Speeds are backward differences; frame 0 has the symbol of frame 1. In front stands the nearest
// at frame 0 with dx > 0 and |dy| < dx, hip from hip; people without anybody in front push nobody.

// Symbols of a group, [person]; another set of symbols may be put in its place.
struct StateFunction {
  std::vector<std::string> names;  // of the symbols
  std::function<std::vector<Symbols>(const std::vector<BodyMotion>& people, double dt)> of;

  int num_symbols() const { return static_cast<int>(names.size()); }
};

enum SocialState { kStand, kLean, kStep, kPushStanding, kPushLeaning, kPushStepping };
inline constexpr int kSocialStates = 6;
constexpr EnumNames<SocialState, kSocialStates> Names(SocialState) {
  return {{{"stand", kStand},
           {"lean", kLean},
           {"step", kStep},
           {"push_standing", kPushStanding},
           {"push_leaning", kPushLeaning},
           {"push_stepping", kPushStepping}}};
}

std::vector<Symbols> SocialStates(const std::vector<BodyMotion>& people, double dt);
StateFunction SocialStateFunction();

// Naturalness of motions: normalized directional motion similarity (NDMS, Tanke et al.,
// "Intention-based long-term human motion anticipation", 3DV 2021; as SDM uses it).
//
// A word is 20 frames (at 60 Hz) of 17 joints, seen from the floor below the middle of the hip
// joints at its first frame and turned to face one way. To every word of a motion belongs the
// nearest of recorded ones, by the joints' places; its score is how alike both move, the mean over
// 19 differences of frames and 17 joints of
//
//   (cos(u, v) + 1) / 2 * min(|u|, |v|) / max(|u|, |v|),   |.| at least 1e-7 m
//
// with cos(u, v) = u.v / (|u| |v|). Two joints at rest thus score 1/2, as in the implementation
// that the check values of the tests come from: they go neither the same way nor the opposite one.
// Rejected: 1 for them, which rewards forecasts that freeze where recordings rest.
//
// The nearest are exact: sum over frames of |a - b|^2 >= frames * |mean a - mean b|^2, so that
// means rule most words out, and of these the principal axes of the recorded means come first.

inline constexpr int kWordFrames = 20;
inline constexpr double kWordRate = 60.0;  // Hz
inline constexpr std::array<int, 17> kWordJoints = {1,  2,  3,  4,  5,  7,  8,  9, 11,
                                                    12, 13, 15, 16, 17, 19, 20, 21};
inline constexpr int kWordSize = 3 * static_cast<int>(kWordJoints.size());

class MotionWords {
 public:
  using Word = Eigen::Matrix<double, kWordSize, kWordFrames>;

  // Every word of the motions; shorter ones have none.
  explicit MotionWords(const std::vector<BodyMotion>& motions);

  int size() const { return static_cast<int>(words_.size()); }
  const Word& word(int i) const { return words_[i]; }
  // The word of `motion` from a frame on.
  static Word WordAt(const BodyMotion& motion, size_t begin);
  // first: any word, at best one that is near.
  int Nearest(const Word& word, int first = 0) const;

  // The scores of the words of `motion`, by the frame each begins at. At least one recorded word is
  // needed.
  std::vector<double> Scores(const BodyMotion& motion) const;

 private:
  using Mean = Eigen::Matrix<double, kWordSize, 1>;

  std::vector<Word> words_;  // by their place on the first axis
  std::vector<int> next_;    // the word that begins a frame later
  Eigen::Matrix<double, kWordSize, kWordSize> axes_;
  std::vector<Mean> places_;  // of means, on the axes
};

// States of people that somebody annotated, found in motion that nobody did: multinomial
// logistic regression on a few features of who moves how beside whom.
//
//   P(state k) = exp(w_k . x) / sum_j exp(w_j . x)
//   w = argmin of -log P of the annotated states + penalty / 2 |w|^2, by Newton's method
//
// x, each to zero mean and unit variance, and 1: means over +-0.25 s of
//   speed of the wrists seen from the hip, of both and of the faster; height of the higher wrist
//   above the hip; its distance to the nearest other's upper spine
//   speed of the faster ankle; of the hip; lean of the hip against the ankles; turning of the
//   shoulders; their angle to the pelvis
//   cosine between where others face and the way to me: mean and least
//   wrist speed of the others: mean and most; cosine between where I face and the ways to the
//   others, weighted by it
// Others enter by means and extremes: their order does not matter. A person alone has zeros there.

inline constexpr int kStateFeatures = 14;

// [person], a column per frame.
using StateFeatures = std::vector<Eigen::MatrixXd>;
StateFeatures StateFeaturesOf(const std::vector<BodyMotion>& people, double dt);

class StateClassifier {
 public:
  // A group with the states of its people, [person][frame].
  struct Annotated {
    StateFeatures features;
    std::vector<Symbols> states;
  };
  // There are num_symbols states, each of which somebody has at some frame or not.
  StateClassifier(const std::vector<const Annotated*>& groups, int num_symbols);

  // The most probable states, [person][frame].
  std::vector<Symbols> Of(const StateFeatures& features) const;

 private:
  Eigen::MatrixXd Standardized(const Eigen::MatrixXd& features) const;

  Eigen::VectorXd mean_, spread_;
  Eigen::MatrixXd weights_;  // symbols x (features and 1)
};

}  // namespace pushid
