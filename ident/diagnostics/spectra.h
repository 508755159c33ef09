// ident: cross spectra of two series, from segment to segment: what a frequency response and its
// coherence are made of.
//
// With U_k, Y_k the Fourier transforms of the segments k = 1 .. K,
//   S_uu = sum |U_k|^2,   S_yy = sum |Y_k|^2,   S_yu = sum Y_k conj(U_k),
//   H = S_yu / S_uu,   coherence = |S_yu|^2 / (S_uu S_yy)
// An input that repeats itself is cut into its periods, which need no window; anything else into
// segments with Hann's window that overlap by half, less their means. Sums add up over recordings.
// Sources: Welch, IEEE Trans. Audio Electroacoust. 1967; Bendat and Piersol, Random Data, 2010,
// section 9.2.4: the random error of log |H| and of the phase is sqrt((1 - c) / (2 c K)).
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/problem/linear_loop.h"

namespace pushid {

struct Segmenting {
  int frames = 0;  // of a segment
  int first = 0;   // frame at which the first begins
  int step = 0;    // frames from one to the next
  bool periodic = false;
};

// The shortest period, at most half of the series, after which it repeats itself to 2 % of its
// standard deviation (root mean square; its first tenth is left out), in frames; 0: none.
int PeriodOf(const std::vector<double>& series);

// By the input: its periods, the first of them left out (the answer to it is not yet periodic), of
// two half of it; else nine segments that overlap by half, of 4 to 30 s. frames 0: too short.
Segmenting SegmentsOf(const std::vector<double>& input, double dt);

struct CrossSpectra {
  double step_hz = 0.0;        // between bins
  double averages = 0.0;       // K; where segments overlap, of those as good as independent
  std::vector<double> uu, yy;  // by bin, from 0 Hz on
  std::vector<std::complex<double>> yu;

  // Of as many bins as both have; the other's segments must last as long.
  void Add(const CrossSpectra& other);
  std::complex<double> Response(int bin) const { return yu[bin] / uu[bin]; }
  double Coherence(int bin) const;
  // Standard error of log |H|, and of its phase in rad.
  double RelativeError(int bin) const;
};

// Both series of equal length.
CrossSpectra CrossSpectraOf(const std::vector<double>& input, const std::vector<double>& output,
                            const Segmenting& segments, double dt);

// Bins that say something: where the input has at least 1e-6 of its largest power
// (periodic: 1e-4, so that those between its lines are left out), and the
// coherence is 0.3 and beyond what two independent series have in one of 20 cases.
std::vector<int> BinsWithPower(const CrossSpectra& spectra, bool periodic);
bool IsCoherent(const CrossSpectra& spectra, int bin);

// One-sided power spectral density of a series less its mean, by Welch with segments of so many
// frames (at most all): unit^2 / Hz, by bin.
std::vector<double> PowerDensity(const std::vector<double>& series, int segment, double dt);

// What moves people who stand on and on, and how they answer, as series over frames.
//
// Input u: of the ground's shift (m) or tilt (rad) and of external pushes (N), in both planes, what
// accelerates a person most. Output y: the angle of the body in the laboratory (rad), and the
// ankles' torque (N m),
//   about theta  tau = -F_z (p_x - x) - h F_x,   about phi  tau = F_z (p_y - y) + h F_y
// by platforms where these measured (ground_reaction.h; less that at rest, F_z = M g_n), else by
// inverse dynamics of the recorded motion with the model's body,
//   tau = [M (a + A) + C + (g_n / g) G - Q_push] in the angle's row.

enum class LoopOutput { kAngle, kTorque };
constexpr EnumNames<LoopOutput, 2> Names(LoopOutput) {
  return {{{"angle", LoopOutput::kAngle}, {"torque", LoopOutput::kTorque}}};
}

// What moves a person on and on: none where nothing does, as pushes of a fraction of a second.
struct ContinuousInput {
  Disturbance kind = Disturbance::kGroundShift;
  int plane = 0;
  int person = 0;              // who is pushed
  double lever = 0.0;          // m, of a force
  std::vector<double> series;  // one per frame
};
std::optional<ContinuousInput> ContinuousInputOf(const PendulumRecording& recording);

// One value per frame; where the person was not seen, that of the frame before. recording: as the
// model sees it (own_axes.h).
std::vector<double> OutputSeries(const PendulumRecording& recording, int person, int plane,
                                 LoopOutput output, const ModelOptions& options,
                                 const ParameterSet<double>& p);

}  // namespace pushid
