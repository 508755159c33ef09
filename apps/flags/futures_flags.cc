// apps: drawn futures by flag.
#include "apps/flags/futures_flags.h"

#include <gflags/gflags.h>

#include <cstdio>

#include "apps/flags/command_line.h"
#include "ident/prediction/futures.h"

DEFINE_int32(
    samples, pushid::FuturesFlags{}.samples,
    "number of futures drawn from the model's process noise, or of --stance=steps from the "
    "spread of supports; 0: none");
DEFINE_string(samples_out, "",
              "with --samples: write every future here (CSV: draw, frame, person, hip, angles)");

namespace pushid {

void CheckDraws(const FuturesFlags& flags, const IdentifiedModel& model) {
  if (flags.samples == 0) return;
  gflags::CommandLineFlagInfo observed;  // not of every program
  if (gflags::GetCommandLineFlagInfo("observed", &observed) && !observed.is_default) {
    throw Error{
        "--samples draws futures from frame 0, and --observed predicts from a later frame: leave "
        "one out"};
  }
  OrFail(CheckDrawsFrom(model));
}

FuturesFlags FuturesFlagsFromCommandLine(bool writes) {
  CheckRange("samples", FLAGS_samples, 0, 100000);
  if (FLAGS_samples == 1) throw Error{"--samples is 1; one draw has no spread: give 2 or more"};
  CheckNeeds({"samples_out"}, {"samples"}, ", the number of futures");
  if (!writes && Given("samples_out")) {
    throw Error{
        "--samples_out is for pushid-predict and pushid-formation; this program only scores "
        "futures"};
  }
  OrFail(CheckOutputFiles({FLAGS_samples_out}));
  return FuturesFlags{FLAGS_samples, FLAGS_samples_out};
}

int PrintFutures(const FuturesFlags& flags, const IdentifiedModel& model,
                 const PendulumRecording& recording, int num_frames) {
  if (flags.samples == 0) return kDone;
  const Futures futures =
      OrFail(DrawFutures(model, recording, flags.samples, kFuturesSeed, num_frames));
  if (futures.paths.empty()) {
    std::fprintf(stderr, "every drawn future leaves the model's domain\n");
    return kFitFailed;
  }
  std::printf("%zu drawn futures, hips at the last frame (median and central 90 %%):\n%s",
              futures.paths.size(), LastFrameText(futures).c_str());
  if (futures.failed > 0) {
    std::printf("%d more draws left the model's domain\n", futures.failed);
  }
  if (flags.out.empty()) return kDone;
  OrFail(WriteFuturesCsv(flags.out, futures));
  std::printf("all futures written to %s\n", flags.out.c_str());
  return kDone;
}

}  // namespace pushid
