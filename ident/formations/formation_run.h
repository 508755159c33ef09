// ident: an identified model rolled out on a formation: who moves when, how far, with which forces.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/prediction/prediction.h"
#include "ident/results/fit_result.h"
#include "ident/results/identified_model.h"
#include "models/rollout.h"

namespace pushid {

// The state of a person two seconds after the last push, or after the person's onset where that is
// later: a person whom the push has not reached yet has not settled. It is never judged at the end
// of the run, when a person who was slow to settle may have settled.
enum class Outcome {
  kSettled,   // slower than 0.1 m/s and within 0.05 rad of the rest posture
  kUnmoved,   // no onset
  kSlow,      // none of these: slow to settle
  kFell,      // theta or phi beyond 1.0 rad at any time
  kNotJudged  // the run ends before the two seconds are over
};
std::string_view Name(Outcome outcome);

// What a table of outcomes and displacements means, for the line under it.
std::string OutcomeLegend();

struct PersonSummary {
  int onset_frame = -1;       // of 2 cm of hip motion (propagation.h); -1: never
  double peak_speed = 0.0;    // m/s, of the hip
  double displacement = 0.0;  // m along x, of the hip at the end
  Outcome outcome = Outcome::kNotJudged;
};

struct FormationRun {
  PendulumRecording recording;  // the scene under the names that files give its people
  Prediction prediction;
  std::vector<PersonSummary> summaries;

  int num_people() const { return recording.scene.num_people(); }
  int num_frames() const { return prediction.path.num_frames(); }
  const NetForce<double>& Force(int person, int frame) const {
    return prediction.forces.At(frame, person);
  }
  double Seconds(int frame) const { return frame * recording.scene.dt; }
};

// The parts of the net force that are not zero throughout, in the order that files and pictures
// list them: the push and its tail first, then what answers it.
std::vector<ForcePart> ActingParts(const FormationRun& run);

// When the prediction leaves the model's domain, the summaries stay empty.
// names: of the people; empty: p00, p01, ...
FormationRun RunFormation(const IdentifiedModel& model, const Scene& scene, int num_frames,
                          const std::vector<std::string>& names = {});

// |hip velocity| at a frame, m/s: how fast it got there (backward difference); zero at frame 0.
double HipSpeed(const FormationRun& run, int person, int frame);
// The same, negative for a person who goes back more than aside: what colours a wave.
double SignedHipSpeed(const FormationRun& run, int person, int frame);

}  // namespace pushid
