// models: how the bodies of a group move, for metrics: people's states as symbols, and how natural
// their motions are.
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
//   push     1: a wrist is within 0.35 m of the upper spine of the person in front, and one's own
//            hip moves forwards (+x) faster than 0.08 m/s
//
// Speeds are backward differences; frame 0 has the symbol of frame 1. The person in front is the
// nearest at frame 0 with dx > 0 and |dy| < dx, hip to hip; without one, push is 0.

// A set of states and the function that finds them in the motion of a group, [person].
struct StateFunction {
  std::vector<std::string> names;
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
// A word is 20 frames (at 60 Hz) of 17 joints, relative to the floor below the middle of the hip
// joints at its first frame and turned to a common heading. Each word of a motion is compared with
// the nearest recorded word, by the joints' places; its score is the similarity of their
// velocities, the mean over 19 differences of frames and 17 joints of
//
//   (cos(u, v) + 1) / 2 * min(|u|, |v|) / max(|u|, |v|),   |.| at least 1e-7 m
//
// with cos(u, v) = u.v / (|u| |v|). Two joints at rest thus score 1/2, as in the implementation
// that the check values of the tests come from: they move neither in the same nor in opposite
// directions. Rejected: a score of 1, which rewards forecasts that freeze where recordings rest.
//
// The search for the nearest word is exact: because sum over frames of |a - b|^2 >= frames *
// |mean a - mean b|^2, the means exclude most words, compared along the principal axes of the
// recorded means first.

inline constexpr int kWordFrames = 20;
inline constexpr double kWordRate = 60.0;  // Hz
inline constexpr std::array<int, 17> kWordJoints = {1,  2,  3,  4,  5,  7,  8,  9, 11,
                                                    12, 13, 15, 16, 17, 19, 20, 21};
inline constexpr int kWordSize = 3 * static_cast<int>(kWordJoints.size());

class MotionWords {
 public:
  using Word = Eigen::Matrix<double, kWordSize, kWordFrames>;

  // Motions of fewer than kWordFrames frames have no words.
  explicit MotionWords(const std::vector<BodyMotion>& motions);

  int size() const { return static_cast<int>(words_.size()); }
  const Word& word(int i) const { return words_[i]; }
  static Word WordAt(const BodyMotion& motion, size_t begin);
  // first: the word to begin the search with; the nearer it is, the faster the search.
  int Nearest(const Word& word, int first = 0) const;

  // The scores of the words of `motion`, by their first frame. Requires size() > 0.
  std::vector<double> Scores(const BodyMotion& motion) const;

 private:
  using Mean = Eigen::Matrix<double, kWordSize, 1>;

  std::vector<Word> words_;  // sorted by the first principal coordinate of their means
  std::vector<int> next_;    // the word that begins a frame later
  Eigen::Matrix<double, kWordSize, kWordSize> axes_;
  std::vector<Mean> places_;  // principal coordinates of the means
};

// A classifier that finds annotated states in motion without annotations: multinomial logistic
// regression on a few features of a person's motion and that of the others.
//
//   P(state k) = exp(w_k . x) / sum_j exp(w_j . x)
//   w = argmin of -log P of the annotated states + penalty / 2 |w|^2, by Newton's method
//
// x: a constant 1 and these features, averaged over +-0.25 s and scaled to zero mean and unit
// variance:
//   - speed of the wrists relative to the hip, their sum and the faster one; height of the higher
//     wrist above the hip; least distance of a wrist to another person's upper spine;
//   - speed of the faster ankle; speed of the hip; lean of the hip over the ankles; turning rate of
//     the shoulders; their angle to the pelvis;
//   - cosine between the others' headings and the direction from them to the person: mean and
//     least;
//   - wrist speed of the others: mean and largest; cosine between the person's heading and the
//     directions to the others, weighted by that speed.
// The order of the others does not matter. A person alone has zeros in the features of others.

inline constexpr int kStateFeatures = 14;

// The features of each person, a column per frame.
using StateFeatures = std::vector<Eigen::MatrixXd>;
StateFeatures StateFeaturesOf(const std::vector<BodyMotion>& people, double dt);

class StateClassifier {
 public:
  // A group with the states of its people, [person][frame].
  struct Annotated {
    StateFeatures features;
    std::vector<Symbols> states;
  };
  // num_symbols: number of states; some of them may have no frame.
  StateClassifier(const std::vector<const Annotated*>& groups, int num_symbols);

  // The most probable states, [person][frame].
  std::vector<Symbols> Of(const StateFeatures& features) const;

 private:
  Eigen::MatrixXd Standardized(const Eigen::MatrixXd& features) const;

  Eigen::VectorXd mean_, spread_;
  Eigen::MatrixXd weights_;  // symbols x (features and 1)
};

}  // namespace pushid
