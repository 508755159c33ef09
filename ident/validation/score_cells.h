// ident: cells that the tables of evaluations and cross-validations share.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "ident/figures/text_table.h"
#include "ident/validation/scores_report.h"

namespace pushid {

// A cell for each metric.
std::vector<std::string> MeanCells(const MeanScore& mean, const ShownMetrics& shown);

// The same without errors; "-" where there is no score.
std::vector<std::string> PlainCells(const HipMetrics& metrics, const ShownMetrics& shown,
                                    bool known = true);

std::vector<std::string> Titles(const ShownMetrics& shown);

std::vector<std::string> MetricNames(const ShownMetrics& shown);

// "a / b"
std::string Together(const std::vector<std::string>& cells);

std::string MeanText(const MeanScore& mean, const ShownMetrics& shown);

void Append(const std::vector<std::string>& cells, std::vector<std::string>* row);

// Over what the errors of a summary's means are. A row of one person's recordings has no other
// people to be clustered by.
std::string ErrorsText(const ScoreSummary& summary);

// Text stands to the left in the first column and in those from `text_from` on.
TextTable TableOf(const std::vector<std::string>& header, size_t text_from);

// "the first 12 frames were seen; 90 % bands hold 0.93 +- 0.03 (x) and 0.91 +- 0.05 (y) of ..."
std::string ObservedText(const ScoreSummary& summary);

// A row for each group of a label that tells recordings apart, a column for each summary.
void AddGroups(const std::vector<const ScoreSummary*>& summaries, const ShownMetrics& shown,
               TextTable* table);

}  // namespace pushid
