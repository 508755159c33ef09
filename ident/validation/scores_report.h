// ident: evaluations, cross-validations and propagation as text and tables for a terminal.
#pragma once

#include <string>
#include <vector>

#include "ident/figures/screen.h"
#include "ident/figures/text_table.h"
#include "ident/validation/crossvalidation.h"

namespace pushid {

// The means beside the baselines', by strength or, without any, by the first label.
Screen EvaluationScreen(const Evaluation& evaluation);
std::string EvaluationText(const Evaluation& evaluation, bool per_recording);
// One column per summary: all recordings, one setting, one candidate.
struct PropagationColumn {
  std::string name;
  const PropagationSummary* summary;
};
TextTable PropagationTable(const std::vector<PropagationColumn>& columns);
std::string PropagationText(const std::vector<PropagationColumn>& columns);
// "3.2 +- 0.3", "-" where nothing is known, "undefined" where all begin at once.
std::string SpeedText(const PropagationMean& slowness);
// A sentence about how pushes travel through groups, measured and predicted; empty without any.
std::string TravelText(const PropagationSummary& propagation);
// Onset error, missed and false movers of one fold.
std::vector<std::string> FoldPropagationCells(const PropagationSummary& summary);

// The predictors, and whether the first differs from the best of the others.
Screen CrossValidationScreen(const std::vector<CrossValidation>& candidates);
std::string CrossValidationText(const std::vector<CrossValidation>& candidates);

}  // namespace pushid
