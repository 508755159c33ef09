// ident: how a push travels through people: when each starts to move, how fast it goes from one to
// the next, what it keeps of its momentum, and what contact does to its energy.
//
// Onset: the first frame at which the hip is 2 cm, horizontally, from where it was at frame 0; -1
// when it never is. A mover has a measured onset within the recording, a bystander has none; people
// sway, so a bystander watched long enough becomes a mover by this rule (report how long they were
// watched: kBystanderFrames). Rejected: height as well (breathing and bent knees are no motion).
//
// People are ranked by the distance s_n of their carts from the pushed person's at frame 0; u is
// the horizontal direction of the push. Speed: the slope b of onset time on s_n over the movers of
// a recording, the pushed person included, is a slowness in s/m and stays finite where everybody
// starts at once; speeds are 1 / mean(b).
//
// Momentum passed on: sum over k of P_k / sum over k of P_(k-1), P_k = M_k max_t v_k . u of the
// k-th in rank, v the hip's velocity over 6 frames. Above 1 the push grows on its way, below it
// dies. From the model's own forces also I_0 / I_push and sum I_k / sum I_(k-1), where
//   I_k = sum over everybody farther than the k-th of the integral of contact force . u,
// the momentum that has crossed from the k-th on (contact is mutual, so what goes on among those
// beyond cancels), and I_push is the push with its tail.
//
// All summaries are ratios of sums over recordings, with standard errors clustered by recording.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "ident/prediction/prediction.h"

namespace pushid {

inline constexpr double kOnsetDistance = 0.02;  // m

int OnsetFrame(const std::vector<Vector3<double>>& hip, double distance = kOnsetDistance);

// Slope of onset time on distance, s/m; nothing for fewer than three people or equal distances.
std::optional<double> Slowness(const std::vector<double>& distance_m,
                               const std::vector<double>& onset_s);

struct PersonPropagation {
  int rank = 0;                                   // 0: the pushed person
  double distance = 0.0;                          // m, from the pushed person's cart at frame 0
  int onset_measured = -1, onset_predicted = -1;  // frames
  double peak_momentum_measured = 0.0, peak_momentum_predicted = 0.0;  // N s, along the push
  // From a model's rollout only.
  double contact_work = 0.0;  // J done on this person by contact
  double impulse_on = 0.0;    // N s, I_k of this person's rank
};

// A figure's share from one recording; a summary is the sum of sums over the sum of weights.
struct Ratio {
  double sum = 0.0, weight = 0.0;
};

enum PropagationFigure : int {
  kOnsetError,            // frames: mean |predicted - measured| over people who move in both
  kOnsetErrorReached,     // the same without the pushed person, whose onset is the push's
  kOnsetBias,             // predicted - measured: positive when the model starts late
  kOnsetErrorWithMissed,  // over all movers, missed ones as if they started at the last frame
  kMissedMovers,          // share of movers predicted not to move
  kFalseMovers,           // share of bystanders predicted to move
  kBystanderFrames,       // frames over which a bystander was watched
  kSlownessMeasured,      // s/m
  kSlownessPredicted,
  kSlownessDifference,  // predicted - measured where both exist
  kMomentumMeasured,    // momentum passed on
  kMomentumPredicted,
  kPushPassedOn,     // I_0 / I_push
  kContactPassedOn,  // sum I_k / sum I_(k-1), k > 0
  kContactWork,      // J per recording, negative: contact dissipates
  kContactAbsorbed,  // J per recording taken from people's motion while contact takes energy
  // Returned over absorbed energy, the square of a coefficient of restitution; only of models whose
  // interaction is mutual contact alone.
  kRestitution,
  kNumPropagationFigures
};

struct PropagationFigureInfo {
  const char* key;    // in JSON, with the unit
  const char* title;  // in tables
};
const PropagationFigureInfo& Info(PropagationFigure figure);

struct PropagationScore {
  std::vector<PersonPropagation> people;  // empty for a single person
  std::array<Ratio, kNumPropagationFigures> figures{};

  // Sums only: what averages over repeats are made of.
  void Add(const PropagationScore& other);
  void Divide(double by);
};

// What hips alone tell. predicted: [person][frame]. Empty for a single person.
PropagationScore ScorePropagation(const PendulumRecording& recording,
                                  const std::vector<std::vector<Vector3<double>>>& predicted);

// What the model's forces tell, added to the score of the same prediction.
void AddContactFigures(const IdentifiedModel& model, const PendulumRecording& recording,
                       const Prediction& prediction, PropagationScore* score);

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
