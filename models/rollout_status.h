// models: how a rollout ended.
#pragma once

#include <string_view>

namespace pushid {

// Whether a rollout stayed in the model's domain, and if not, where it left it.
struct RolloutStatus {
  bool ok = true;
  int frame = 0;
  int person = 0;
  std::string_view quantity;  // theta, phi, rod or "state" (not finite)
};

}  // namespace pushid
