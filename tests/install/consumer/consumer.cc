// Fits synthetic recordings, noise-free, with an installed pushid: the truth must come back.
#include <cmath>
#include <cstdio>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "ident/results/fit_result.h"

int main() {
  pushid::SyntheticOptions study;
  study.subjects = 2;
  study.recordings_per_subject = 3;
  const auto made = pushid::MakeSyntheticRecordings(study);
  if (!made.ok()) {
    std::fprintf(stderr, "%s\n", made.error().ToString().c_str());
    return 1;
  }
  std::vector<pushid::PendulumRecording> recordings;
  for (const pushid::Recording& recording : pushid::Recordings(made.value())) {
    recordings.push_back(pushid::MakePendulumRecording(recording, pushid::SkeletonMapping::kExact));
  }
  pushid::FitOptions options;
  options.model = study.model;
  options.table = pushid::MakePreset("tail").value().table;
  for (pushid::ParameterSpec& spec : options.table.specs) {
    spec.prior.reset();
    if (!spec.free) spec.nominal = study.parameters[spec.id];
  }
  const pushid::FitResult result = pushid::Fit(recordings, options);
  const double found = pushid::ModelOf(result).parameters[pushid::kMu],
               truth = study.parameters[pushid::kMu];
  std::printf("mu %.9g, truth %.9g\n", found, truth);
  return std::abs(found / truth - 1.0) < 1e-6 ? 0 : 1;
}
