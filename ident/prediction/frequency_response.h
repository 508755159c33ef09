// ident: the frequency response of people to ground that oscillates, measured and by the model.
//
// With U_k, Y_k the Fourier transforms of the segments k = 1 .. K,
//   S_uu = sum |U_k|^2,   S_yy = sum |Y_k|^2,   S_yu = sum Y_k conj(U_k),
//   H = S_yu / S_uu,   coherence = |S_yu|^2 / (S_uu S_yy)
// of each person, over all recordings of that person; then the mean of log |H| and of the phase
// over people, with its standard error: from people to people, or of one person by the coherence.
// The model's is in closed form (problem/linear_loop.h), averaged over the same people.
// Input: of the ground's shift (m) and tilt (rad), in both planes, what accelerates a person most;
// it repeats itself, and segments are its periods. Output: the angle of the body in the laboratory
// (rad), and where there are force platforms the ankles' torque (N m; ground.h; less that at rest):
//   about theta  tau = -F_z (p_x - x) - h F_x,   about phi  tau = F_z (p_y - y) + h F_y
// Source: Bendat and Piersol, Random Data, 2010, section 9.2.4: the random error of log |H| and of
// the phase is sqrt((1 - c) / (2 c K)).
#pragma once

#include <Eigen/Core>
#include <complex>
#include <string>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/figures/text_table.h"
#include "ident/model/identified_model.h"
#include "ident/problem/linear_loop.h"

namespace pushid {

struct Segmenting {
  int frames = 0, first = 0, step = 0;  // length, begin of the first, distance to the next
};

// The shortest period, at most half of the series, after which it repeats itself to 2 % of its
// standard deviation (its first tenth is left out), in frames; 0: none.
int PeriodOf(const std::vector<double>& series);
// The periods of the input without the first one, in which the answer is not yet periodic; of two
// periods half of the first is left out. frames 0: the input does not repeat itself.
Segmenting SegmentsOf(const std::vector<double>& input);

struct CrossSpectra {
  double step_hz = 0.0;   // between bins
  double averages = 0.0;  // K; where segments overlap, of those that do not
  Eigen::ArrayXd uu, yy;  // by bin, from 0 Hz on
  Eigen::ArrayXcd yu;

  // Adds the bins that both have; the other's segments must last as long.
  void Add(const CrossSpectra& other);
  std::complex<double> Response(int bin) const { return yu[bin] / uu[bin]; }
  double Coherence(int bin) const;
  // Bins where the input has at least 1e-4 of its largest power, which only lines have, and whose
  // coherence is at least 0.3 and beyond what two independent series have in one of 20 cases.
  std::vector<int> CoherentBins() const;
};

CrossSpectra CrossSpectraOf(const std::vector<double>& input, const std::vector<double>& output,
                            const Segmenting& segments, double dt);

enum class LoopOutput { kAngle, kTorque };

// Gains in the output's unit over the input's; phases in rad, negative where the output is late.
struct FrequencyBin {
  double hz = 0.0;
  int people = 0;
  double coherence = 0.0;                       // of the summed spectra
  double log_gain = 0.0, log_gain_error = 0.0;  // natural logarithm
  double phase = 0.0, phase_error = 0.0;
  double model_log_gain = 0.0, model_phase = 0.0;  // FrequencyResponse::has_model
};

// A kind of disturbance in one plane, and one output.
struct FrequencyResponse {
  Disturbance input = Disturbance::kGroundShift;
  int plane = 0;  // 0: x and theta, 1: y and phi
  LoopOutput output = LoopOutput::kAngle;
  int recordings = 0;
  double segment_s = 0.0;
  std::vector<std::string> people;
  std::vector<FrequencyBin> bins;
  bool has_model = false;  // it has a closed form

  std::string InputUnit() const;   // "m", "rad"
  std::string OutputUnit() const;  // "rad", "N m"
  std::string Name() const;        // "theta by the ground's shift along x"
  std::string Key() const;         // "angle_theta_by_ground_shift"
};

// recordings: as the files have them; those of less than 10 s, or without an input that goes on
// and repeats itself, have none. parameters: [recording][person]; else each person's own.
std::vector<FrequencyResponse> FrequencyResponses(const IdentifiedModel& model,
                                                  const std::vector<PendulumRecording>& recordings);
std::vector<FrequencyResponse> FrequencyResponses(
    const std::vector<PendulumRecording>& recordings, const ModelOptions& options,
    const std::vector<std::vector<ParameterSet<double>>>& parameters);

// A row for each bin; gain_lower and gain_upper: one standard error.
TextTable FrequencyTable(const std::vector<FrequencyResponse>& responses);

}  // namespace pushid
