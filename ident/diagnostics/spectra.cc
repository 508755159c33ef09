// ident: segments and their Fourier transforms (Eigen's).
#include "ident/diagnostics/spectra.h"

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/FFT>

namespace pushid {
namespace {

constexpr double kRepeats = 0.02, kAway = 0.5;      // of the standard deviation
constexpr double kSegments = 9.0;                   // that overlap by half
constexpr double kShortest = 4.0, kLongest = 30.0;  // s
// Overlapping by half under Hann's window, segments are as good as so many independent ones.
constexpr double kOverlapWorth = 9.0 / 11.0;
constexpr double kLeastPower = 1e-6, kLeastLine = 1e-4, kLeastCoherence = 0.3, kChance = 0.05;

double MeanOf(const std::vector<double>& x, int first, int frames) {
  double sum = 0.0;
  for (int t = first; t < first + frames; ++t) sum += x[t];
  return sum / frames;
}

std::vector<double> HannWindow(int frames) {
  std::vector<double> window(frames);
  for (int t = 0; t < frames; ++t) window[t] = 0.5 - 0.5 * std::cos(2.0 * M_PI * t / frames);
  return window;
}

// Bins from 0 Hz to half the rate.
std::vector<std::complex<double>> Transformed(const std::vector<double>& x, int first, int frames,
                                              const std::vector<double>& window) {
  const double mean = MeanOf(x, first, frames);
  std::vector<double> segment(frames);
  for (int t = 0; t < frames; ++t) {
    segment[t] = (x[first + t] - mean) * (window.empty() ? 1.0 : window[t]);
  }
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> bins;
  fft.fwd(bins, segment);
  bins.resize(frames / 2 + 1);
  return bins;
}

}  // namespace

int PeriodOf(const std::vector<double>& series) {
  const int frames = static_cast<int>(series.size()), first = frames / 10;
  if (frames < 8) return 0;
  const double mean = MeanOf(series, first, frames - first);
  double variance = 0.0;
  for (int t = first; t < frames; ++t) variance += (series[t] - mean) * (series[t] - mean);
  variance /= frames - first;
  if (!(variance > 0.0)) return 0;
  // A slow series repeats itself after a frame or two as well: it has to go away before.
  bool went_away = false;
  int best = 0;
  double least = kRepeats * kRepeats * variance;
  for (int period = 2; period <= frames / 2; ++period) {
    const int compared = frames - first - period;  // three tenths of the series at least
    const double far = kAway * kAway * variance * compared;
    double sum = 0.0;
    for (int t = frames - 1; t - period >= first && sum <= far; --t) {
      sum += (series[t] - series[t - period]) * (series[t] - series[t - period]);
    }
    went_away = went_away || sum > far;
    if (!went_away) continue;
    const double apart = sum / compared;
    if (best > 0 && apart >= least) return best;
    if (apart < least) best = period, least = apart;
  }
  return best;
}

Segmenting SegmentsOf(const std::vector<double>& input, double dt) {
  const int frames = static_cast<int>(input.size());
  Segmenting segments;
  if (const int period = PeriodOf(input); period > 0) {
    // What is left out of the beginning, where the answer is not yet periodic.
    const bool twice = frames / period == 2;
    const int used = twice ? period + period / 2 : (frames / period - 1) * period;
    segments = {period, frames - used, twice ? period / 2 : period, true};
    return segments;
  }
  const double seconds = std::clamp(2.0 * frames * dt / (kSegments + 1.0), kShortest, kLongest);
  segments.frames = static_cast<int>(std::lround(seconds / dt));
  segments.step = segments.frames / 2;
  if (frames < 2 * segments.frames) segments.frames = 0;  // three segments
  return segments;
}

void CrossSpectra::Add(const CrossSpectra& other) {
  if (uu.empty()) {
    *this = other;
    return;
  }
  const size_t bins = std::min(uu.size(), other.uu.size());
  uu.resize(bins), yy.resize(bins), yu.resize(bins);
  for (size_t i = 0; i < bins; ++i) {
    uu[i] += other.uu[i];
    yy[i] += other.yy[i];
    yu[i] += other.yu[i];
  }
  averages += other.averages;
}

double CrossSpectra::Coherence(int bin) const {
  const double power = uu[bin] * yy[bin];
  return power > 0.0 ? std::norm(yu[bin]) / power : 0.0;
}

double CrossSpectra::RelativeError(int bin) const {
  const double coherence = Coherence(bin);
  return coherence > 0.0 ? std::sqrt((1.0 - coherence) / (2.0 * coherence * averages)) : INFINITY;
}

CrossSpectra CrossSpectraOf(const std::vector<double>& input, const std::vector<double>& output,
                            const Segmenting& segments, double dt) {
  CrossSpectra spectra;
  const int frames = segments.frames;
  if (frames < 2) return spectra;
  const std::vector<double> window = segments.periodic ? std::vector<double>() : HannWindow(frames);
  const size_t bins = frames / 2 + 1;
  spectra.step_hz = 1.0 / (frames * dt);
  spectra.uu.assign(bins, 0.0), spectra.yy.assign(bins, 0.0), spectra.yu.assign(bins, 0.0);
  int count = 0;
  const int end = static_cast<int>(std::min(input.size(), output.size()));
  for (int first = segments.first; first + frames <= end; first += segments.step, ++count) {
    const auto u = Transformed(input, first, frames, window);
    const auto y = Transformed(output, first, frames, window);
    for (size_t i = 0; i < bins; ++i) {
      spectra.uu[i] += std::norm(u[i]);
      spectra.yy[i] += std::norm(y[i]);
      spectra.yu[i] += y[i] * std::conj(u[i]);
    }
  }
  const double periods = 1.0 + (count - 1.0) * segments.step / frames;
  spectra.averages = segments.periodic ? periods : count < 2 ? count : kOverlapWorth * count;
  return spectra;
}

std::vector<int> BinsWithPower(const CrossSpectra& spectra, bool periodic) {
  const double least = periodic ? kLeastLine : kLeastPower;
  std::vector<int> bins;
  double most = 0.0;
  for (size_t i = 1; i < spectra.uu.size(); ++i) most = std::max(most, spectra.uu[i]);
  for (size_t i = 1; i < spectra.uu.size(); ++i) {
    if (spectra.uu[i] > least * most) bins.push_back(static_cast<int>(i));
  }
  return bins;
}

bool IsCoherent(const CrossSpectra& spectra, int bin) {
  if (spectra.averages <= 1.0) return false;  // of a single segment it is 1, whatever it holds
  const double by_chance = 1.0 - std::pow(kChance, 1.0 / (spectra.averages - 1.0));
  return spectra.Coherence(bin) > std::max(kLeastCoherence, by_chance);
}

std::vector<double> PowerDensity(const std::vector<double>& series, int segment, double dt) {
  const int frames = std::min(segment, static_cast<int>(series.size()));
  if (frames < 4) return {};
  const std::vector<double> window = HannWindow(frames);
  double weight = 0.0;
  for (double w : window) weight += w * w;
  std::vector<double> density(frames / 2 + 1, 0.0);
  int count = 0;
  for (int first = 0; first + frames <= static_cast<int>(series.size()); first += frames / 2) {
    const auto x = Transformed(series, first, frames, window);
    for (size_t i = 0; i < density.size(); ++i) density[i] += 2.0 * dt / weight * std::norm(x[i]);
    ++count;
  }
  for (double& value : density) value /= count;
  density[0] *= 0.5;
  if (frames % 2 == 0) density.back() *= 0.5;
  return density;
}

}  // namespace pushid
