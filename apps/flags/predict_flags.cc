// apps: pushid-predict by flag.
#include "apps/flags/predict_flags.h"

#include <gflags/gflags.h>

#include "apps/flags/command_line.h"
#include "apps/flags/model_flags.h"
#include "ident/bodies/body_files.h"

DEFINE_string(id, "", "the recording that gives the first frame and the push");
DEFINE_string(out, "",
              "write the trajectory here (CSV: states, hip, forces by part); with --restoration "
              "the bodies instead, if the name ends in .bvh (one file per person), or in .gltf or "
              ".glb (all in one animated glTF file)");
DEFINE_int32(frames, pushid::PredictFlags{}.frames,
             "frames to predict; 0: as many as the recording has");
DEFINE_string(joints_out, "",
              "--restoration: joint positions (CSV: frame, person, joint, x, y, z)");
DEFINE_string(json_out, "", "--restoration: joint positions of every person and frame (JSON)");

namespace pushid {
namespace {

constexpr int kMostFrames = 1000000;  // hours of motion

// The first output that holds bodies; empty where there is none.
std::string BodyOutput(const PredictFlags& flags) {
  if (!flags.joints_out.empty()) return "joints_out";
  if (!flags.json_out.empty()) return "json_out";
  return flags.out_is_bodies() ? "out=" + flags.out : "";
}

}  // namespace

bool PredictFlags::out_is_bodies() const { return IsBodyFile(out); }

Result<PredictFlags> PredictFlagsFromCommandLine() {
  for (MaybeError missing :
       {RequireModel(), Require("id", FLAGS_id, "name a recording of the manifest"),
        Require("out", FLAGS_out, "name the CSV, BVH or glTF file to write")}) {
    if (missing) return *missing;
  }
  const Result<RestorationFlags> restoration = RestorationFlagsFromCommandLine();
  if (!restoration.ok()) return restoration.error();
  const PredictFlags flags{FLAGS_id,         FLAGS_out,     FLAGS_frames, restoration.value(),
                           FLAGS_joints_out, FLAGS_json_out};
  const std::string needy = BodyOutput(flags);
  if (!needy.empty() && !flags.restoration.given()) return NeedsRestoration(needy);
  if (!flags.whole_recording() && (flags.frames < 2 || flags.frames > kMostFrames)) {
    return Error{"--frames must be 0, or lie between 2 and " + std::to_string(kMostFrames)};
  }
  if (MaybeError error = CheckOutputFiles({flags.joints_out, flags.json_out, flags.out})) {
    return *error;
  }
  return flags;
}

}  // namespace pushid
