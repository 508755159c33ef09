// apps: a fitted model as the parts of the Python module share it.
#pragma once

#include "apps/python/bindings.h"

namespace pushid {

// What a model was fitted to.
struct FittedTo {
  std::vector<SharedRecording> recordings;
  std::vector<PendulumRecording> pendulums;
};

// Both parts are replaced whole and never changed: another thread may be reading them without the
// GIL. `to` is null where the model was loaded.
struct Model {
  std::shared_ptr<const FittedModel> fitted;
  std::shared_ptr<const FittedTo> to;
};

// The data of a model that asks for them.
std::shared_ptr<const FittedTo> DataOf(const Model& model);

IdentifiedModel IdentifiedOf(const Model& model);

}  // namespace pushid
