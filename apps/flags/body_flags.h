// apps: flags about bodies that several programs share; each has a source of its own, so that a
// program has the flags that it links.
#pragma once

#include <vector>

#include "datasets/files/error.h"
#include "ident/problem/folds.h"
#include "models/generators/diffusion_generator.h"
#include "models/restoration/postprocess.h"

namespace pushid {

// postprocess_flags.cc: what makes restored bodies fit, as --postprocess lists it.
Result<PostprocessOptions> PostprocessFromCommandLine();

// scheme_flags.cc: --scheme of the training programs, what the folds of their --crossvalidate hold
// out. takes_folds: whether there are any. Errors: no such scheme, or one where there are no folds.
Result<FoldScheme> SchemeFromCommandLine(bool takes_folds);

// diffusion_flags.cc: how a generator of diffusion is sampled. Errors name the flag.
Result<DiffusionGeneratorOptions> DiffusionOptionsFromCommandLine();

// These flags.
std::vector<const char*> DiffusionFlagNames();

}  // namespace pushid
