// ident: the entries of the parts of a model's file, each list for writing and reading alike
// (parameters/json_archive.h). Units stand in the keys.
#pragma once

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include "ident/model/estimate_fields.h"
#include "ident/model/fitted_model.h"
#include "ident/parameters/json_archive.h"

namespace pushid {

// The sentences, and beside them, under KEY_of_recordings, those that are of one recording.
template <class Archive>
void WarningFields(Archive& a, const std::string& key, Warnings& warnings) {
  a.Via(
      key.c_str(),
      [&warnings] {
        std::vector<std::string> texts;
        for (const Warning& warning : warnings) texts.push_back(warning.text);
        return texts;
      },
      [&warnings](const std::vector<std::string>& texts) {
        warnings.assign(texts.begin(), texts.end());
      });
  std::vector<int> at;
  std::vector<std::string> recording, of_many;
  for (size_t i = 0; i < warnings.size(); ++i) {
    if (warnings[i].recording.empty()) continue;
    at.push_back(static_cast<int>(i));
    recording.push_back(warnings[i].recording);
    of_many.push_back(warnings[i].of_many);
  }
  const std::string of_recordings = key + "_of_recordings";
  if (!a.Has(of_recordings.c_str(), !at.empty())) return;
  a.Rows(of_recordings.c_str(), std::tie(at, recording, of_many), [&](auto& row, size_t i) {
    row("warning", at[i]);
    row("recording", recording[i]);
    row("of_many", of_many[i]);
    if constexpr (Archive::kReads) {
      row.Check(0 <= at[i] && at[i] < static_cast<int>(warnings.size()),
                "there is no such warning");
      warnings[at[i]].recording = recording[i];
      warnings[at[i]].of_many = of_many[i];
    }
  });
}

template <class Archive>
void Fields(Archive& a, SolveStage& s) {
  PUSHID_FIELDS(a, s, horizon, iterations, initial_cost, final_cost, converged);
}

template <class Archive>
void Fields(Archive& a, SolveStart& s) {
  PUSHID_FIELDS(a, s, kind, usable, converged, cost, iterations);
  a.Via(
      "failed_rollouts", [&] { return s.failed.size(); },
      [&](size_t count) { s.failed.resize(count); });
  // One flat row: a reader knows no longer which block each number came from. A network's weights
  // stand once, in the network.
  const auto point = [&a](const char* key, FitPoint& at) {
    a.Via(
        key,
        [&at] {
          FitPoint without = at;
          without.weights.clear();
          return without.Flat();
        },
        [&at](const std::vector<double>& row) { at.shared = row; });
  };
  point("from_fitted_scale", s.from);
  point("to_fitted_scale", s.to);
  PUSHID_FIELDS(a, s, stages, message);
}

template <class Archive>
void Fields(Archive& a, Work& w) {
  a("purpose", w.purpose);
  a("jacobians", w.evaluations.jacobians);
  a("costs", w.evaluations.costs);
  a("seconds", w.seconds);
}

template <class Archive>
void Fields(Archive& a, FittedRecording& r) {
  PUSHID_FIELDS(a, r, id, frames);
  if (a.Has("people")) a("people", r.people);
  PUSHID_FIELDS(a, r, cost, failure, content_hash);
}

// What the model does.

template <class Archive>
void Fields(Archive& a, SettlingSimulation& s) {
  PUSHID_FIELDS(a, s, setting, people);
  a("mass_kg", s.mass);
  a("impulse_Ns", s.impulse);
  a("speed_m_s", s.speed);
  a("lean_rad", s.lean);
  a("distance_m", s.distance);
  if (a.Has("advance_m")) a("advance_m", s.advance);
  if (a.Has("pushed_advance_m")) a("pushed_advance_m", s.pushed_advance);
  PUSHID_FIELDS(a, s, fell, settled);
}

template <class Archive>
void Fields(Archive& a, Behaviour& b) {
  PUSHID_FIELDS(a, b, settles, self_propelling);
  a("fastest_growth_per_s", b.fastest_growth);
  a("harder_moves_farther", b.harder_moves_farther);
  a("demonstrations", b.simulations);
}

template <class Archive>
void Fields(Archive& a, PushedFeet& f) {
  a("pushed", f.seen);
  PUSHID_FIELDS(a, f, moved, stepped);
}

template <class Archive>
void Fields(Archive& a, PushRange& p) {
  const auto range = [&a](const char* key, ValueRange& r) {
    if (a.Has(key, !r.empty())) a.Pair(key, r.lower, r.upper);
  };
  range("external_duration_s", p.external_s);
  range("net_duration_s", p.net_s);
  range("impulse_per_mass_m_s", p.impulse_per_mass);
  range("direction_deg", p.direction);
}

template <class Archive>
void Fields(Archive& a, StepProbability& p) {
  a("intercept", p.coefficients[0]);
  a("slope_per_m", p.coefficients[1]);
  PUSHID_FIELDS(a, p, covariance, tracks, stepped);
  a("people", p.clusters);
  a.Check(p.coefficients.allFinite() && p.stepped >= 0 && p.stepped <= p.tracks,
          "step_probability has numbers that cannot be");
}

template <class Archive>
void Fields(Archive& a, EffectOfRecording& e) {
  PUSHID_FIELDS(a, e, id, person, condition);
  a("effect", e.mean);
  PUSHID_FIELDS(a, e, error, alone);
}

template <class Archive>
void Fields(Archive& a, RecordingEffect& e) {
  a("spread", e.spread);
  a("spread_standard_error", e.spread_error);
  a("error_scale_m", e.error_scale);
  PUSHID_FIELDS(a, e, explained, clusters, recordings);
  a.Check(e.spread >= 0.0 && e.error_scale > 0.0, "recording_effect has numbers that cannot be");
}

template <class Archive>
void Fields(Archive& a, ErrorScale& e) {
  PUSHID_FIELDS(a, e, coefficients, quantiles);
  a.Check(e.coefficients.allFinite() &&
              (e.quantiles.empty() || e.quantiles.size() == std::size(kErrorShares)) &&
              std::is_sorted(e.quantiles.begin(), e.quantiles.end()) &&
              (e.quantiles.empty() || e.quantiles.front() > 0.0),
          "an error scale has numbers that cannot be");
}

template <class Archive>
void Fields(Archive& a, ForecasterErrors& e) {
  a("seconds", e.seconds);
  for (int i = 0; i < kNumForecasters; ++i) {
    a((std::string(NameOf(static_cast<Forecaster>(i))) + "_m").c_str(), e.mean[i]);
  }
  a("stack_m", e.stack);
  a("recordings", e.recordings);
}

template <class Archive>
void Fields(Archive& a, InputNoise& n) {
  a("force_time_s", n.force_time);
  a("force_m_s2", n.force);
  a("measured_m", n.measured);
  a("measured_time_s", n.measured_time);
  a.Check(n.force_time > 0.0 && n.force > 0.0 && n.measured > 0.0 && n.measured_time > 0.0,
          "a filter of unknown forces has numbers that cannot be");
}

template <class Archive>
void Fields(Archive& a, ForecastStack& f) {
  a("input", f.noise);
  PUSHID_FIELDS(a, f, tail_strength, tail_time);
  a("likeliest_input", f.likeliest);
  a.Group("logits", [&f](auto& g) {
    for (int i = 0; i < kNumForecasters; ++i) {
      g(std::string(NameOf(static_cast<Forecaster>(i))).c_str(), f.logits[i]);
    }
  });
  a.Group("errors", [&f](auto& g) {
    constexpr const char* kAxes[] = {"along", "across", "upwards"};
    for (int i = 0; i < 3; ++i) g(kAxes[i], f.errors[i]);
  });
  PUSHID_FIELDS(a, f, scores, folds, recordings);
  a.Check(f.tail_strength > 0.0 && f.tail_time > 0.0, "forecasts have numbers that cannot be");
}

template <class Archive>
void Fields(Archive& a, LikelihoodScore& s) {
  PUSHID_FIELDS(a, s, deviance, measured, parameters);
  a.Written("aic", [&] { return s.Aic(); });
  a.Written("bic", [&] { return s.Bic(); });
}

template <class Archive>
void Fields(Archive& a, Takeover& t) {
  a("mu_N_s_m", t.mu);
  a("Kp_theta_N_m_rad", t.kp_theta);
  a("Kd_theta_N_m_s_rad", t.kd_theta);
  a("rms_force_m_s2", t.rms_force);
}

template <class Archive>
void Fields(Archive& a, ContactTakeover& t) {
  a("stiffness_N_m", t.stiffness);
  a("damping_N_s_m", t.damping);
  a("rms_force_m_s2", t.rms_force);
}

}  // namespace pushid
