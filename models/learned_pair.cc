// models: sizes and names of learned interactions.
#include "models/learned_pair.h"

namespace pushid {

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
  for (int size : shape.hidden) name += (name.empty() ? "network:" : "-") + std::to_string(size);
  return name;
}

}  // namespace pushid
