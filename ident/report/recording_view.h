// ident: recordings seen through a model: what was measured, what is predicted from the first frame
// and the push alone, how sure that is, and which forces do it.
#pragma once

#include <string>
#include <vector>

#include "datasets/recording.h"
#include "ident/formation_run.h"
#include "ident/parallel.h"
#include "ident/predictive_bands.h"

namespace pushid {

struct RecordingView {
  const Recording* recording = nullptr;  // with all joints where they were read
  FormationRun run;                      // pendulums and prediction
  PredictiveBands bands;                 // empty when the rollouts failed
  std::string note;  // "not among those fitted", "its files have changed since", or a failure
};

// In the order given. The recordings must outlive the views.
std::vector<RecordingView> ViewRecordings(const FitResult& result,
                                          const std::vector<Recording>& recordings, int num_threads,
                                          const JobProgress& progress = nullptr);

}  // namespace pushid
