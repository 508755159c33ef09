// models: the kinds of restoration, one row each, and what they may be told of the motion.
//
// A new kind is a value and a row here, and a row in ident/bodies/restoration_kinds.h, which names
// the functions that make it from a file and train it.
#pragma once

#include <string>

#include "models/enum_names.h"

namespace pushid {

enum class RestorationKind { kRigid, kWindow, kCvae, kSimlpe, kMrt };

struct RestorationKindRow {
  const char* name;  // in files and on the command line
  RestorationKind value;
  const char* what;       // for the list of kinds on the command line
  bool trained;           // it has weights, and stands in a folder
  bool follows_pendulum;  // otherwise it is a peer (peers/peer.h), which continues recorded bodies
  bool sees_neighbours;   // it has RestorationView::kNeighbours
  bool differentiable;    // by the pendulum (window_tangent.h), for training as a whole
};

inline constexpr RestorationKindRow kRestorationKinds[] = {
    {"rigid", RestorationKind::kRigid, "the first pose carried by the rod's tip", false, true,
     false, false},
    {"window", RestorationKind::kWindow, "fast, default", true, true, true, true},
    {"cvae", RestorationKind::kCvae, "LDP's chain", true, true, false, false},
    {"simlpe", RestorationKind::kSimlpe, "siMLPe, which continues 12 given frames", true, false,
     false, false},
    {"mrt", RestorationKind::kMrt, "MRT, which continues 20 given frames of a whole group", true,
     false, false, false},
};
constexpr const auto& Names(RestorationKind) { return kRestorationKinds; }
static_assert(RowsAreInOrder(kRestorationKinds), "RowOf finds a row by its value");

// Of those that can be trained, for messages: "window, cvae, simlpe or mrt".
inline std::string TrainedRestorationKinds() {
  return AnyName<RestorationKind>([](const RestorationKindRow& row) { return row.trained; });
}

// What a restoration is told of the motion, besides the first pose, mass and size.
enum class RestorationView {
  kPendulum,    // the person's own pendulum
  kNeighbours,  // those of the neighbours too, where the kind sees them
  kPose  // no pendulum, to see what it is worth: `window` has the first pose and the push, `cvae`
         // the pose before
};
constexpr EnumNames<RestorationView, 3> Names(RestorationView) {
  return {{{"pendulum", RestorationView::kPendulum},
           {"neighbours", RestorationView::kNeighbours},
           {"pose", RestorationView::kPose}}};
}

}  // namespace pushid
