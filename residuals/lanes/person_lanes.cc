// residuals: the choice among the widths of people side by side.
#include "residuals/lanes/person_lanes.h"

#include "residuals/packed/vector_kernels.h"

namespace pushid {

// In the order of the vector kernels, of which there are as many.
const std::vector<const PersonLanes*>& SupportedPersonLanes() {
  static const std::vector<const PersonLanes*> supported = [] {
    std::vector<const PersonLanes*> all = {PersonLanes128(), PersonLanes256(), PersonLanes512()};
    all.resize(SupportedVectorKernels().size());
    return all;
  }();
  return supported;
}

const PersonLanes& BestPersonLanes() { return *SupportedPersonLanes().back(); }

const PersonLanes& PersonLanesFor(int people) {
  for (const PersonLanes* lanes : SupportedPersonLanes()) {
    if (lanes->lanes >= people) return *lanes;
  }
  return BestPersonLanes();
}

}  // namespace pushid
