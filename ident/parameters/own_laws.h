// ident: a user's own force laws in a fit.
#pragma once

#include <memory>
#include <vector>

#include "datasets/files/error.h"
#include "ident/parameters/parameter_table.h"
#include "models/force_law.h"

namespace pushid {

using ForceLaws = std::vector<std::shared_ptr<const ForceLaw>>;

// Gives a law to the model and its parameters to the table: free, starting at their nominal values,
// without priors. Errors: a second law of that name, a parameter whose name is taken, more of them
// than there are slots. Nothing is added then.
MaybeError AddForceLaw(std::shared_ptr<const ForceLaw> law, ModelOptions* model,
                       ParameterTable* table);

// Those of `laws` that a model file names, added in its order. Errors: one that is not among them.
MaybeError AddNamedLaws(const std::vector<std::string>& names, const ForceLaws& laws,
                        ModelOptions* model, ParameterTable* table);

// Their names, in the model's order.
std::vector<std::string> LawNames(const ModelOptions& model);

}  // namespace pushid
