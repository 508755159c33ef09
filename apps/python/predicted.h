// apps: predictions as Python gets them.
#pragma once

#include "apps/python/model.h"
#include "ident/prediction/prediction.h"

namespace pushid {

// (frames, people, 8): q, then qd.
Array StatesOf(const RolloutPath<double>& path, int people);

// hip, states, observed, and bands where there are any. Raises where the rollout left the domain.
py::dict DictOf(const Prediction& prediction, const PendulumRecording& recording);

// The model with some of its values replaced: "mu=20,...".
IdentifiedModel With(const Model& model, const std::string& set);

// Warns of pushes beyond those that the model was fitted to.
void WarnOfInputs(const IdentifiedModel& model, const PendulumRecording& recording);

}  // namespace pushid
