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
DEFINE_uint64(samples_seed, pushid::FuturesFlags{}.seed, "with --samples: seed of the draws");
DEFINE_string(samples_out, "",
              "with --samples: write every future here (CSV: draw, frame, person, hip, angles)");

namespace pushid {

MaybeError CheckDraws(const FuturesFlags& flags, const IdentifiedModel& model) {
  if (flags.samples == 0) return std::nullopt;
  gflags::CommandLineFlagInfo observed;  // not of every program
  if (gflags::GetCommandLineFlagInfo("observed", &observed) && !observed.is_default) {
    return Error{
        "--samples draws futures from frame 0, and --observed predicts from a later frame: leave "
        "one out"};
  }
  return CheckDrawsFrom(model);
}

Result<FuturesFlags> FuturesFlagsFromCommandLine(bool writes) {
  if (MaybeError error = CheckRange("samples", FLAGS_samples, 0, 100000)) return *error;
  if (FLAGS_samples == 1) return Error{"--samples is 1; one draw has no spread: give 2 or more"};
  if (MaybeError error =
          CheckNeeds({"samples_seed", "samples_out"}, {"samples"}, ", the number of futures")) {
    return *error;
  }
  if (!writes && Given("samples_out")) {
    return Error{
        "--samples_out is for pushid-predict and pushid-formation; this program only scores "
        "futures"};
  }
  if (MaybeError error = CheckOutputFiles({FLAGS_samples_out})) return *error;
  return FuturesFlags{FLAGS_samples, FLAGS_samples_seed, FLAGS_samples_out};
}

int PrintFutures(const FuturesFlags& flags, const IdentifiedModel& model,
                 const PendulumRecording& recording, int num_frames) {
  if (flags.samples == 0) return kDone;
  const Result<Futures> drawn =
      DrawFutures(model, recording, flags.samples, flags.seed, num_frames);
  if (!drawn.ok()) return Fail(drawn.error());
  const Futures& futures = drawn.value();
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
  if (MaybeError error = WriteFuturesCsv(flags.out, futures)) return Fail(*error);
  std::printf("all futures written to %s\n", flags.out.c_str());
  return kDone;
}

}  // namespace pushid
