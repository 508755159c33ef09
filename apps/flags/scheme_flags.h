// apps: --scheme of the training programs: what the folds of their --crossvalidate hold out.
#pragma once

#include "datasets/files/error.h"
#include "ident/problem/folds.h"

namespace pushid {

// crossvalidate: folds, 0 for none. Errors: no such scheme, or one where there are no folds.
Result<FoldScheme> SchemeFromCommandLine(int crossvalidate);

}  // namespace pushid
