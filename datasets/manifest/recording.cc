// datasets: how files and messages spell a recording's choices.
#include "datasets/manifest/recording.h"

namespace pushid {

std::string Name(PushKind kind) {
  switch (kind) {
    case PushKind::kNet:
      return "net";
    case PushKind::kNetWithoutFriction:
      return "net_without_friction";
    case PushKind::kExternal:
      break;
  }
  return "external";
}

std::optional<PushKind> PushKindFromName(std::string_view name) {
  for (PushKind kind : {PushKind::kNet, PushKind::kNetWithoutFriction, PushKind::kExternal}) {
    if (name == Name(kind)) return kind;
  }
  return std::nullopt;
}

std::string Name(InitialVelocity initial_velocity) {
  switch (initial_velocity) {
    case InitialVelocity::kEstimated:
      return "estimated";
    case InitialVelocity::kFree:
      return "free";
    case InitialVelocity::kZero:
      break;
  }
  return "zero";
}

std::optional<InitialVelocity> InitialVelocityFromName(std::string_view name) {
  for (InitialVelocity choice :
       {InitialVelocity::kZero, InitialVelocity::kEstimated, InitialVelocity::kFree}) {
    if (name == Name(choice)) return choice;
  }
  return std::nullopt;
}

}  // namespace pushid
