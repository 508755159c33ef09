// ident: evaluations, cross-validations and propagation in words and tables for a terminal.
#pragma once

#include <string>
#include <vector>

#include "ident/validation/crossvalidation.h"

namespace pushid {

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
// Onset error, missed and false movers of one fold.
std::vector<std::string> FoldPropagationCells(const PropagationSummary& summary);
// A line per recording of several people.
std::string OnsetsText(const std::vector<RecordingScore>& scores);

std::string CrossValidationText(const std::vector<CrossValidation>& candidates);

}  // namespace pushid
