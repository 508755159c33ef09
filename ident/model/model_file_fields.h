// ident: the entries of a model's file (parameters/json_archive.h), for what reads and writes it.
#pragma once

#include <nlohmann/json.hpp>

#include "ident/model/confidence_fields.h"
#include "ident/model/model_fields.h"
#include "ident/model/model_json.h"
#include "ident/parameters/fit_options.h"
#include "ident/parameters/learned_terms_io.h"

namespace pushid {

inline nlohmann::ordered_json ValuesJson(const ParameterTable& table,
                                         const ParameterSet<double>& set) {
  nlohmann::ordered_json values = nlohmann::ordered_json::object();
  for (const ParameterSpec& spec : table.specs) values[spec.name] = set[spec.id];
  return values;
}

// The file from top to bottom. Entries that are only written are read by ModelReader first: the
// others are of a model whose options and parameters are known.
template <class Archive>
void ModelFields(Archive& a, FittedModel& model, const RunInfo& run) {
  FitResult& fit = model.fit;
  Provenance& from = model.provenance;
  const ModelOptions& options = fit.options.model;
  a("version", from.version);
  a.Written("model", [&] { return OptionsJson(fit.options); });
  a("parameters", fit.estimates);
  PUSHID_FIELDS(a, fit, derived, nuisance, subjects, settings);
  a.Written("values", [&] { return ValuesJson(fit.options.table, fit.parameters); });
  PUSHID_FIELDS(a, fit, behaviour, uncertainty);
  if (a.Has("verdict")) a("verdict", fit.verdict);
  if (a.Has("diagnostics")) {
    a.Group("diagnostics", [&](auto& g) {
      Fields(g, fit.diagnostics);
      g("advice", model.advice);
    });
  }
  WarningFields(a, "warnings", fit.warnings);
  a.Group("fit",
          [&](auto& g) { PUSHID_FIELDS(g, fit, converged, cost, message, best_start, starts); });
  a.Written("table", [&] { return TableJson(fit.options.table); });
  a.Group("data", [&](auto& g) {
    PUSHID_FIELDS(g, from, manifest_hash, setting);
    g("recordings", fit.recordings);
  });
  a("configuration", from.configuration);
  if (a.Has("changed_flags")) a("changed_flags", from.changed_flags);
  a.Group("run", [&](auto& g) {
    g.Written("date", [&] { return run.date; });
    g.Written("host", [&] { return run.host; });
    g("manifest", from.manifest);
    g.Written("model_out", [&] { return run.model_path; });
    g("solve_seconds", fit.solve_seconds);
    if (g.Has("work")) g("work", fit.work);
    g.Written("total_seconds", [&] { return run.total_seconds; });
    g.Written("num_threads", [&] { return run.num_threads; });
  });
  a.Optional("contrast", fit.contrast);
  a.Optional("feet", fit.feet);
  a.Optional("push_range", fit.push_range);
  a.Optional("step_probability", fit.step_probability);
  a.Optional("likelihood", fit.likelihood);
  a.Optional("recording_effect", fit.recording_effect);
  a.Optional("forecasts", fit.forecasts);
  if (a.Has("self_network", options.learned != nullptr)) {
    a.Written("self_network", [&] { return ToJson(*options.learned); });
  }
  a.Optional("network_takeover", fit.takeover);
  a.Optional("contact_takeover", fit.contact_takeover);
  if (const auto laws = LawNames(options); a.Has("force_laws", !laws.empty())) {
    a.Written("force_laws", [&] { return laws; });
  }
  if (a.Has("profiles", !model.profiles.empty())) a("profiles", model.profiles);
  a.Optional("bootstrap", model.bootstrap);
  a.Optional("horizon_check", model.horizon_check);
}

}  // namespace pushid
