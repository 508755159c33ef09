// models: all that a model has learned: a self force, a law of the rod, what people do to each
// other; any of them, their weights in one flat array.
#pragma once

#include <vector>

#include "models/learned_pair.h"
#include "models/options.h"
#include "models/rod_law.h"
#include "models/self_network.h"

namespace pushid {

struct LearnedTerms {
  NetworkShape shape;           // of the self force
  std::vector<double> weights;  // of the self force, then of the rod's law, then of the interaction
  RodShape rod = {};            // of the rod's law
  PairShape pair = {};          // of the interaction

  bool any() const { return shape.any() || rod.moves() || pair.any(); }
  int num_weights() const { return pair_at() + pair.num_weights(); }
  // The first weights of rod and interaction.
  int rod_at() const { return shape.num_weights(); }
  int pair_at() const { return rod_at() + rod.num_weights(); }
};

// Whether something is learned of a person alone: a force, or how the rod moves.
inline bool LearnsAlone(const ModelOptions& options) {
  return options.learned != nullptr &&
         (options.learned->shape.any() || options.learned->rod.moves());
}

// Whether the rod moves.
inline bool RodMoves(const ModelOptions& options) {
  return options.learned != nullptr && options.learned->rod.moves();
}

}  // namespace pushid
