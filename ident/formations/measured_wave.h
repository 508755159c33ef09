// ident: how a push travels through people, from their trajectories alone: no model, no fit.
//
// The first mover is who leaves the first position seen by 2 cm, horizontally, before all others
// (kOnsetDistance, propagation.h). With s_n the distance of everybody from there at rest and t_n
// their onset, the slope b of t on s over the movers is a slowness, and 1 / b the speed of the
// onset. Its interval is Student's of the scatter about the line, n - 2 degrees of freedom; of
// several files that of their mean, each file a unit. People who walk, sway by 2 cm or are pushed
// in several places have onsets too: their slope means nothing, and its interval says so.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/point_motion.h"

namespace pushid {

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
