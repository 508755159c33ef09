// apps: --samples, by which programs draw futures from a model with process noise.
#pragma once

#include "apps/flags/command_line.h"
#include "ident/prediction/futures.h"

DEFINE_int32(
    samples, 0,
    "number of futures drawn from the model's process noise, or of --stance=steps from the "
    "spread of supports; 0: none");

namespace pushid {

inline constexpr std::uint64_t kFuturesSeed = 1;  // of all draws

// Throws where frames were observed, behind which no futures are drawn.
inline void CheckFromFirstFrame() {
  gflags::CommandLineFlagInfo observed;  // not of every program
  if (gflags::GetCommandLineFlagInfo("observed", &observed) && !observed.is_default) {
    throw Error{
        "--samples draws futures from frame 0, and --observed predicts from a later frame: leave "
        "one out"};
  }
}

// Throws where the model has no process noise to draw from, or frames were observed.
inline void CheckDraws(const IdentifiedModel& model) {
  if (FLAGS_samples == 0) return;
  CheckFromFirstFrame();
  OrFail(CheckDrawsFrom(model));
}

// --samples; 0: none are drawn.
inline int DrawnFutures() {
  CheckRange("samples", FLAGS_samples, 0, 100000);
  if (FLAGS_samples == 1) throw Error{"--samples is 1; one draw has no spread: give 2 or more"};
  return FLAGS_samples;
}

// Draws them and prints where everybody is at the end; nothing without --samples. num_frames: 0
// means as many as the recording has. Returns an exit code.
inline int PrintFutures(const IdentifiedModel& model, const PendulumRecording& recording,
                        int num_frames) {
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
