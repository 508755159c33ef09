// models: sizes and names of what is learned.
#include "models/learned_terms.h"

namespace pushid {

std::string NetworkName(const NetworkShape& shape) {
  std::string name = NameOf(shape.kind);
  if (!shape.any()) return name;
  name += ":" + std::to_string(shape.hidden);
  if (shape.embedding > 0) name += ":" + std::to_string(shape.embedding);
  return name;
}

int NumLayerWeights(int inputs, const std::vector<int>& hidden, int outputs) {
  int weights = 0;
  for (int rows : hidden) {
    weights += rows * (inputs + 1);
    inputs = rows;
  }
  return weights + outputs * (inputs + 1);
}

std::string RodName(const RodShape& shape) {
  std::string name = NameOf(shape.kind);
  for (size_t i = 0; i < shape.hidden.size(); ++i) {
    name += (i == 0 ? ":" : "-") + std::to_string(shape.hidden[i]);
  }
  return name;
}

std::string PairName(const PairShape& shape) {
  std::string name;
  for (int size : shape.hidden) {
    name += (!name.empty() ? "-" : shape.ldp ? "ldp_network:" : "network:") + std::to_string(size);
  }
  return name;
}

}  // namespace pushid
