// datasets: how far the ground under a person's feet reaches from between the ankles, which is
// where the pendulum's cart stands: what the centre of pressure can move in before a step is
// needed.
#pragma once

#include <optional>

#include "datasets/manifest/recording.h"

namespace pushid {

// m, at frame 0, along x and y. Joints lie inside a foot: toes end some 4 cm before the `toe` of a
// skeleton, and a sole is about 5 cm wider than the ankles' distance on either side.
struct FootSupport {
  double side = 0.0;              // half the lateral distance between the ankles
  std::optional<double> forward;  // from ankle to toe, both feet's mean; unset: no toes recorded,
  std::optional<double> back;     // from ankle to heel            or they point the other way
};

FootSupport SupportOf(const RecordedPerson& person);

}  // namespace pushid
