// apps: pushid-animate by flag.
#include "apps/flags/animate_flags.h"

#include <gflags/gflags.h>

#include "apps/flags/command_line.h"

DEFINE_string(id, "", "the recording to show");
DEFINE_string(out, "", "the page to write (HTML), for any browser");
DEFINE_string(strip_out, "", "a strip of poses (SVG)");
DEFINE_int32(poses, pushid::AnimateFlags{}.poses, "poses of the strip");
DEFINE_string(explain, "",
              "describe the forces on this person in words and plot them beside the motion: a "
              "person's id, or auto (the bystander with the most events)");
DEFINE_bool(recorded, pushid::AnimateFlags{}.recorded, "also show the recorded bodies");

namespace pushid {

Result<AnimateFlags> AnimateFlagsFromCommandLine() {
  if (MaybeError missing = Require("id", FLAGS_id, "name a recording of the manifest")) {
    return *missing;
  }
  if (FLAGS_out.empty() && FLAGS_strip_out.empty()) {
    return Error{"--out and --strip_out are missing: name a page (HTML) or a picture (SVG)"};
  }
  if (FLAGS_poses < 2 || FLAGS_poses > 40) return Error{"--poses must lie between 2 and 40"};
  if (MaybeError error = CheckOutputFiles({FLAGS_out, FLAGS_strip_out})) return *error;
  const Result<RestorationFlags> restoration = RestorationFlagsFromCommandLine("rigid");
  if (!restoration.ok()) return restoration.error();
  return AnimateFlags{FLAGS_id,    restoration.value(), FLAGS_out,      FLAGS_strip_out,
                      FLAGS_poses, FLAGS_explain,       FLAGS_recorded, Given("restoration")};
}

}  // namespace pushid
