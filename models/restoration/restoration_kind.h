// models: the kinds of restoration, one row each.
//
// A new kind is a value and a row here, its maker in ident/bodies/restoration_files.cc (of a peer:
// peer_files.cc), which turns a file's tensors into it, and its trainer in
// ident/training/restoration_training.cc.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace pushid {

enum class RestorationKind { kRigid, kWindow, kCvae, kSimlpe, kMrt };

struct RestorationKindRow {
  RestorationKind kind;
  const char* name;  // in files and on the command line
  const char* what;
  bool trained;           // it has weights, and stands in a folder
  bool follows_pendulum;  // otherwise it is a peer (peer.h), which continues recorded bodies
};

inline constexpr RestorationKindRow kRestorationKinds[] = {
    {RestorationKind::kRigid, "rigid", "the first pose carried by the rod's tip", false, true},
    {RestorationKind::kWindow, "window", "each frame from the pendulum around it; fast", true,
     true},
    {RestorationKind::kCvae, "cvae", "LDP's chain", true, true},
    {RestorationKind::kSimlpe, "simlpe",
     "siMLPe, which continues 12 given frames, for --peer of pushid-evaluate", true, false},
    {RestorationKind::kMrt, "mrt",
     "MRT, which continues 20 given frames of a whole group, for --peer of pushid-evaluate", true,
     false},
};

const RestorationKindRow& RowOf(RestorationKind kind);
inline const char* Name(RestorationKind kind) { return RowOf(kind).name; }
std::optional<RestorationKind> RestorationKindFromName(std::string_view name);
// Of those that can be trained, for messages: "window, cvae, simlpe or mrt".
std::string TrainedRestorationKinds();

}  // namespace pushid
