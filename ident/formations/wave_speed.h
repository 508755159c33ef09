// ident: how fast a push goes through a formation.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ident/formations/formation_run.h"
#include "ident/model/fitted_model.h"

namespace pushid {

// From the first person who moves to the foremost one who does; people are numbered forwards.
struct WaveSpeed {
  int from = 0, to = 0;  // persons
  double metres = 0.0, seconds = 0.0;
  double MetresPerSecond() const { return metres / seconds; }
};

// onsets: a frame for each person, -1 for who never moves. Nothing where several pushes make
// several waves, and where fewer than two move or both at once.
std::optional<WaveSpeed> SpeedOfWave(const Scene& scene, const std::vector<int>& onsets);
std::optional<WaveSpeed> SpeedOfWave(const FormationRun& run);

// How sure the wave of a formation is.
//
// The formation is rolled out with parameters drawn anew, from the bootstrap's replicas where the
// model has them and else from its covariance (prediction/predictive_bands.h); bands are the
// central 90 %. They hold what the parameters leave open, not how people with the same parameters
// differ.

struct OnsetBand {
  double from = 0.0, to = 0.0;  // s
  double moved = 0.0;           // share of the draws in which this person moves; 0: no band
};

// Of SpeedOfWave in each draw, m/s: each between the first and the foremost of its own movers.
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

// Empty where the model has neither covariance nor bootstrap. set: what --set replaces in every
// draw.
WaveBands BandsOfWave(const FittedModel& model, const std::string& set, const FormationRun& run);

}  // namespace pushid
