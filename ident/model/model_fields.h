// ident: the entries of the parts of a model's file, each list for writing and reading alike
// (parameters/json_archive.h). Units stand in the keys.
#pragma once

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

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
    row.Check(0 <= at[i] && at[i] < static_cast<int>(warnings.size()), "there is no such warning");
    warnings[at[i]].recording = recording[i];
    warnings[at[i]].of_many = of_many[i];
  });
}

// Estimates.

template <class Archive>
void Fields(Archive& a, Interval& i) {
  a("standard_error", i.standard_error);
  a.Pair("interval_95", i.lower, i.upper);
}

// Models of older versions have Student's quantile everywhere.
template <class Archive>
void QuantileField(Archive& a, double* quantile) {
  if (a.Has("quantile")) {
    a("quantile", *quantile);
  } else if (a.Has("freedom")) {
    double freedom = 1.0;
    a("freedom", freedom);
    *quantile = StudentQuantile95(freedom);
  }
}

template <class Archive>
void Fields(Archive& a, Estimate& e) {
  // Models written before shares were computed say nothing of them, nor of degrees of freedom.
  const bool shares = a.Has("shares");
  a("name", e.name);
  a("value", e.value);
  a("standard_error", e.standard_error);
  a("standard_error_naive", e.standard_error_naive);
  a.Pair("interval_95", e.lower95, e.upper95);
  if (shares) {
    a("freedom", e.freedom);
    QuantileField(a, &e.quantile);
    a.Group("shares", [&](auto& g) {
      g("data", e.shares.data);
      g("prior", e.shares.prior);
      g("settling", e.shares.settling);
    });
    a.Group("pull", [&](auto& g) {
      g("prior", e.shares.prior_pull);
      g("settling", e.shares.settling_pull);
    });
  }
  if (a.Has("total", e.total.has_value())) {
    TotalError& total = e.total ? *e.total : e.total.emplace();
    a.Group("total", [&](auto& g) {
      g("standard_error", total.error);
      g.Pair("interval_95", total.lower95, total.upper95);
    });
  }
  a.Optional("these_people", e.these);
  a("unit", e.unit);
  a("status", e.status);
}

template <class Archive>
void Fields(Archive& a, Combination& c) {
  a("name", c.name);
  a("value", c.value);
  a("standard_error", c.standard_error);
  a.Pair("interval_95", c.lower95, c.upper95);
  QuantileField(a, &c.quantile);
  a.Optional("these_people", c.these);
  a("unit", c.unit);
}

template <class Archive>
void Fields(Archive& a, NullDirection& n) {
  a("parameters", n.parameters);
  a("coefficients", n.coefficients);
  a("identified", n.identified);
  a("sentence", n.sentence);
}

template <class Archive>
void Fields(Archive& a, SettlingDemand& s) {
  a("binds", s.binds);
  a("contradicted", s.contradicted);
  if (a.Has("unmet")) a("unmet", s.unmet);
  a("rise", s.rise);
  a("free_seconds", s.free_seconds);
}

// All but the estimates, which stand at the top of the file.
template <class Archive>
void Fields(Archive& a, Uncertainty& u) {
  a.Via(
      "clustered_by", [&] { return u.clustered ? NameOf(u.clustered_by) : std::string("none"); },
      [&](const std::string& name) {
        u.clustered = name != "none";
        if (u.clustered) a("clustered_by", u.clustered_by);
      });
  if (a.Has("two_way")) a("two_way", u.two_way);
  a("clusters", u.num_clusters);
  if (a.Has("people")) {
    a("people", u.num_people);
    a("about_people_like_them", u.about_people_like_them);
  }
  a("residuals", u.num_residuals);
  if (a.Has("full_hessian")) a("full_hessian", u.full_hessian);
  a("sigma", u.sigma);
  a("freedom", u.freedom);
  a("too_few_clusters", u.too_few_clusters);
  a("condition_number", u.condition_number);
  a.Written("fitted", [&] {
    std::vector<std::string> names;
    for (const Estimate& e : u.estimates) names.push_back(e.name);
    return names;
  });
  a("covariance_fitted_scale", u.covariance);
  a("correlation", u.correlation);
  a("null_directions", u.null_directions);
  if (a.Has("held_directions")) a("held_directions", u.held_directions);
  if (a.Has("settling")) a("settling", u.settling);
}

