// models: sizes and names of what is learned, and derivatives of rod laws.
#include "models/learned_terms.h"

namespace pushid {

std::string NetworkName(const NetworkShape& shape) {
  std::string name = NameOf(shape.kind);
  if (!shape.any()) return name;
  name += ":" + std::to_string(shape.hidden);
  if (shape.embedding > 0) name += ":" + std::to_string(shape.embedding);
  return name;
}

int RodShape::num_weights() const {
  if (!moves()) return 0;
  int weights = 0, below = num_inputs();
  for (int rows : hidden) {
    weights += rows * (below + 1);
    below = rows;
  }
  return weights + below + (biased() ? 1 : 0);
}

std::string RodName(const RodShape& shape) {
  std::string name = NameOf(shape.kind);
  for (size_t i = 0; i < shape.hidden.size(); ++i) {
    name += (i == 0 ? ":" : "-") + std::to_string(shape.hidden[i]);
  }
  return name;
}

int PairShape::num_weights() const {
  if (!any()) return 0;
  int weights = 0, inputs = kInputs;
  for (int size : hidden) {
    weights += size * (inputs + 1);
    inputs = size;
  }
  return weights + 4 * (inputs + 1);
}

std::string PairName(const PairShape& shape) {
  std::string name;
  for (int size : shape.hidden) {
    name += (!name.empty() ? "-" : shape.ldp ? "ldp_network:" : "network:") + std::to_string(size);
  }
  return name;
}

}  // namespace pushid
