// ident: from a result to a report.
//
//   const Report report = BuildReport(model, recordings);
//   WriteFileAtomically("report.html", ToPage(report));
//
// A new section is a function, here or in one of the *_sections files, and its name in kSections of
// build_report.cc.
#pragma once

#include <string>
#include <vector>

#include "datasets/manifest/recording.h"
#include "ident/formations/formation_run.h"
#include "ident/model/fitted_model.h"
#include "ident/prediction/evaluation.h"
#include "ident/prediction/frequency_response.h"
#include "ident/prediction/futures.h"
#include "ident/prediction/propagation.h"
#include "ident/problem/parallel.h"
#include "ident/report/document.h"

namespace pushid {

// recordings: those to draw; none leaves out motion, figure and the next push to record. With all
// joints read, the figure shows skeletons too.
Report BuildReport(const FittedModel& model, const std::vector<Recording>& recordings,
                   int num_threads = 1, const JobProgress& progress = nullptr);
// The sections that need no recordings, for a terminal (--details).
std::string DetailsText(const FittedModel& model);

// A recording seen through a model: what was measured, what is predicted from the first frame and
// the push alone, with its bands and forces.
struct RecordingView {
  const Recording* recording = nullptr;  // with all joints where they were read
  FormationRun run;                      // pendulums and prediction
  PredictiveBands bands;                 // empty when the rollouts failed
  RecordingScore score;                  // empty after a failure
  std::string note;  // "not among those fitted", "its files have changed since", or a failure
};

// Data of which sections are made.
struct ReportSource {
  const FittedModel& model;
  const FitResult& fit = model.fit;
  std::vector<RecordingView> views = {};  // the recordings that are shown; may be none
  PropagationSummary propagation = {};    // through them
  std::vector<FrequencyResponse> frequency = {};
};

// The report in a few sentences, with hips of the recordings that are predicted best, in the middle
// and worst.
ReportSection LeadSection(const ReportSource& source);
// The answer to disturbances that go on, frequency by frequency.
ReportSection FrequencySection(const ReportSource& source);

}  // namespace pushid
