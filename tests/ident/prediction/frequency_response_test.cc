// Spectra of known series, and people whose loop is known.
#include "ident/prediction/frequency_response.h"

#include <gtest/gtest.h>

#include "tests/ident/laboratory_samples.h"

namespace pushid {
namespace {

std::vector<double> Sampled(int frames, double dt, double (*value)(double)) {
  std::vector<double> series;
  for (int t = 0; t < frames; ++t) series.push_back(value(t * dt));
  return series;
}

TEST(Spectra, PeriodsByHand) {
  EXPECT_EQ(PeriodOf(Sampled(6000, 0.01, SumOfSines)), 1000);
  EXPECT_EQ(PeriodOf(Sampled(500, 0.01, [](double s) { return std::sin(2.0 * M_PI * s); })), 100);
  EXPECT_EQ(PeriodOf(Sampled(1900, 0.01, SumOfSines)), 0);  // once
  EXPECT_EQ(PeriodOf(std::vector<double>(1000, 2.0)), 0);
  EXPECT_EQ(PeriodOf(Sampled(1000, 0.01, [](double s) { return s; })), 0);
  Random random(1);
  std::vector<double> noise;
  for (int t = 0; t < 2000; ++t) noise.push_back(random.Normal());
  EXPECT_EQ(PeriodOf(noise), 0);
}

// y is twice u, three frames late: a gain of 2 and a phase of -2 pi f 0.03 s, at the lines of u.
TEST(Spectra, ResponseOfALateSeries) {
  const double dt = 0.01;
  const std::vector<double> u = Sampled(6000, dt, SumOfSines);
  std::vector<double> y(3, 0.0);
  for (size_t t = 3; t < u.size(); ++t) y.push_back(2.0 * u[t - 3]);
  const Segmenting segments = SegmentsOf(u);
  EXPECT_EQ(segments.frames, 1000);
  EXPECT_EQ(segments.first, 1000);
  const CrossSpectra spectra = CrossSpectraOf(u, y, segments, dt);
  EXPECT_NEAR(spectra.step_hz, 0.1, 1e-12);
  EXPECT_NEAR(spectra.averages, 5.0, 1e-12);
  const std::vector<int> coherent = spectra.CoherentBins();
  ASSERT_FALSE(coherent.empty());
  for (int bin : coherent) {
    const double hz = bin * spectra.step_hz;
    EXPECT_NEAR(std::abs(spectra.Response(bin)), 2.0, 1e-6);
    EXPECT_NEAR(
        std::remainder(std::arg(spectra.Response(bin)) + 2.0 * M_PI * hz * 0.03, 2.0 * M_PI), 0.0,
        1e-6);
    EXPECT_GT(spectra.Coherence(bin), 0.99);
  }
}

// Two independent series seem coherent in one bin of 20, and in none by a single segment.
TEST(Spectra, ChanceIsNoCoherence) {
  Random random(3);
  std::vector<double> u, y;
  for (int t = 0; t < 20000; ++t) u.push_back(random.Normal()), y.push_back(random.Normal());
  EXPECT_EQ(SegmentsOf(u).frames, 0) << "it does not repeat itself";
  EXPECT_LT(CrossSpectraOf(u, y, {200, 0, 200}, 0.01).CoherentBins().size(), 11u);
  const CrossSpectra once = CrossSpectraOf(u, y, {20000, 0, 20000}, 0.01);
  EXPECT_NEAR(once.Coherence(5), 1.0, 1e-9);
  EXPECT_TRUE(once.CoherentBins().empty());
}

// 60 s on ground that oscillates: the loop's own response at the six excited frequencies.
TEST(FrequencyResponse, PeriodicGround) {
  const double dt = 0.002;
  const int frames = 30000;
  const ModelOptions options = StandingOptions(Delay::kOne);
  const ParameterSet<double> p = StandingGains(1500.0, 400.0, 0.1);
  for (int row : {0, 3}) {
    SCOPED_TRACE(row);
    Scene scene = StandingScene(dt);
    scene.ground =
        OscillatingGround(row, frames, dt, [](double s) { return 2e-3 * SumOfSines(s); });
    const PendulumRecording recording = RecordingOf(scene, options, p, frames, "A", true);
    const auto responses = FrequencyResponses({recording}, options, {{p}});
    ASSERT_EQ(responses.size(), 2u);
    for (const FrequencyResponse& response : responses) {
      SCOPED_TRACE(response.Name());
      EXPECT_EQ(response.input, row == 0 ? Disturbance::kGroundShift : Disturbance::kGroundTilt);
      EXPECT_EQ(response.plane, row == 0 ? 0 : 1);
      ASSERT_EQ(response.bins.size(), 6u);
      for (const FrequencyBin& bin : response.bins) {
        EXPECT_NEAR(bin.log_gain, bin.model_log_gain, 0.01) << bin.hz;
        EXPECT_NEAR(std::remainder(bin.phase - bin.model_phase, 2.0 * M_PI), 0.0, 1.0 / 57.3)
            << bin.hz;
        EXPECT_GT(bin.coherence, 0.999) << bin.hz;
      }
      EXPECT_NEAR(response.bins[5].hz, 1.7, 1e-9);
      EXPECT_TRUE(response.has_model);
    }
  }
}

// Ground that starts from rest within a second, and two periods of 10 s, of two people; steps of
// 10 ms are late by half of that.
TEST(FrequencyResponse, TwoPeriodsFromRest) {
  const double dt = 0.01;
  const int frames = 2001;
  const ModelOptions options = StandingOptions(Delay::kOne);
  const ParameterSet<double> p = StandingGains(1500.0, 400.0, 0.1);
  Scene scene = StandingScene(dt);
  scene.ground = OscillatingGround(0, frames, dt, [](double s) {
    const double u = std::min(s, 1.0);
    return 2e-3 * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u) * SumOfSines(s);
  });
  const auto responses = FrequencyResponses(
      {RecordingOf(scene, options, p, frames, "A"), RecordingOf(scene, options, p, frames, "B")},
      options, {{p}, {p}});
  ASSERT_EQ(responses.size(), 1u);  // no platforms
  EXPECT_NEAR(responses[0].segment_s, 10.0, 1e-9);
  for (int line : {3, 5, 9, 13, 17}) {
    const auto bin =
        std::find_if(responses[0].bins.begin(), responses[0].bins.end(),
                     [line](const FrequencyBin& b) { return std::abs(b.hz - 0.1 * line) < 1e-9; });
    ASSERT_NE(bin, responses[0].bins.end()) << line;
    EXPECT_NEAR(bin->log_gain, bin->model_log_gain, 0.05) << line;
    EXPECT_NEAR(bin->phase, bin->model_phase, 0.05) << line;
  }
}

// Two people of different gains, two recordings each: means over people, errors from one to the
// other.
TEST(FrequencyResponse, MeansOverPeople) {
  const double dt = 0.01;
  const int frames = 4000;
  const ModelOptions options = StandingOptions();
  std::vector<PendulumRecording> recordings;
  std::vector<std::vector<ParameterSet<double>>> parameters;
  for (int i = 0; i < 4; ++i) {
    const ParameterSet<double> p = StandingGains(i < 2 ? 1300.0 : 1800.0, 400.0);
    Scene scene = StandingScene(dt);
    scene.ground = OscillatingGround(0, frames, dt, [](double s) { return 2e-3 * SumOfSines(s); });
    recordings.push_back(RecordingOf(scene, options, p, frames, i < 2 ? "A" : "B"));
    parameters.push_back({p});
  }
  const auto both = FrequencyResponses(recordings, options, parameters);
  const auto of_a = FrequencyResponses({recordings[0]}, options, {parameters[0]});
  const auto of_b = FrequencyResponses({recordings[3]}, options, {parameters[3]});
  ASSERT_EQ(both.size(), 1u);
  EXPECT_EQ(both[0].people, (std::vector<std::string>{"A", "B"}));
  EXPECT_EQ(both[0].recordings, 4);
  for (size_t i = 0; i < both[0].bins.size(); ++i) {
    const FrequencyBin& bin = both[0].bins[i];
    const double a = of_a[0].bins[i].log_gain, b = of_b[0].bins[i].log_gain;
    EXPECT_EQ(bin.people, 2);
    EXPECT_NEAR(bin.log_gain, 0.5 * (a + b), 1e-9);
    EXPECT_NEAR(bin.log_gain_error, 0.5 * std::abs(a - b), 1e-9);
  }
  EXPECT_EQ(FrequencyTable(both).rows().size(), 1 + both[0].bins.size());
}

// Pushes of a fraction of a second, quiet stance and short recordings have no response.
TEST(FrequencyResponse, NothingContinuous) {
  const ModelOptions options = StandingOptions();
  const ParameterSet<double> p = StandingGains(1500.0, 400.0);
  Scene scene = StandingScene(0.01);
  scene.pushes.push_back(
      MakeScenePush(0, 10, PushKind::kExternal, HalfSinePush(Body{}, 5.0, 20, 0.01)));
  EXPECT_TRUE(
      FrequencyResponses({RecordingOf(scene, options, p, 2000, "A")}, options, {{p}}).empty());
  Scene step = StandingScene(0.01);
  step.ground = OscillatingGround(0, 2000, 0.01, [](double s) {
    const double u = std::min(std::max((s - 8.0) / 0.4, 0.0), 1.0);
    return 0.05 * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
  });
  EXPECT_TRUE(
      FrequencyResponses({RecordingOf(step, options, p, 2000, "A")}, options, {{p}}).empty());
  Scene quiet = StandingScene(0.01);
  EXPECT_TRUE(
      FrequencyResponses({RecordingOf(quiet, options, p, 2000, "A")}, options, {{p}}).empty());
  Scene brief = StandingScene(0.01);
  brief.ground = OscillatingGround(0, 800, 0.01, [](double s) { return 1e-3 * SumOfSines(s); });
  EXPECT_TRUE(
      FrequencyResponses({RecordingOf(brief, options, p, 800, "A")}, options, {{p}}).empty());
}

}  // namespace
}  // namespace pushid
