// ident: does what was recorded look like what the model says of such recordings?
//
// Visual predictive check (Holford 2005): percentiles over the recordings of a stratum, frame by
// frame, of how far the pushed person's hip has gone along the push, over the speed that the push
// gives (so that recordings of one stratum may be pushed differently hard). Beside each, the middle
// 90 % of the same percentile in data that the model makes: each recording with an effect and
// errors drawn (observed/recording_filter.h), from frame 0 and the push alone.
//
// Probability integral transform: the share of the model's distribution that lies below what was
// recorded, uniform where the model is right. Frames a quarter of a second apart, 0.25 s to 1 s;
// those of one recording are not independent, so the test is of the shares of five bins with a
// covariance clustered by recording (Hotelling's T^2, an F test). Rejected: one value a frame with
// Kolmogorov and Smirnov's test, which any error that lasts makes significant.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "ident/diagnostics/frequency_response.h"
#include "ident/diagnostics/sway.h"
#include "ident/prediction/prediction.h"

namespace pushid {

inline constexpr double kCheckedShares[] = {0.1, 0.5, 0.9};
inline constexpr int kNumCheckedShares = 3;

// s: displacement over the push's speed is a time.
struct CheckedFrame {
  double seconds = 0.0;
  int recordings = 0;  // that last so long
  std::array<double, kNumCheckedShares> observed{}, lower90{}, upper90{};
};

struct CheckedStratum {
  std::string name;  // "condition p", "strength weak"
  int recordings = 0;
  std::vector<CheckedFrame> frames;
  // Share of the observed percentiles that lie within their 90 %.
  double Inside() const;
};

struct UniformityTest {
  std::vector<double> values;      // each in [0, 1]
  std::array<double, 5> shares{};  // of the bins; each 0.2 where all is right
  std::array<double, 5> errors{};  // standard errors, clustered
  double f = 0.0, p = 1.0;
  int recordings = 0;
  bool Rejects() const { return p < 0.01; }
  // Neither end of the distribution holds too much: what was recorded lies nearer to what was
  // predicted than the model says of its errors. So it is of simulated recordings, whose errors are
  // noise that does not grow as those of real ones do (observed/recording_filter.h).
  bool TooWide() const { return Rejects() && std::max(shares.front(), shares.back()) < 0.2; }
};

struct VisualCheck {
  std::vector<CheckedStratum> strata;
  UniformityTest along, across;  // the push
};

// Recordings whose rollouts leave the domain are left out. Nothing where the model does not say how
// recordings differ, or of fewer than ten recordings.
VisualCheck CheckVisually(const IdentifiedModel& model,
                          const std::vector<PendulumRecording>& recordings, uint64_t seed = 1);

// values: by cluster.
UniformityTest TestUniformity(const std::vector<std::vector<double>>& values);

// An identified model beside people who stand: on ground that oscillates or under pushes that go
// on, frequency by frequency, and undisturbed.

inline constexpr int kSwayRepeats = 20;

// With each person's own parameters; none where nothing in the recordings is continuous.
std::vector<FrequencyResponse> FrequencyResponses(const IdentifiedModel& model,
                                                  const std::vector<PendulumRecording>& recordings);

// Simulated where the model has process noise; nobody without quiet recordings.
std::vector<PersonSway> SwayOfPeople(const IdentifiedModel& model,
                                     const std::vector<PendulumRecording>& recordings,
                                     int repeats = kSwayRepeats, uint64_t seed = 1);

}  // namespace pushid
