// ident: a fit's result in words and tables for a terminal: a pure function of the result.
#pragma once

#include <string>

#include "ident/crossvalidation.h"
#include "ident/fit_result.h"

namespace pushid {

// The parameter table, what is derived, what the data cannot tell apart, what the fitted person
// does after a push, warnings.
std::string ReportText(const FitResult& result);

// What is learned on top of the physics, and what it acts like; no line break at the end, and empty
// where nothing is.
std::string NetworkText(const FitResult& result);

std::string EvaluationText(const Evaluation& evaluation, bool per_recording);
// One column per summary: all recordings, one setting, one rival.
struct PropagationColumn {
  std::string name;
  const PropagationSummary* summary;
};
std::string PropagationText(const std::vector<PropagationColumn>& columns);
// Onset error, missed and false movers of one fold.
std::vector<std::string> FoldPropagationCells(const PropagationSummary& summary);
// A line per recording of several people.
std::string OnsetsText(const std::vector<RecordingScore>& scores);

std::string CrossValidationText(const std::vector<CrossValidation>& rivals);

// "0.341", "1.86e+03": four significant digits.
std::string Significant(double value, int digits = 4);

}  // namespace pushid
