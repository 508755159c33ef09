// apps: the flags by which an executable takes a restoration.
#pragma once

#include <memory>

#include "apps/flags/command_line.h"
#include "apps/flags/postprocess_flags.h"
#include "ident/bodies/restoration_files.h"
#include "models/restoration/restoration.h"

DEFINE_string(restoration, "",
              "whole bodies: the folder that pushid-train-restoration --out wrote, or rigid");
DEFINE_string(latent, pushid::NameOf(pushid::LatentChoice{}.latent),
              "cvae: the latent variable is the sampler's mean (mean), or drawn from its Gaussian "
              "in every frame (draw, or draw:2 of seed 2)");

namespace pushid {

struct RestorationFlags {
  std::string name;  // folder of pushid-train-restoration, or rigid; empty: no bodies
  PostprocessOptions postprocess;
  LatentChoice latent;  // of a cvae

  bool given() const { return !name.empty(); }
};

inline RestorationFlags RestorationFlagsFromCommandLine(const std::string& otherwise = "") {
  RestorationFlags flags;
  flags.name = FLAGS_restoration.empty() ? otherwise : FLAGS_restoration;
  const size_t colon = FLAGS_latent.find(':');
  OrFail(ParseName("--latent", FLAGS_latent.substr(0, colon), &flags.latent.latent));
  const bool draws = flags.latent.latent == CvaeLatent::kDraw;
  if (draws && FLAGS_restoration.empty()) {
    throw Error{"--latent=draw needs --restoration, the folder of a cvae"};
  }
  if (colon != std::string::npos) {
    std::int64_t seed = 0;
    if (!draws || !ParseInteger(FLAGS_latent.substr(colon + 1), &seed) || seed < 0) {
      throw Error{"--latent is " + Quoted(FLAGS_latent) + "; a seed is for draws, as in draw:2"};
    }
    flags.latent.seed = static_cast<std::uint64_t>(seed);
  }
  if (!flags.given()) return flags;
  flags.postprocess = PostprocessFromCommandLine();
  return flags;
}

// people: the most in one recording. Warns where a restoration that never saw a group is used for
// one.
inline std::unique_ptr<Restoration> LoadFlaggedRestoration(const RestorationFlags& flags,
                                                           int people) {
  std::unique_ptr<Restoration> restoration = OrFail(LoadRestoration(flags.name));
  OrFail(ChooseLatent(flags.latent, restoration.get()));
  if (people > 1 && OrFail(LearnedAlone(flags.name))) {
    LOG(WARNING)
        << flags.name
        << " was trained on people pushed alone; in groups its bodies stay on tiptoe when others "
           "push them: train one with --more_settings=groups";
  }
  return restoration;
}

// "--poses_out needs bodies: name the folder ...".
inline Error NeedsRestoration(const std::string& flag) {
  return Error{"--" + flag +
               " needs bodies: --restoration=rigid, or the folder of pushid-train-restoration"};
}

}  // namespace pushid
