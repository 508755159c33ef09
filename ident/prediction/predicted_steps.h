// ident: which foot steps in a predicted path, when and how far, in the form of recorded steps
// (datasets/loading/foot_steps.h).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/figures/text_table.h"
#include "ident/model/identified_model.h"
#include "ident/prediction/prediction.h"

namespace pushid {

// A person's foot in a path, m.
Eigen::Vector2d PlaceOf(Foot foot, const PendulumState<double>& state);

// Steps in order; lift-off: the frame after the last one in which the foot stood.
std::vector<FootStep> PredictedSteps(const RolloutPath<double>& path, int person);

// A place where a foot stands: from a landing, or frame 0, to the next lift-off, or the end.
struct Footprint {
  Foot foot = Foot::kLeft;
  int landing = 0, lift_off = 0;                    // frames: the first on it, the first off again
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  // of the ankle, m
};
// Footprints by landing. start: the state at frame 0; steps: by lift-off.
std::vector<Footprint> Footprints(const PendulumState<double>& start,
                                  const std::vector<FootStep>& steps, int num_frames);
// Footprints of all people, recorded and predicted; none on ground that moves. There are no
// predicted ones if the model's feet do not step, or frames after the first were observed.
using FootprintsOfPeople = std::vector<std::vector<Footprint>>;
FootprintsOfPeople RecordedFootprints(const PendulumRecording& recording);
FootprintsOfPeople PredictedFootprints(const PendulumRecording& recording,
                                       const Prediction& prediction);

// A line per person: "S01: P(step) 0.93, steps left 0.42-0.78 s 0.31 m forwards"; empty where the
// model says nothing of steps.
std::string PredictedStepsText(const PendulumRecording& recording, const Prediction& prediction);

// Scores of predictions of who steps.
//
//   Brier score  mean of (p - stepped)^2
//   AUC          probability that somebody who steps has a higher p than somebody who does not
//   fifths       tracks by p, five groups of one size: mean p beside the share that stepped
//   lift-off     predicted minus recorded time of the first, of those who step in both
//   place        how far the travels of first steps are apart, where both were finished
// Standard errors by leaving out one person after the other (jackknife): one body and one habit
// make all of a person's tracks.

// The times (s from frame 0) and travels of a person's first predicted step, in a model whose feet
// step, and of the first recorded one.
struct StepTiming {
  std::optional<double> lift_off, landing;           // no landing: in the air in the last frame
  Eigen::Vector2d travel = Eigen::Vector2d::Zero();  // of the foot, m
  std::optional<double> recorded_lift_off;
  std::optional<Eigen::Vector2d> recorded_travel;  // of a first step that was finished
};

// One person in one recording.
struct StepPrediction {
  double margin = 0.0;       // m (fit/step_probability.h)
  double probability = 0.0;  // of a step
  bool stepped = false;
  std::string person = {};  // id
  // Known where the model's feet step; in a cross-validation that of the first fold.
  std::optional<StepTiming> timing = {};
};

struct StepFifth {
  int tracks = 0;
  double predicted = 0.0, observed = 0.0;
};

struct LiftOffError {
  int people = 0;                            // number of people who step in both
  double median = 0.0, mean_absolute = 0.0;  // s; positive: predicted too late
  int landed = 0;                            // number of people who land in both
  double place = 0.0;                        // m, mean over these
};

struct StepScore {
  int tracks = 0, stepped = 0, people = 0;
  double brier = 0.0, brier_error = 0.0;
  double auc = 0.0, auc_error = 0.0;  // 0.5 where nobody stepped, or everybody
  std::vector<StepFifth> fifths;      // fewer where there are fewer than ten tracks
  LiftOffError lift_off;

  bool known() const { return tracks > 0; }
};

StepScore ScoreSteps(const std::vector<StepPrediction>& predictions);

// "P(step) = ...", its errors, and at which margin half of all people step.
std::string StepProbabilityText(const StepProbability& probability);

// A table with a column for each score that is known, and a line on its errors; empty where no
// score is known.
std::string StepScoresText(NamedValues<StepScore> scores);

}  // namespace pushid
