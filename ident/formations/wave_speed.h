// ident: how fast a push goes through a formation.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/point_motion.h"
#include "ident/formations/formation_run.h"
#include "ident/model/fitted_model.h"

namespace pushid {

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
  int moved = 0, draws = 0;  // those that have a speed, and all

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

// Everybody, and the speed of the onset.
std::string WaveText(const MeasuredWave& wave);
// The speed over several; empty of fewer than two that have one.
std::string WavesText(const std::vector<MeasuredWave>& waves);

}  // namespace pushid
