// models: sizes and names of self-force networks.
#include "models/self_network.h"

namespace pushid {

int NetworkShape::gate_rows() const {
  switch (kind) {
    case NetworkKind::kNone:
      return 0;
    case NetworkKind::kMlp:
      return hidden;
    case NetworkKind::kGru:
      return 2 * hidden;
    case NetworkKind::kLstm:
      return 3 * hidden;
  }
  return 0;
}

std::string NetworkName(const NetworkShape& shape) {
  std::string name = NameOf(shape.kind);
  if (!shape.any()) return name;
  name += ":" + std::to_string(shape.hidden);
  if (shape.embedding > 0) name += ":" + std::to_string(shape.embedding);
  return name;
}

}  // namespace pushid
