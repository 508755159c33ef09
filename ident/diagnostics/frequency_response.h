// ident: how people answer oscillations of the ground or of a push, frequency by frequency,
// measured and by the model.
//
// Inputs and outputs are those of spectra.h.
// H = S_yu / S_uu (spectra.h) of each person, over all recordings of that person; then the mean of
// log |H| and of the phase over people, with its standard error: from people to people, or of one
// person by the coherence. The model's is in closed form (problem/linear_loop.h), averaged over the
// same people.
#pragma once

#include <string>
#include <vector>

#include "ident/diagnostics/spectra.h"
#include "ident/figures/text_table.h"

namespace pushid {

// Gains in the output's unit over the input's; phases in rad, negative where the output is late.
struct FrequencyBin {
  double hz = 0.0;
  int people = 0;
  double coherence = 0.0;                       // of their spectra together
  double log_gain = 0.0, log_gain_error = 0.0;  // natural logarithm
  double phase = 0.0, phase_error = 0.0;
  double model_log_gain = 0.0, model_phase = 0.0;  // 0 without a closed form
};

struct FrequencyCurve {
  std::vector<double> hz, log_gain, phase;
};

// A kind of disturbance in one plane, and one output.
struct FrequencyResponse {
  Disturbance input = Disturbance::kGroundShift;
  LoopOutput output = LoopOutput::kAngle;
  int plane = 0;           // 0: x and theta, 1: y and phi
  bool periodic = false;   // at the frequencies of sums of sines; else by Welch
  bool by_plates = false;  // torque
  int recordings = 0;
  std::vector<std::string> people;
  double segment_s = 0.0;
  std::vector<FrequencyBin> bins;
  FrequencyCurve model;  // as dense as a line needs; empty without a closed form

  std::string InputUnit() const;   // "m", "rad", "N"
  std::string OutputUnit() const;  // "rad", "N m"
  std::string Name() const;        // "theta by ground shift along x"
  std::string Key() const;         // "angle_theta_by_ground_shift_x"
};

// recordings: as the files have them. parameters: [recording][person]. Recordings that last less
// than 10 s, and those without a continuous input, have none. People whose rollouts would not be
// linear (who step or slide far) are not told apart from others: their coherence tells.
std::vector<FrequencyResponse> FrequencyResponses(
    const std::vector<PendulumRecording>& recordings, const ModelOptions& options,
    const std::vector<std::vector<ParameterSet<double>>>& parameters);

// A row for each bin: input, output, axis, frequency_hz, gain, gain_lower, gain_upper (one standard
// error), phase_deg, phase_error_deg, coherence, people, model_gain, model_phase_deg.
TextTable FrequencyTable(const std::vector<FrequencyResponse>& responses);

}  // namespace pushid
