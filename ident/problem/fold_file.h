// ident: folds that a file gives, such as a published split or quarters of the recordings.
//
//   {"folds": [{"name": "1", "held_out": ["single_X05_00", ...]}, ...]}
//
// Each fold is fitted to all recordings that it does not hold out; the same recording may be held
// out by several folds, or by none.
#pragma once

#include <string>
#include <vector>

#include "ident/problem/folds.h"

namespace pushid {

// Errors: those of ReadJsonDocument; at its place (file:line) what is no fold, a name given twice,
// a recording that is not there, and a fold that holds out nothing or everything.
Result<std::vector<Fold>> ReadFolds(const std::string& path,
                                    const std::vector<PendulumRecording>& recordings);

}  // namespace pushid
