// What the tests of ident share: synthetic recordings as pendulums, and fits that may recover the
// truth behind them.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "datasets/files/random.h"
#include "datasets/loading/pendulum_recording.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "ident/model/fitted_model.h"
#include "ident/model/identified_model.h"
#include "ident/parameters/presets.h"
#include "ident/problem/fit_problem.h"

namespace pushid {

// Damping held where the synthetic people have it, for studies of the other parameters.
inline FitOptions HoldDamping(FitOptions options) {
  ParameterSpec& spec = options.table[kKdTheta];
  spec = BaseTable()[kKdTheta];
  return options;
}

// 4 people, 6 pushes each, 70 frames: 24 recordings.
inline SyntheticOptions SmallStudy() {
  SyntheticOptions options;
  options.frames = 70;
  return options;
}

// 2 people, 3 pushes each, 45 frames: where only the machinery matters.
inline SyntheticOptions TinyStudy() {
  SyntheticOptions options;
  options.subjects = 2;
  options.recordings_per_subject = 3;
  options.frames = 45;
  options.joint_noise_m = 0.002;
  return options;
}

inline std::vector<PendulumRecording> AsPendulums(const std::vector<Recording>& recordings) {
  std::vector<PendulumRecording> pendulums;
  for (const Recording& recording : recordings) {
    pendulums.push_back(MakePendulumRecording(recording));
  }
  return pendulums;
}

inline std::vector<PendulumRecording> MakePendulums(const SyntheticOptions& options) {
  const auto made = MakeSyntheticRecordings(options);
  EXPECT_TRUE(made.ok()) << made.error().ToString();
  return AsPendulums(Recordings(made.value()));
}

// The truth behind the recordings of `study`, as if it had been fitted.
inline IdentifiedModel TruthOf(const SyntheticOptions& study,
                               ParameterTable table = MakePreset("tail").value().table) {
  IdentifiedModel model;
  model.options = study.model;
  model.parameters = study.parameters;
  model.table = std::move(table);
  return model;
}

// The tail preset as a user gets it, its fixed parameters at the truth of `study`, whose recordings
// share one condition.
inline FitOptions DefaultFit(const SyntheticOptions& study) {
  FitOptions options = MakePreset("tail").value();
  options.pool = "none";
  options.pool_by = kSubjectUnit;
  (void)PoolParameters(&options);
  options.model = study.model;
  for (ParameterSpec& spec : options.table.specs) {
    spec.tied_to.reset();  // a truth of its own
    if (!spec.free) spec.nominal = study.parameters[spec.id];
  }
  return options;
}

// Without whatever pulls a fit away from the data - priors, settling, stability, robust loss - and
// with weights that are given.
inline FitOptions UnbiasedFit(const SyntheticOptions& study) {
  FitOptions options = DefaultFit(study);
  for (ParameterSpec& spec : options.table.specs) spec.prior.reset();
  options.settling_weight = 0.0;
  options.sigmas.robust = 0.0;
  options.estimate_weights = false;
  return options;
}

// For noise-free data: on until rounding errors end it.
inline FitOptions ExactFit(const SyntheticOptions& study) {
  FitOptions options = UnbiasedFit(study);
  options.function_tolerance = 1e-30;
  options.gradient_tolerance = 1e-30;
  options.parameter_tolerance = 1e-14;
  return options;
}

// The free parameters of `options` start from the truth times a factor within [1 / 5, 5].
inline FitPoint WrongStart(const FitProblem& problem, const ParameterSet<double>& truth,
                           uint64_t seed) {
  Random random(seed);
  FitPoint point = problem.NominalPoint();
  const auto& fitted = problem.map().fitted;
  for (size_t i = 0; i < fitted.size(); ++i) {
    const double factor = std::pow(5.0, random.Uniform(-1.0, 1.0));
    point.shared[i] = ToFitted(fitted[i].transform, truth[fitted[i].parameter] * factor);
  }
  return point;
}

inline const Estimate* FindEstimate(const std::vector<Estimate>& estimates,
                                    const std::string& name) {
  for (const Estimate& estimate : estimates) {
    if (estimate.name == name) return &estimate;
  }
  return nullptr;
}

}  // namespace pushid
