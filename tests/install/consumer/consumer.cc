// Fits synthetic recordings, noise-free, with an installed pushid: the truth must come back.
#include <cmath>
#include <cstdio>
#include <vector>

#include "ident/fit.h"

int main() {
  pushid::SyntheticOptions study;
  study.subjects = 2;
  study.recordings_per_subject = 3;
  const auto made = pushid::MakeSyntheticRecordings(study);
  if (!made.ok()) {
    std::fprintf(stderr, "%s\n", made.error().ToString().c_str());
    return 1;
  }
  const std::vector<pushid::PendulumRecording> recordings = pushid::MakePendulumRecordings(
      pushid::Recordings(made.value()), pushid::SkeletonMapping::kExact);
  pushid::FitOptions options = pushid::MakePreset("tail").value();
  options.model = study.model;
  options.settling_weight = 0.0;
  options.preset_priors = false;
  pushid::FreeTerms(&options);
  for (pushid::ParameterSpec& spec : options.table.specs) {
    if (!spec.free) spec.nominal = study.parameters[spec.id];
  }
  if (const auto error = pushid::PrepareFit(recordings, &options)) {
    std::fprintf(stderr, "%s\n", error->ToString().c_str());
    return 1;
  }
  const pushid::FitResult result = pushid::Fit(recordings, options);
  const double found = pushid::ModelOf(result).parameters[pushid::kMu],
               truth = study.parameters[pushid::kMu];
  std::printf("mu %.9g, truth %.9g\n", found, truth);
  return std::abs(found / truth - 1.0) < 1e-6 ? 0 : 1;
}
