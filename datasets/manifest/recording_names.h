// datasets: how files and messages spell a recording's choices.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "datasets/manifest/recording.h"

namespace pushid {

// "net", "net_without_friction", "external".
std::string Name(PushKind kind);
std::optional<PushKind> PushKindFromName(std::string_view name);

// "zero", "estimated", "free".
std::string Name(InitialVelocity initial_velocity);
std::optional<InitialVelocity> InitialVelocityFromName(std::string_view name);

}  // namespace pushid
