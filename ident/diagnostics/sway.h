// ident: how people sway who stand undisturbed, measured and by the identified process noise.
//
// Of the track of the centre of pressure where platforms measured, else of the hip, less its mean,
// low-passed at 5 Hz (both by Prieto et al., IEEE Trans. Biomed. Eng. 1996):
//   path      sum of |p_t - p_(t-1)|, m, and over the time, m/s
//   rms       sqrt(mean p_i^2) along x and along y, m
//   frequency sum f S_i(f) / sum S_i(f) over 0.15 to 5 Hz, Hz (S: Welch, segments of 20 s)
//   ellipse   2 pi F_95(2, n - 2) sqrt(s_xx s_yy - s_xy^2), m^2: the area that holds 95 % of p
// The model's are those of rollouts with process noise (process_noise.h) of the same length, after
// 10 s in which they forget where they began: the platforms' centre of pressure is that which the
// ground needs for such a motion (ground_reaction.h).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/figures/text_table.h"
#include "models/options.h"

namespace pushid {

enum SwayMeasure : int {
  kSwayPath,
  kSwaySpeed,
  kSwayRmsX,
  kSwayRmsY,
  kSwayFrequencyX,
  kSwayFrequencyY,
  kSwayEllipse,
  kNumSwayMeasures
};
inline constexpr Metric kSwayMeasures[] = {
    {"path", "m"},         {"speed", "m/s"},      {"rms_x", "m"},    {"rms_y", "m"},
    {"frequency_x", "Hz"}, {"frequency_y", "Hz"}, {"ellipse", "m^2"}};

// By SwayMeasure.
using Sway = std::array<double, kNumSwayMeasures>;

// Of a track of at least 10 frames, m; dt: s.
Sway SwayOf(const std::vector<Eigen::Vector2d>& track, double dt);

// Nobody is pushed, the ground rests, and it lasts 10 s at least.
bool IsQuiet(const PendulumRecording& recording);

// One person over all quiet recordings of theirs: means over these.
struct PersonSway {
  std::string person;
  int recordings = 0;
  bool by_plates = false;  // else of the hip
  Sway measured{};
  // Of `repeats` rollouts of each recording that stay in the model's domain; 0: no process noise.
  int repeats = 0;
  Sway simulated{}, spread{};  // mean, and standard deviation from repeat to repeat
};

// recordings: as the files have them. parameters: [recording][person]. By name of the person; those
// with quiet recordings alone.
std::vector<PersonSway> SwayOfPeople(
    const std::vector<PendulumRecording>& recordings, const ModelOptions& options,
    const std::vector<std::vector<ParameterSet<double>>>& parameters, int repeats, uint64_t seed);

// A row for each person and measure: person, of, recordings, measure, unit, measured, simulated,
// spread, repeats. At full precision, for files.
TextTable SwayTable(const std::vector<PersonSway>& people);

}  // namespace pushid
