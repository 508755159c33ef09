// apps: flags about bodies that several programs share; each has a source of its own, so that a
// program has the flags that it links.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "ident/bodies/restoration_files.h"
#include "models/restoration/postprocess.h"
#include "models/restoration/restoration.h"

namespace pushid {

// Corrections of restored bodies, by --postprocess (postprocess_flags.cc).
PostprocessOptions PostprocessFromCommandLine();

enum class GeneratorKind;
// The kind of generator whose paper's settings are asked for, if any (published_flags.cc).
std::optional<GeneratorKind> PublishedKind();

// The flags by which an executable takes a restoration.

struct RestorationFlags {
  std::string name;  // folder of pushid-train-restoration, or rigid; empty: no bodies
  PostprocessOptions postprocess;
  LatentChoice latent;  // of a cvae

  bool given() const { return !name.empty(); }
};

RestorationFlags RestorationFlagsFromCommandLine(const std::string& otherwise = "");

// people: the most in one recording. Warns where a restoration that never saw a group is used for
// one.
std::unique_ptr<Restoration> LoadFlaggedRestoration(const RestorationFlags& flags, int people);

// "--poses_out needs bodies: name the folder ...".
Error NeedsRestoration(const std::string& flag);

}  // namespace pushid
