// apps: the flags by which an executable takes a restoration.
#pragma once

#include <gflags/gflags.h>

#include <memory>

#include "datasets/files/error.h"
#include "models/restoration/postprocess.h"
#include "models/restoration/restoration.h"

DECLARE_string(restoration);

namespace pushid {

// What --restoration names, for a model whose rod moves or does not: bodies hang on rods of
// constant length.
Result<std::unique_ptr<Restoration>> LoadFlaggedRestoration(bool rod_moves);

// What --postprocess lists.
Result<PostprocessOptions> PostprocessOfFlags();

}  // namespace pushid
