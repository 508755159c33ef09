// ident: the forces on one person of a prediction in words, the energy balance of contact, and how
// a push travels through people.
//
// Along the push, the net force on a person has three causes: the push itself, other people, and
// the person's own answer (friction, balance and all other terms of one person). The cause of a
// frame is the largest of them, if it is above 10 N. The force of others comes from behind if it
// acts along the push, otherwise from in front, and is named after the nearest person on that side.
// A cause that lasts less than 0.1 s, unless it is a push, is replaced by the one before; a series
// of such causes that lasts longer takes the cause with the largest summed force.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "ident/prediction/prediction.h"

namespace pushid {

enum class Cause { kNothing, kPush, kFromBehind, kFromInFront, kOwn };

struct StoryMoment {
  int from = 0, to = 0;  // frames, `to` is the next one's `from`
  Cause cause = Cause::kNothing;
  double peak = 0.0;     // N, of the cause
  double impulse = 0.0;  // N s along the push
  std::string text;      // "pushed from behind by X-18, up to 230 N (31 N s)"
};

struct ForceStory {
  int person = -1;
  std::vector<StoryMoment> moments;
};

// The prediction must have stayed within its domain.
ForceStory StoryOf(const PendulumRecording& recording, const Prediction& prediction, int person);

// The story of the bystander with the most kinds of causes, of equal ones the one on whom others
// act most. Person -1 where there is no bystander.
ForceStory RichestStory(const PendulumRecording& recording, const Prediction& prediction);

// "X-11: 0 s still; 0.42 s pushed from behind by X-18, up to 230 N (31 N s); ..."
std::string StoryText(const PendulumRecording& recording, const ForceStory& story);

// The contact energy balance along a rollout.
//
// Work on a person between two frames: (Q_t + Q_t+1) / 2 . (q_t+1 - q_t), the trapezoid of the
// generalized force along the path, so that a spring alone gives back what it took, whatever the
// step. Of each step's total over people the negative part is absorbed by contact (stored or lost),
// the positive part returned; contact still loaded at the last frame has not returned its share.

struct ContactEnergyBalance {
  double absorbed = 0.0, returned = 0.0;  // J

  double TotalWork() const { return returned - absorbed; }
};

// forces: those that drove the path (Rollout's trace); its last frame must hold them too.
ContactEnergyBalance BalanceContactEnergy(const RolloutPath<double>& path,
                                          const ForceTrace& forces);

// The travel of a push through people: each person's onset, the speed from one to the next, the
// momentum that is passed on, and the work of contact.
//
// Onset: the first frame at which the hip is 2 cm, horizontally, from where it was at frame 0; -1
// when it never is. A mover has a measured onset within the recording, a bystander has none; people
// sway, so a bystander watched long enough becomes a mover by this rule. Rejected: height as well
// (breathing and bent knees are no motion).
//
// People are ranked by the distance s_n of their carts from the pushed person's at frame 0; u is
// the horizontal direction of the push. Speed: the slope b of onset time on s_n over the movers of
// a recording, the pushed person included, is a slowness in s/m and stays finite where everybody
// starts at once; speeds are 1 / mean(b).
//
// Momentum passed on: sum over k of P_k / sum over k of P_(k-1), P_k = M_k max_t v_k . u of the
// k-th in rank, v the hip's velocity over 6 frames. Above 1 the push grows on its way, below it
// dies.
//
// All summaries are ratios of sums over recordings, with standard errors clustered by recording.

inline constexpr double kOnsetDistance = 0.02;  // m

int OnsetFrame(const HipPath& hip);

// Slope of onset time on distance, s/m; nothing for fewer than three people or equal distances.
std::optional<double> Slowness(const std::vector<double>& distance_m,
                               const std::vector<double>& onset_s);

struct PersonPropagation {
  int rank = 0;                                   // 0: the pushed person
  double distance = 0.0;                          // m, from the pushed person's cart at frame 0
  int onset_measured = -1, onset_predicted = -1;  // frames
  double peak_momentum_measured = 0.0, peak_momentum_predicted = 0.0;  // N s, along the push
};

// A figure's share from one recording; a summary is the sum of sums over the sum of weights.
struct Ratio {
  double sum = 0.0, weight = 0.0;
};

enum PropagationFigure : int {
  kOnsetError,         // frames: mean |predicted - measured| over people who move in both
  kOnsetErrorReached,  // that without the pushed person, whose onset is the push's
  kOnsetBias,          // predicted - measured: positive when the model starts late
  kMissedMovers,       // share of movers predicted not to move
  kFalseMovers,        // share of bystanders predicted to move
  kSlownessMeasured,   // s/m
  kSlownessPredicted,
  kMomentumMeasured,  // momentum passed on
  kMomentumPredicted,
  kContactWork,  // J per recording, negative: contact dissipates
  // Returned over absorbed energy, the square of a coefficient of restitution; only of models whose
  // interaction is mutual contact alone.
  kRestitution,
  kNumPropagationFigures
};

struct PropagationFigureInfo {
  const char* key;    // in JSON, with the unit
  const char* title;  // in tables
};
inline constexpr PropagationFigureInfo kPropagationFigures[kNumPropagationFigures] = {
    {"onset_error_frames", "onset error, frames (who move in both)"},
    {"onset_error_reached_frames", "  without the pushed person"},
    {"onset_bias_frames", "  predicted - measured"},
    {"missed_movers_share", "missed movers / movers"},
    {"false_movers_share", "false movers / bystanders"},
    {"slowness_measured_s_per_m", "slowness measured, s/m"},
    {"slowness_predicted_s_per_m", "slowness predicted, s/m"},
    {"momentum_passed_on_measured", "momentum passed on, measured"},
    {"momentum_passed_on_predicted", "momentum passed on, predicted"},
    {"contact_work_J", "work of contact per recording, J"},
    {"contact_returned_share", "  share given back (restitution squared)"},
};

struct PropagationScore {
  std::vector<PersonPropagation> people;  // empty for a single person
  std::array<Ratio, kNumPropagationFigures> figures{};

  // Adds and divides the sums of the figures, for averages over repeats.
  void Add(const PropagationScore& other);
  void Divide(double by);
};

// The score that hips alone give. predicted: [person][frame]. Empty for a single person.
PropagationScore ScorePropagation(const PendulumRecording& recording, const HipPaths& predicted);

// Adds the figures of the model's forces to the score of the same prediction.
void AddContactFigures(const IdentifiedModel& model, const Prediction& prediction,
                       PropagationScore* score);

struct PropagationMean {
  double value = 0.0, error = 0.0;  // the error is 0 for a single recording
  double weight = 0.0;              // people, recordings, N s or J: the ratio's denominator
  bool known() const { return weight > 0.0; }
};

struct PropagationSummary {
  int recordings = 0;  // with more than one person
  double movers = 0.0, bystanders = 0.0, missed_movers = 0.0, false_movers = 0.0;
  std::array<PropagationMean, kNumPropagationFigures> figures{};
};

PropagationSummary SummarizePropagation(const std::vector<const PropagationScore*>& scores);

// 1 / slowness with its error; nothing when the slowness is unknown or not positive.
std::optional<PropagationMean> Speed(const PropagationMean& slowness);

}  // namespace pushid
