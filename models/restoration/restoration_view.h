// models: what a restoration is told of the motion, besides the first pose, mass and size.
//
//   pendulum    the person's own pendulum (default)
//   neighbours  those of the neighbours too: `window` alone
//   pose        no pendulum at all, to see what it is worth: `window` has the first pose and the
//   push,
//               `cvae` the pose before
#pragma once

#include <optional>
#include <string_view>

namespace pushid {

enum class RestorationView { kPendulum, kNeighbours, kPose };

inline constexpr const char* kRestorationViewNames[] = {"pendulum", "neighbours", "pose"};

inline const char* Name(RestorationView view) {
  return kRestorationViewNames[static_cast<int>(view)];
}

inline std::optional<RestorationView> RestorationViewFromName(std::string_view name) {
  for (int v = 0; v < 3; ++v) {
    if (name == kRestorationViewNames[v]) return static_cast<RestorationView>(v);
  }
  return std::nullopt;
}

}  // namespace pushid