template <class Archive>
void Fields(Archive& a, SubjectParameters& s) {
  a("mass_kg", s.mass_kg);
  a("pooled", s.pooled);
}

// The solve.

template <class Archive>
void Fields(Archive& a, SolveStage& s) {
  a("horizon", s.horizon);
  a("iterations", s.iterations);
  a("initial_cost", s.initial_cost);
  a("final_cost", s.final_cost);
  a("converged", s.converged);
}

template <class Archive>
void Fields(Archive& a, SolveStart& s) {
  a("kind", s.kind);
  a("usable", s.usable);
  a("converged", s.converged);
  a("cost", s.cost);
  a("iterations", s.iterations);
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
  a("stages", s.stages);
  a("message", s.message);
}

template <class Archive>
void Fields(Archive& a, FittedRecording& r) {
  a("id", r.id);
  a("frames", r.frames);
  if (a.Has("people")) a("people", r.people);
  a("cost", r.cost);
  a("failure", r.failure);
  a("content_hash", r.content_hash);
}

// What the model does.

template <class Archive>
void Fields(Archive& a, SettlingSimulation& s) {
  a("setting", s.setting);
  a("people", s.people);
  a("mass_kg", s.mass);
  a("impulse_Ns", s.impulse);
  a("speed_m_s", s.speed);
  a("lean_rad", s.lean);
  a("distance_m", s.distance);
  if (a.Has("advance_m")) a("advance_m", s.advance);
  if (a.Has("pushed_advance_m")) a("pushed_advance_m", s.pushed_advance);
  a("fell", s.fell);
  a("settled", s.settled);
}

template <class Archive>
void Fields(Archive& a, Behaviour& b) {
  a("settles", b.settles);
  a("self_propelling", b.self_propelling);
  a("fastest_growth_per_s", b.fastest_growth);
  a("harder_moves_farther", b.harder_moves_farther);
  a("demonstrations", b.simulations);
}

template <class Archive>
void Fields(Archive& a, PushedFeet& f) {
  a("pushed", f.seen);
  a("moved", f.moved);
  a("stepped", f.stepped);
}

template <class Archive>
void Fields(Archive& a, PushRange& p) {
  const auto range = [&a](const char* key, ValueRange& r) {
    if (a.Has(key, !r.empty())) a.Pair(key, r.lower, r.upper);
  };
  range("external_duration_s", p.external_s);
  range("net_duration_s", p.net_s);
  range("impulse_per_mass_m_s", p.impulse_per_mass);
}

template <class Archive>
void Fields(Archive& a, StepProbability& p) {
  a("intercept", p.coefficients[0]);
  a("slope_per_m", p.coefficients[1]);
  a("covariance", p.covariance);
  a("tracks", p.tracks);
  a("stepped", p.stepped);
  a("people", p.clusters);
  a.Check(p.coefficients.allFinite() && p.stepped >= 0 && p.stepped <= p.tracks,
          "step_probability has numbers that cannot be");
}

template <class Archive>
void Fields(Archive& a, EffectOfRecording& e) {
  a("id", e.id);
  a("person", e.person);
  a("condition", e.condition);
  a("effect", e.mean);
  a("error", e.error);
  a("alone", e.alone);
}

template <class Archive>
void Fields(Archive& a, RecordingEffect& e) {
  a("spread", e.spread);
  a("spread_standard_error", e.spread_error);
  a("error_scale_m", e.error_scale);
  a("explained", e.explained);
  a("blend_rate_per_s", e.blend_rate);
  a("widening_per_s2", e.widening);
  a("clusters", e.clusters);
  a("recordings", e.recordings);
  a.Check(e.spread >= 0.0 && e.error_scale > 0.0 && e.blend_rate >= 0.0 &&
              (e.widening.array() >= 0.0).all(),
          "recording_effect has numbers that cannot be");
}

template <class Archive>
void Fields(Archive& a, LikelihoodScore& s) {
  a("deviance", s.deviance);
  a("measured", s.measured);
  a("parameters", s.parameters);
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
