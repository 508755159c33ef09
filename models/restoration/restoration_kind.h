// models: the kinds of restoration, one row each, and what they may be told of the motion.
//
// A new kind is a value and a row here, and a row in ident/bodies/restoration_kinds.h, which names
// the functions that make it from a file and train it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "models/enum_names.h"

namespace pushid {

enum class RestorationKind { kRigid, kWindow, kCvae, kSimlpe, kMrt };

struct RestorationKindRow {
  RestorationKind kind;
  const char* name;       // in files and on the command line
  const char* what;       // for the list of kinds on the command line
  bool trained;           // it has weights, and stands in a folder
  bool follows_pendulum;  // otherwise it is a peer (peers/peer.h), which continues recorded bodies
  bool sees_neighbours;   // it has RestorationView::kNeighbours
  bool differentiable;    // by the pendulum (window_tangent.h), for training as a whole
};

inline constexpr RestorationKindRow kRestorationKinds[] = {
    {RestorationKind::kRigid, "rigid", "the first pose carried by the rod's tip", false, true,
     false, false},
    {RestorationKind::kWindow, "window", "fast, default", true, true, true, true},
    {RestorationKind::kCvae, "cvae", "LDP's chain", true, true, false, false},
    {RestorationKind::kSimlpe, "simlpe", "siMLPe, which continues 12 given frames", true, false,
     false, false},
    {RestorationKind::kMrt, "mrt", "MRT, which continues 20 given frames of a whole group", true,
     false, false, false},
};

constexpr bool RestorationRowsAreInOrder() {
  int value = 0;
  for (const RestorationKindRow& row : kRestorationKinds) {
    if (static_cast<int>(row.kind) != value++) return false;
  }
  return true;
}
static_assert(RestorationRowsAreInOrder(), "RowOf finds a row by its kind's value");

constexpr const RestorationKindRow& RowOf(RestorationKind kind) {
  return kRestorationKinds[static_cast<int>(kind)];
}
inline const char* Name(RestorationKind kind) { return RowOf(kind).name; }

inline std::optional<RestorationKind> RestorationKindFromName(std::string_view name) {
  for (const RestorationKindRow& row : kRestorationKinds) {
    if (name == row.name) return row.kind;
  }
  return std::nullopt;
}

// Of those that can be trained, for messages: "window, cvae, simlpe or mrt".
inline std::string TrainedRestorationKinds() {
  std::vector<std::string> names;
  for (const RestorationKindRow& row : kRestorationKinds) {
    if (row.trained) names.push_back(row.name);
  }
  std::string list;
  for (size_t i = 0; i < names.size(); ++i) {
    list += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + names[i];
  }
  return list;
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
