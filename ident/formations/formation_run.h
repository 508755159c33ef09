// ident: an identified model rolled out on a formation: who moves when, how far, with which forces,
// and how fast the wave goes, there or in recordings.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/point_motion.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/bodies/body_recording.h"
#include "ident/model/fitted_model.h"
#include "ident/model/identified_model.h"
#include "ident/prediction/prediction.h"
#include "ident/problem/behaviour.h"
#include "models/enum_names.h"
#include "models/restoration/body.h"
#include "models/restoration/postprocess.h"
#include "models/scene.h"

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
constexpr EnumNames<Outcome, 5> Names(Outcome) {
  return {{{kSettledText, Outcome::kSettled},
           {"unmoved", Outcome::kUnmoved},
           {kSlowToSettleText, Outcome::kSlow},
           {kFellText, Outcome::kFell},
           {"not judged", Outcome::kNotJudged}}};
}

// The meaning of a table of outcomes and displacements, for the line under it.
std::string OutcomeLegend();

struct PersonSummary {
  int onset_frame = -1;       // of 2 cm of hip motion (propagation.h); -1: never
  double peak_speed = 0.0;    // m/s, of the hip
  double displacement = 0.0;  // m along the first push, of the hip at the end
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

// Rolls out a formation; when it leaves the model's domain, the summaries stay empty. names: of the
// people; empty: p00, p01, ...
FormationRun RunFormation(const IdentifiedModel& model, const Scene& scene, int num_frames,
                          const std::vector<std::string>& names = {});

// The person whose answer predictions of external pushes are, of a model fitted to net ones alone;
// else empty. One sentence: people, recordings and stance of the fit, and where its person, alone,
// ends after two pushes that were measured on ten others (models/README.md). model: of that fit.
std::string PersonText(const FitResult& fit, const IdentifiedModel& model,
                       const std::vector<PendulumRecording>& recordings);

// Speed of the hip at a frame, m/s: how fast it got there (backward difference; 0 at frame 0),
// negative for a person who goes back more than aside.
double HipSpeed(const FormationRun& run, int person, int frame);

// Bodies for people who were never recorded: a formation's people get the skeleton and pose
// of a recorded person, or of the synthetic skeleton, and a restoration moves them.

// The synthetic skeleton of this rod length, upright, over a cart at the origin; z = 0 is the
// floor.
Pose SyntheticPose(double rod_length);

// Puts poses (in turn, should there be fewer than people) where the formation's people stand,
// facing +x, and gives those people the pendulum that goes with the pose: rod length, cart height,
// lean and places of the feet. Masses and pushes stay. Returns the first pose of each person.
std::vector<Pose> TakePoses(const std::vector<Pose>& poses, Scene* scene);

// The people of a fit in the places of the scene's, facing +x, from the first again where there are
// fewer: mass, rod, lean and feet. Before pushes are added.
void PlaceFittedPeople(const std::vector<FittedPerson>& people, Scene* scene);

// The synthetic skeleton as the pendulum of each person stands; sets heights of carts that are 0.
std::vector<Pose> SyntheticPoses(Scene* scene);

// Restored and post-processed, one motion per person. first_poses: as TakePoses returned them.
std::vector<BodyMotion> FormationBodies(const FormationRun& run,
                                        const std::vector<Pose>& first_poses,
                                        const Restoration& restoration,
                                        const PostprocessOptions& options);

// Recorded people (everybody once, by id, in the order of the recordings) in the places of the
// scene's, facing +x, from the first again where there are fewer: their masses, and the postures in
// which their recordings begin (rod length, cart height, lean, skeleton). Before pushes are added:
// those depend on the bodies. Returns the first pose of each person.
std::vector<Pose> PlacePeople(const std::vector<BodyRecording>& recordings, Scene* scene);

// The speed of a push through a formation.

// Speed from the first person who moves to the foremost one who does; people are numbered forwards.
struct WaveSpeed {
  int from = 0, to = 0;  // persons
  double metres = 0.0, seconds = 0.0;
  double MetresPerSecond() const { return metres / seconds; }
};

// onsets: a frame for each person, -1 for who never moves. Nothing where several pushes make
// several waves, and where fewer than two move or both at once.
std::optional<WaveSpeed> SpeedOfWave(const Scene& scene, const std::vector<int>& onsets);
std::optional<WaveSpeed> SpeedOfWave(const FormationRun& run);

// The uncertainty of a formation's wave.
//
// The formation is rolled out with parameters drawn anew, from the bootstrap's replicas where the
// model has them and else from its covariance (prediction/futures.h); bands are the
// central 90 %. They hold what the parameters leave open, not how people with the same parameters
// differ.

struct OnsetBand {
  double from = 0.0, to = 0.0;  // s
  double moved = 0.0;           // share of the draws in which this person moves; 0: no band
};

// SpeedOfWave in each draw, m/s: between the first and the foremost of its own movers.
struct SpeedBand {
  double from = 0.0, to = 0.0;
  int moved = 0, draws = 0;  // draws that have a speed, and all

  // Few draws have no quantiles.
  bool known() const { return moved >= kLeastDraws; }
  static constexpr int kLeastDraws = 20;
};

struct WaveBands {
  std::vector<OnsetBand> onsets;  // of each person; empty: the model says nothing of its errors
  SpeedBand speed;
  int failed = 0;  // draws whose rollout left the model's domain; nobody moves in them
};

// "contact_height = 0.5, mu = 20 (--set)": what was held in the fit or is set, so that no draw
// moves it; empty: nothing.
std::string HeldInDraws(const FittedModel& model, const std::string& set);

// Bands of a wave; empty where the model has neither covariance nor bootstrap. set: what --set
// replaces in every draw.
WaveBands BandsOfWave(const FittedModel& model, const std::string& set, const FormationRun& run);

// The speed at which a push travels through people, from their trajectories alone: no model, no
// fit.
//
// The first mover is who leaves the first position seen by 2 cm, horizontally, before all others
// (kOnsetDistance, propagation.h). With s_n the distance of everybody from there at rest and t_n
// their onset, the slope b of t on s over the movers is a slowness, and 1 / b the speed of the
// onset. Its interval is Student's of the scatter about the line, n - 2 degrees of freedom; of
// several files that of their mean, each file a unit. People who walk, sway by 2 cm or are pushed
// in several places have onsets too: their slope means nothing, and its interval says so.

struct PersonInWave {
  std::string name;
  double distance = 0.0;  // m, from the first mover, at rest
  std::optional<double> onset_s;
  double peak_speed = 0.0;  // m/s, over 6 frames, along the first mover's way
  double displaced = 0.0;   // m, at the end of what was seen
};

struct MeasuredWave {
  std::string name;                  // of the file or the recording
  std::vector<PersonInWave> people;  // the first mover first, then by distance; empty: nobody moves
  std::optional<double> slowness;    // s/m; of three movers or more
  double error = 0.0, quantile = 0.0;  // of slowness; 0: not known
};

// Positions of one point a person, horizontal axes x and y.
MeasuredWave MeasureWave(const std::string& name, const PointMotion& motion);

// A file of trajectories, a table of points, one a person, or the groups of a manifest. Errors: of
// the readers, and of files whose points are markers of a body.
Result<std::vector<MeasuredWave>> MeasureWaves(const std::string& path);

// A row for each person, and the speed of the onset.
std::string WaveText(const MeasuredWave& wave);
// The speed over several; empty of fewer than two that have one.
std::string WavesText(const std::vector<MeasuredWave>& waves);

}  // namespace pushid
