// apps: loading what --restoration names.

#include <gflags/gflags.h>

#include "apps/flags/body_flags.h"
#include "apps/flags/command_line.h"
#include "apps/support/app_support.h"
#include "ident/bodies/restoration_files.h"
#include "ident/parameters/option_names.h"

DEFINE_string(restoration, "",
              "whole bodies: the folder that pushid-train-restoration --out wrote, or rigid");
DEFINE_string(latent, pushid::NameOf(pushid::LatentChoice{}.latent),
              "cvae: the latent variable is the sampler's mean (mean), or drawn from its Gaussian "
              "in every frame (draw)");
DEFINE_uint64(latent_seed, pushid::LatentChoice{}.seed, "with --latent=draw: seed of the draws");

namespace pushid {

Result<RestorationFlags> RestorationFlagsFromCommandLine(const std::string& otherwise) {
  RestorationFlags flags;
  flags.name = FLAGS_restoration.empty() ? otherwise : FLAGS_restoration;
  if (MaybeError error = ParseName("--latent", FLAGS_latent, &flags.latent.latent)) return *error;
  flags.latent.seed = FLAGS_latent_seed;
  const bool draws = flags.latent.latent == CvaeLatent::kDraw;
  if (draws && FLAGS_restoration.empty()) {
    return Error{"--latent=draw needs --restoration, the folder of a cvae"};
  }
  if (!draws && Given("latent_seed")) return Error{"--latent_seed needs --latent=draw"};
  if (!flags.given()) return flags;
  const Result<PostprocessOptions> postprocess = PostprocessFromCommandLine();
  if (!postprocess.ok()) return postprocess.error();
  flags.postprocess = postprocess.value();
  return flags;
}

namespace {

// A restoration that never saw a group is to make one.
MaybeError WarnOfCrowd(const RestorationFlags& flags, int people) {
  if (people < 2) return std::nullopt;
  const Result<bool> alone = LearnedAlone(flags.name);
  if (!alone.ok()) return alone.error();
  if (alone.value()) {
    Warn(flags.name +
         " was trained on people pushed alone; in groups its bodies stay on tiptoe when others "
         "push them: train one with --more_settings=groups");
  }
  return std::nullopt;
}

}  // namespace

Result<std::unique_ptr<Restoration>> LoadFlaggedRestoration(const RestorationFlags& flags,
                                                            int people) {
  Result<std::unique_ptr<Restoration>> restoration = LoadRestoration(flags.name);
  if (!restoration.ok()) return restoration;
  if (MaybeError error = ChooseLatent(flags.latent, restoration.value().get())) return *error;
  if (MaybeError error = WarnOfCrowd(flags, people)) return *error;
  return restoration;
}

Error NeedsRestoration(const std::string& flag) {
  return Error{"--" + flag +
               " needs bodies: --restoration=rigid, or the folder of pushid-train-restoration"};
}

}  // namespace pushid
