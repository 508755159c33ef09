// ident: from a result to a report.
//
//   const Report report = BuildReport(result, recordings, BuildReportOptions());
//   WriteFileAtomically("report.html", ToPage(report));
#pragma once

#include <string>
#include <vector>

#include "datasets/manifest/recording.h"
#include "ident/formations/formation_run.h"
#include "ident/model/fitted_model.h"
#include "ident/prediction/predictive_bands.h"
#include "ident/prediction/propagation.h"
#include "ident/problem/parallel.h"
#include "ident/report/page/document.h"

namespace pushid {

struct BuildReportOptions {
  int num_threads = 1;
  JobProgress progress;  // over recordings
};

// recordings: those to draw; none leaves out motion, figure and the next push to record. With all
// joints read, the figure shows skeletons too.
Report BuildReport(const FittedModel& model, const std::vector<Recording>& recordings,
                   const BuildReportOptions& options);

// A recording seen through a model: what was measured, what is predicted from the first frame and
// the push alone, with its bands and forces.
struct RecordingView {
  const Recording* recording = nullptr;  // with all joints where they were read
  FormationRun run;                      // pendulums and prediction
  PredictiveBands bands;                 // empty when the rollouts failed
  std::string note;  // "not among those fitted", "its files have changed since", or a failure
};

}  // namespace pushid
