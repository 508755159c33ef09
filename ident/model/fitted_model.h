// ident: a fit with everything that was found out about it, as data: what a model's file holds
// (model_json.h), and what reports are a function of.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ident/diagnostics/diagnostics.h"
#include "ident/model/identified_model.h"
#include "ident/parameters/presets.h"
#include "ident/problem/parallel.h"
#include "ident/solver/solution.h"
#include "ident/uncertainty/bootstrap.h"
#include "ident/uncertainty/contrast.h"
#include "ident/uncertainty/model_verdict.h"
#include "ident/uncertainty/profile.h"
#include "ident/uncertainty/uncertainty.h"

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

struct FitResult : ModelFacts {
  FitOptions options;
  std::vector<Estimate> estimates;   // one per Parameter that the table shows, fixed ones included
  std::vector<Estimate> nuisance;    // units' deviations and initial velocities
  std::vector<Combination> derived;  // c_x, c_y and per-mass gains
  std::map<std::string, SubjectParameters> subjects;
  // Value of each pooled parameter in each setting or condition, where these differ.
  std::map<std::string, std::map<std::string, Estimate>> settings;
  std::optional<Contrast> contrast;           // none where --contrast did not ask for one
  std::optional<PushedFeet> feet;             // none where no feet were recorded
  std::optional<LikelihoodScore> likelihood;  // of a fit by one of single steps
  Uncertainty uncertainty;
  ModelVerdict verdict;
  Diagnostics diagnostics;
  std::vector<FittedRecording> recordings;

  bool converged = false;
  double cost = 0.0;
  std::vector<SolveStart> starts;
  int best_start = -1;
  std::string message;
  Warnings warnings;
  double solve_seconds = 0.0;
  std::vector<Work> work;  // of solve and judgement

  bool ok() const { return best_start >= 0; }
  // The start with the lowest cost. Requires ok().
  const SolveStart& Best() const { return starts[best_start]; }
  SolveStart& Best() { return starts[best_start]; }
};

// Where a fit came from.
struct Provenance {
  std::string version;                               // of pushid
  std::map<std::string, std::string> configuration;  // effective flags
  std::vector<std::string> changed_flags;            // those of them that are not at their defaults
  std::string manifest, manifest_hash;
  std::string setting;          // as --setting
  std::string model_file = {};  // where it was written or read; empty: nowhere; not in the JSON
};

struct FittedModel {
  FitResult fit;
  std::vector<Profile> profiles;       // empty unless asked for (checks/model_checks.h)
  std::optional<Bootstrap> bootstrap;  // absent unless asked for
  std::vector<Advice> advice;          // report/advice.cc
  Provenance provenance;
  std::optional<HorizonCheck> horizon_check{};  // absent unless asked for
};

}  // namespace pushid
