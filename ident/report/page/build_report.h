// ident: from a result to a report.
//
//   const Report report = BuildReport(result, recordings, BuildReportOptions());
//   WriteFileAtomically("report.html", ToPage(report));
#pragma once

#include <vector>

#include "datasets/manifest/recording.h"
#include "ident/problem/parallel.h"
#include "ident/report/page/document.h"
#include "ident/results/fitted_model.h"

namespace pushid {

struct BuildReportOptions {
  int num_threads = 1;
  JobProgress progress;  // over recordings
};

// recordings: those to draw; none leaves out motion, figure and the next push to record. With all
// joints read, the figure shows skeletons too.
Report BuildReport(const FittedModel& model, const std::vector<Recording>& recordings,
                   const BuildReportOptions& options);

}  // namespace pushid
