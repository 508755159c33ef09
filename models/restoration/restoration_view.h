// models: what a restoration is told of the motion, besides the first pose, mass and size.
#pragma once

#include "models/enum_names.h"

namespace pushid {

enum class RestorationView {
  kPendulum,    // the person's own pendulum
  kNeighbours,  // those of the neighbours too: `window` alone
  kPose  // no pendulum, to see what it is worth: `window` has the first pose and the push, `cvae`
         // the pose before
};
constexpr EnumNames<RestorationView, 3> Names(RestorationView) {
  return {{{"pendulum", RestorationView::kPendulum},
           {"neighbours", RestorationView::kNeighbours},
           {"pose", RestorationView::kPose}}};
}

}  // namespace pushid
