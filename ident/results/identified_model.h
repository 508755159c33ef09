// ident: what a prediction needs of a fit.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "ident/results/fit_result.h"

namespace pushid {

// The model a prediction needs: options and parameters of each subject.
struct IdentifiedModel {
  std::string source;  // file, for messages
  ModelOptions options;
  SkeletonMapping mapping = SkeletonMapping::kExact;
  ParameterTable table;  // names, units and bounds, for --set
  ParameterSet<double> parameters{};
  std::vector<EnsembleMember> others;  // of an ensemble
  std::string pool_by = kSubjectUnit;
  std::map<std::string, ParameterSet<double>> by_unit;  // options' pool_by; only where pooled
  std::optional<PushRange> push_range;                  // that it was fitted to
  std::optional<StepProbability> step_probability;      // of the people it was fitted to
  std::optional<RecordingEffect> recording_effect;      // for what first frames tell

  // A unit the model does not know gets the shared values.
  const ParameterSet<double>& For(const std::string& unit) const {
    const auto found = by_unit.find(unit);
    return found == by_unit.end() ? parameters : found->second;
  }
};

IdentifiedModel ModelOf(const FitResult& result);

// A model with some values replaced, in every member of an ensemble, for what-ifs (--set).
MaybeError SetValues(const std::string& assignments, IdentifiedModel* model);

}  // namespace pushid
