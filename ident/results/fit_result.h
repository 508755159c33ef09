// ident: the result of a fit, as data. Everything a report or a prediction needs stands in it, and
// it serialises to JSON without loss (result_json.h).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ident/diagnostics/diagnostics.h"
#include "ident/parameters/fit_options.h"
#include "ident/problem/behaviour.h"
#include "ident/results/ensemble.h"
#include "ident/solver/solution.h"
#include "ident/uncertainty/bootstrap.h"
#include "ident/uncertainty/profile.h"
#include "ident/uncertainty/uncertainty.h"
#include "residuals/cost_functions/network_takeover.h"

namespace pushid {

struct SubjectParameters {
  double mass_kg = 0.0;
  std::map<std::string, Estimate> pooled;  // value of each pooled parameter for this subject
};

struct FittedRecording {
  std::string id;
  std::string content_hash;
  int frames = 0;
  int people = 1;
  double cost = 0.0;    // robust cost in the objective
  std::string failure;  // empty, or where its rollout left the domain
};

struct FitResult {
  FitOptions options;
  // As they act: fixed ones too. Indexed by Parameter.
  ParameterSet<double> parameters{};
  std::optional<Takeover> takeover;    // by the network, where there is one
  std::vector<EnsembleMember> others;  // of an ensemble, besides the one reported
  std::vector<Estimate> estimates;   // one per Parameter that the table shows, fixed ones included
  std::vector<Estimate> nuisance;    // units' deviations and initial velocities
  std::vector<Combination> derived;  // c_x, c_y and per-mass gains
  std::map<std::string, SubjectParameters> subjects;
  // Value of each pooled parameter in each setting, where settings differ.
  std::map<std::string, std::map<std::string, Estimate>> settings;
  Uncertainty uncertainty;
  std::vector<Profile> profiles;       // empty unless asked for
  std::optional<Bootstrap> bootstrap;  // absent unless asked for
  Diagnostics diagnostics;
  Behaviour behaviour;
  std::vector<FittedRecording> recordings;

  bool converged = false;
  double cost = 0.0;
  std::vector<SolveStart> starts;
  int best_start = -1;
  std::string message;
  std::vector<std::string> warnings;

  // Provenance.
  std::string version;
  std::map<std::string, std::string> configuration;  // effective flags
  std::vector<std::string> changed_flags;            // those of them that are not at their defaults
  std::string manifest, manifest_hash, setting;
  double solve_seconds = 0.0;

  bool ok() const { return best_start >= 0; }
};

// The model a prediction needs: options and parameters of each subject.
struct IdentifiedModel {
  std::string source;  // file, for messages
  ModelOptions options;
  SkeletonMapping mapping = SkeletonMapping::kExact;
  ParameterTable table;  // names, units and bounds, for --set
  ParameterSet<double> parameters{};
  std::vector<EnsembleMember> others;  // of an ensemble
  PoolBy pool_by = PoolBy::kSubject;
  std::map<std::string, ParameterSet<double>> by_unit;  // subject or setting; only where pooled

  // A unit the model does not know gets the shared values.
  const ParameterSet<double>& For(const std::string& unit) const {
    const auto found = by_unit.find(unit);
    return found == by_unit.end() ? parameters : found->second;
  }
};

// Fits and judges. recordings must not be empty and the table must have a free parameter.
FitResult Fit(const std::vector<PendulumRecording>& recordings, const FitOptions& options,
              const SolveProgress& progress = nullptr);

IdentifiedModel ModelOf(const FitResult& result);

// A model with some values replaced, in every member of an ensemble, for what-ifs (--set).
MaybeError SetValues(const std::string& assignments, IdentifiedModel* model);

}  // namespace pushid
