// apps: the flags by which an executable takes a restoration.
#pragma once

#include <memory>
#include <string>

#include "datasets/files/error.h"
#include "ident/bodies/restoration_files.h"
#include "models/restoration/postprocess.h"
#include "models/restoration/restoration.h"

namespace pushid {

struct RestorationFlags {
  std::string name;  // folder of pushid-train-restoration, or rigid; empty: no bodies
  PostprocessOptions postprocess;
  LatentChoice latent;  // of a cvae

  bool given() const { return !name.empty(); }
};

// Without --restoration, `otherwise` is taken.
Result<RestorationFlags> RestorationFlagsFromCommandLine(const std::string& otherwise = "");

// people: the most there are in one recording. Warns where a restoration that never saw a group is
// to make one.
Result<std::unique_ptr<Restoration>> LoadFlaggedRestoration(const RestorationFlags& flags,
                                                            int people);

// "--joints_out needs bodies: name the folder ...".
Error NeedsRestoration(const std::string& flag);

}  // namespace pushid
