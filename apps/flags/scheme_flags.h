// apps: --scheme of the training programs: what the folds of their --crossvalidate hold out.
#pragma once

#include "datasets/files/error.h"
#include "ident/problem/folds.h"

namespace pushid {

// takes_folds: whether there are any. Errors: no such scheme, or one where there are no folds.
Result<FoldScheme> SchemeFromCommandLine(bool takes_folds);

}  // namespace pushid
