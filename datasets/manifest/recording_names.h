// datasets: how files and messages spell a recording's choices.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "datasets/manifest/manifest.h"
#include "datasets/manifest/recording.h"

namespace pushid {

// "net", "net_without_friction", "external".
std::string Name(PushKind kind);
std::optional<PushKind> PushKindFromName(std::string_view name);

// "zero", "estimated", "free".
std::string Name(InitialVelocity initial_velocity);
std::optional<InitialVelocity> InitialVelocityFromName(std::string_view name);

// The manifest's key for the files: "bvh", "c3d", "trc", "csv", "sto".
std::string Name(MotionFormat format);
// As people write it: "BVH", "C3D", ...
std::string Title(MotionFormat format);

}  // namespace pushid
