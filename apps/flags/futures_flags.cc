// apps: drawn futures by flag.
#include "apps/flags/futures_flags.h"

#include <gflags/gflags.h>

#include <cstdio>

#include "apps/flags/command_line.h"
#include "ident/prediction/futures.h"

DEFINE_int32(
    samples, 0,
    "number of futures drawn from the model's process noise, or of --stance=steps from the "
    "spread of supports; 0: none");

namespace pushid {

void CheckDraws(const IdentifiedModel& model) {
  if (FLAGS_samples == 0) return;
  gflags::CommandLineFlagInfo observed;  // not of every program
  if (gflags::GetCommandLineFlagInfo("observed", &observed) && !observed.is_default) {
    throw Error{
        "--samples draws futures from frame 0, and --observed predicts from a later frame: leave "
        "one out"};
  }
  OrFail(CheckDrawsFrom(model));
}

int DrawnFutures() {
  CheckRange("samples", FLAGS_samples, 0, 100000);
  if (FLAGS_samples == 1) throw Error{"--samples is 1; one draw has no spread: give 2 or more"};
  return FLAGS_samples;
}

int PrintFutures(const IdentifiedModel& model, const PendulumRecording& recording, int num_frames) {
  if (FLAGS_samples == 0) return kDone;
  const Futures futures =
      OrFail(DrawFutures(model, recording, FLAGS_samples, kFuturesSeed, num_frames));
  if (futures.paths.empty()) {
    return Fail("every drawn future leaves the model's domain", kFitFailed);
  }
  std::printf("%zu drawn futures, hips at the last frame (median and central 90 %%):\n%s",
              futures.paths.size(), LastFrameText(futures).c_str());
  if (futures.failed > 0) {
    std::printf("%d more draws left the model's domain\n", futures.failed);
  }
  return kDone;
}

}  // namespace pushid
