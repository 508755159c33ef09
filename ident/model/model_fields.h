// ident: the entries of a model's file and of its parts, each list for writing and reading alike
// (parameters/json_archive.h). Units stand in the keys.
#pragma once

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include "ident/model/model_json.h"
#include "ident/parameters/json_archive.h"

namespace pushid {

inline void Fields(JsonArchive& a, Interval& i) {
  a("standard_error", i.standard_error);
  a.Pair("interval_95", i.lower, i.upper);
}

// The interval that decides; the others beside it are what it is made of.
inline void WriteInterval(JsonArchive& a, const Interval& i) {
  a.Written("interval", [&i] { return std::vector<double>{i.lower, i.upper}; });
}

inline void Fields(JsonArchive& a, Estimate& e) {
  PUSHID_FIELDS(a, e, name, value);
  WriteInterval(a, e.interval());
  PUSHID_FIELDS(a, e, standard_error, standard_error_naive);
  a.Pair("interval_95", e.lower95, e.upper95);
  PUSHID_FIELDS(a, e, freedom, quantile);
  a.Group("shares", [&](auto& g) { PUSHID_FIELDS(g, e.shares, data, prior, settling); });
  a.Group("pull",
          [&](auto& g) { g("prior", e.shares.prior_pull, "settling", e.shares.settling_pull); });
  a.Optional("total", e.total);
  a.Optional("these_people", e.these);
  PUSHID_FIELDS(a, e, unit, status);
}

inline void Fields(JsonArchive& a, Combination& c) {
  PUSHID_FIELDS(a, c, name, value);
  WriteInterval(a, c.interval());
  a("standard_error", c.standard_error);
  a.Pair("interval_95", c.lower95, c.upper95);
  a("quantile", c.quantile);
  a.Optional("total", c.total);
  a.Optional("these_people", c.these);
  a("unit", c.unit);
}

inline void Fields(JsonArchive& a, ContrastRow& r) {
  PUSHID_FIELDS(a, r, name, first, second, difference);
  a.Pair("interval_95", r.lower95, r.upper95);
  PUSHID_FIELDS(a, r, p, p_holm);
  a.Optional("effect", r.effect);
  PUSHID_FIELDS(a, r, unit, status);
}

inline void Fields(JsonArchive& a, Contrast& c) {
  PUSHID_FIELDS(a, c, label, first, second);
  a("people_first", c.only_first, "people_second", c.only_second, "people_both", c.both);
  a("rows", c.rows);
}

PUSHID_FIELDS_OF(NullDirection, parameters, coefficients, identified, sentence)

PUSHID_FIELDS_OF(SettlingDemand, binds, contradicted, unmet, rise, free_seconds)

// All but the estimates, which stand at the top of the file.
inline void Fields(JsonArchive& a, Uncertainty& u) {
  a.Via(
      "clustered_by", [&] { return u.clustered ? NameOf(u.clustered_by) : std::string("none"); },
      [&](const std::string& name) {
        u.clustered = name != "none";
        if (u.clustered) a("clustered_by", u.clustered_by);
      });
  a("two_way", u.two_way, "clusters", u.num_clusters, "people", u.num_people,
    "about_people_like_them", u.about_people_like_them, "residuals", u.num_residuals);
  PUSHID_FIELDS(a, u, full_hessian, sigma, freedom, too_few_clusters, condition_number);
  a.Written("fitted", [&] {
    std::vector<std::string> names;
    for (const Estimate& e : u.estimates) names.push_back(e.name);
    return names;
  });
  a("covariance_fitted_scale", u.covariance);
  PUSHID_FIELDS(a, u, correlation, null_directions, held_directions, settling);
}

PUSHID_FIELDS_OF(SubjectParameters, mass_kg, pooled)

// The solve.

// A warning that is of one recording.
struct RecordingsWarning {
  int warning = 0;  // its place in the list
  std::string recording, of_many;
};
PUSHID_FIELDS_OF(RecordingsWarning, warning, recording, of_many)

// The sentences, and beside them, under KEY_of_recordings, those that are of one recording.
inline void WarningFields(JsonArchive& a, const std::string& key, Warnings& warnings) {
  std::vector<std::string> texts;
  std::vector<RecordingsWarning> of_recordings;
  for (const Warning& w : warnings) {
    const int at = static_cast<int>(texts.size());
    if (!w.recording.empty()) of_recordings.push_back({at, w.recording, w.of_many});
    texts.push_back(w.text);
  }
  a(key.c_str(), texts);
  a.Filled((key + "_of_recordings").c_str(), of_recordings);
  if (!a.reads()) return;
  warnings.assign(texts.begin(), texts.end());
  for (const auto& [at, recording, of_many] : of_recordings) {
    a.Check(0 <= at && at < static_cast<int>(warnings.size()), "there is no such warning");
    warnings[at].recording = recording;
    warnings[at].of_many = of_many;
  }
}

PUSHID_FIELDS_OF(SolveStage, horizon, iterations, initial_cost, final_cost, converged)

inline void Fields(JsonArchive& a, SolveStart& s) {
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

inline void Fields(JsonArchive& a, Work& w) {
  a("purpose", w.purpose, "jacobians", w.evaluations.jacobians, "costs", w.evaluations.costs,
    "seconds", w.seconds);
}

PUSHID_FIELDS_OF(FittedRecording, id, frames, people, cost, failure, content_hash)

// Behaviour and range of the model.

inline void Fields(JsonArchive& a, SettlingSimulation& s) {
  PUSHID_FIELDS(a, s, setting, people);
  a("mass_kg", s.mass, "impulse_Ns", s.impulse, "speed_m_s", s.speed, "lean_rad", s.lean,
    "distance_m", s.distance, "advance_m", s.advance, "pushed_advance_m", s.pushed_advance);
  PUSHID_FIELDS(a, s, fell, settled);
}

inline void Fields(JsonArchive& a, Behaviour& b) {
  PUSHID_FIELDS(a, b, settles, self_propelling);
  a("fastest_growth_per_s", b.fastest_growth, "harder_moves_farther", b.harder_moves_farther,
    "demonstrations", b.simulations);
}

inline void Fields(JsonArchive& a, PushedFeet& f) {
  a("pushed", f.seen);
  PUSHID_FIELDS(a, f, moved, stepped);
}

inline void Fields(JsonArchive& a, FittedPerson& p) {
  a("mass_kg", p.mass, "rod_m", p.rod, "cart_height_m", p.cart_height, "theta_rad", p.theta,
    "phi_rad", p.phi, "feet_apart_m", p.apart);
  a.Check(p.mass > 0.0 && p.rod > 0.0 && std::abs(p.theta) < kMaxAngle &&
              std::abs(p.phi) < kMaxAngle && p.apart.allFinite(),
          "a fitted person has numbers that cannot be");
}

inline void Fields(JsonArchive& a, UsualPush& p) {
  a("kind", p.kind, "duration_s", p.duration, "height_of_rod", p.height, "impulse_N_s", p.impulse);
  a.Check(p.duration > 0.0 && p.impulse > 0.0 && std::isfinite(p.height),
          "a usual push has numbers that cannot be");
}

inline void Fields(JsonArchive& a, PushRange& p) {
  const auto range = [&a](const char* key, ValueRange& r) {
    if (a.Has(key, !r.empty())) a.Pair(key, r.lower, r.upper);
  };
  range("external_duration_s", p.external_s);
  range("net_duration_s", p.net_s);
  range("impulse_per_mass_m_s", p.impulse_per_mass);
  range("direction_deg", p.direction);
  range("height_of_rod", p.height);
  range("spacing_m", p.spacing);
  a.Filled("people", p.people);
  a.Optional("usual", p.usual);
}

inline void Fields(JsonArchive& a, StepProbability& p) {
  a("intercept", p.coefficients[0], "slope_per_m", p.coefficients[1]);
  PUSHID_FIELDS(a, p, covariance, tracks, stepped);
  a("people", p.clusters);
  a.Check(p.coefficients.allFinite() && p.stepped >= 0 && p.stepped <= p.tracks,
          "step_probability has numbers that cannot be");
}

inline void Fields(JsonArchive& a, ErrorScale& e) {
  PUSHID_FIELDS(a, e, coefficients, quantiles);
  a.Check(e.coefficients.allFinite() &&
              (e.quantiles.empty() || e.quantiles.size() == std::size(kErrorShares)) &&
              std::is_sorted(e.quantiles.begin(), e.quantiles.end()) &&
              (e.quantiles.empty() || e.quantiles.front() > 0.0),
          "an error scale has numbers that cannot be");
}

inline void Fields(JsonArchive& a, ForecastRule& f) {
  a("tail", f.tail, "input_time_s", f.input_time);
  a.Group("errors", [&f](auto& g) {
    g("along", f.errors[0], "across", f.errors[1], "upwards", f.errors[2]);
  });
  PUSHID_FIELDS(a, f, folds, recordings);
  a.Check(f.tail > 0.0 && f.input_time >= 0.0, "forecasts have numbers that cannot be");
}

inline void Fields(JsonArchive& a, LikelihoodScore& s) {
  PUSHID_FIELDS(a, s, deviance, measured, parameters);
  a.Written("aic", [&] { return s.Aic(); });
  a.Written("bic", [&] { return s.Bic(); });
}

PUSHID_FIELDS_OF(Finding, kind, recording, about, value)

PUSHID_FIELDS_OF(StartDiagnostics, condition_number, null_directions, without_effect, notes,
                 findings)

PUSHID_FIELDS_OF(Outlier, frame, person, error, weight)

inline void Fields(JsonArchive& a, RecordingDiagnostics& r) {
  a("id", r.id, "explained_percent", r.explained, "moved", r.moved);
  PUSHID_FIELDS(a, r, cost, lag1, ljung_box, ljung_box_p, outliers);
}

PUSHID_FIELDS_OF(Whiteness, channel, autocorrelation, error, push, push_error, band, mean_band,
                 ljung_box, ljung_box_p)

inline void Fields(JsonArchive& a, Leverage& l) {
  PUSHID_FIELDS(a, l, recordings, parameters, units, change, in_errors);
  const auto whole = [&l](const std::vector<std::vector<double>>& rows) {
    return rows.size() == l.recordings.size() &&
           std::all_of(rows.begin(), rows.end(), [&l](const std::vector<double>& row) {
             return row.size() == l.parameters.size();
           });
  };
  a.Check(whole(l.change) && whole(l.in_errors) && l.units.size() == l.parameters.size(),
          "rows of the leverage have wrong lengths");
}

PUSHID_FIELDS_OF(TracePoint, horizon, iteration, cost, gradient)
PUSHID_FIELDS_OF(AssumptionTest, name, unit, stated, wanted, error, t, p, moves)
PUSHID_FIELDS_OF(PartTest, parameter, part, t, p)
PUSHID_FIELDS_OF(MotionTest, quantity, unit, difference, error, t, p)

inline void Fields(JsonArchive& a, ModelVerdict& v) {
  a.Written("fails", [&] { return v.fails(); });
  PUSHID_FIELDS(a, v, not_checked, freedom, p_assumptions, p_parts, p_motion, assumptions, parts);
  a("motion", v.motion.tests, "explained", v.motion.explained, "of_pushes", v.of_pushes);
  a.Filled("none_identified", v.none_identified);
}

PUSHID_FIELDS_OF(Diagnostics, start, recordings, whiteness, leverage, trace)
PUSHID_FIELDS_OF(Advice, sentence, command)
PUSHID_FIELDS_OF(ProfilePoint, value, cost, others)

inline void Fields(JsonArchive& a, Profile& p) {
  PUSHID_FIELDS(a, p, name, unit, estimate);
  a("class", p.classification);
  a.OrNull("class_by_data_alone", p.by_data_alone);
  a.Pair("interval_95", p.lower95, p.upper95);
  PUSHID_FIELDS(a, p, cost, threshold);
  a.Pair("ends", p.lower_end, p.upper_end);
  a("points", p.points);
}

inline void Fields(JsonArchive& a, Bootstrap& b) {
  PUSHID_FIELDS(a, b, replicas, seed, drawn_by, drawn_from, people_shared, failed);
  a.Rows("parameters", std::tie(b.names, b.units, b.standard_error, b.lower95, b.upper95),
         [&b](auto& row, size_t i) {
           row("name", b.names[i], "unit", b.units[i], "standard_error", b.standard_error[i]);
           row.Pair("interval_95", b.lower95[i], b.upper95[i]);
         });
  a("values", b.values);
  for (const std::vector<double>& row : b.values) {
    a.Check(row.size() == b.names.size(), "rows of different lengths");
  }
}

inline void Fields(JsonArchive& a, HorizonFit& f) {
  a("frames", f.frames, "values", f.value, "standard_errors", f.standard_error, "failure",
    f.failure);
}

inline void Fields(JsonArchive& a, HorizonCheck& c) {
  a.Rows("parameters", std::tie(c.parameters, c.units, c.value, c.standard_error),
         [&c](auto& row, size_t i) {
           row("name", c.parameters[i], "unit", c.units[i], "value", c.value[i], "standard_error",
               c.standard_error[i]);
         });
  a("refits", c.refits);
  for (const HorizonFit& fit : c.refits) {
    a.Check(fit.value.size() == fit.standard_error.size() &&
                (fit.value.empty() || fit.value.size() == c.parameters.size()),
            "refits of different lengths");
  }
}

inline nlohmann::ordered_json ValuesJson(const ParameterTable& table,
                                         const ParameterSet<double>& set) {
  nlohmann::ordered_json values = nlohmann::ordered_json::object();
  for (const ParameterSpec& spec : table.specs) values[spec.name] = set[spec.id];
  return values;
}

// The file from top to bottom. Entries that are only written are read by ReadModel first: the
// others are of a model whose options and parameters are known.
inline void ModelFields(JsonArchive& a, FittedModel& model, const RunInfo& run) {
  FitResult& fit = model.fit;
  Provenance& from = model.provenance;
  const ModelOptions& options = fit.options.model;
  a("version", from.version);
  a.Written("model", [&] { return OptionsJson(fit.options); });
  a("parameters", fit.estimates);
  PUSHID_FIELDS(a, fit, derived, nuisance, subjects, settings);
  a.Written("values", [&] { return ValuesJson(fit.options.table, fit.parameters); });
  PUSHID_FIELDS(a, fit, behaviour, uncertainty, verdict);
  a.Group("diagnostics", [&](auto& g) {
    Fields(g, fit.diagnostics);
    g("advice", model.advice);
  });
  WarningFields(a, "warnings", fit.warnings);
  a.Group("fit",
          [&](auto& g) { PUSHID_FIELDS(g, fit, converged, cost, message, best_start, starts); });
  a.Written("table", [&] { return TableJson(fit.options.table); });
  a.Group("data", [&](auto& g) {
    PUSHID_FIELDS(g, from, manifest_hash, setting);
    g("recordings", fit.recordings);
  });
  PUSHID_FIELDS(a, from, configuration, changed_flags);
  a.Group("run", [&](auto& g) {
    g.Written("date", [&] { return run.date; });
    g.Written("host", [&] { return run.host; });
    g("manifest", from.manifest);
    g.Written("model_out", [&] { return run.model_path; });
    PUSHID_FIELDS(g, fit, solve_seconds, work);
    g.Written("total_seconds", [&] { return run.total_seconds; });
    g.Written("num_threads", [&] { return run.num_threads; });
  });
  a.Optional("contrast", fit.contrast);
  a.Optional("feet", fit.feet);
  a.Optional("push_range", fit.push_range);
  a.Optional("step_probability", fit.step_probability);
  a.Optional("likelihood", fit.likelihood);
  a.Optional("forecasts", fit.forecasts);
  if (a.Has("self_network", options.learned != nullptr)) {
    a.Written("self_network", [&] { return ToJson(*options.learned); });
  }
  if (const auto laws = LawNames(options); a.Has("force_laws", !laws.empty())) {
    a.Written("force_laws", [&] { return laws; });
  }
  a.Filled("profiles", model.profiles);
  a.Optional("bootstrap", model.bootstrap);
  a.Optional("horizon_check", model.horizon_check);
}

}  // namespace pushid
