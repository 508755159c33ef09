// apps: pushid-path by flag.
#include "apps/flags/path_flags.h"

#include <gflags/gflags.h>

#include <sstream>

#include "apps/flags/command_line.h"
#include "apps/flags/model_flags.h"
#include "datasets/files/number_text.h"

DEFINE_string(from, "",
              "initial state of the path: x, y (m), theta, phi (rad), xd, yd (m/s), thetad, phid "
              "(rad/s), comma-separated, as in theta=0.05,xd=0.3; components not named are 0");
DEFINE_string(to, "",
              "final state, in the same form; if no velocity is named all are free, otherwise all "
              "are fixed. With several ends, separated by semicolons, the most probable one is "
              "reported. Not for models whose noise grows with speed");
DEFINE_int32(frames, pushid::PathFlags{}.frames, "frames of the path, both ends included");
DEFINE_double(fps, pushid::PathFlags{}.fps, "frames per second");
DEFINE_double(mass, pushid::kReferenceMass, "the person's mass, kg");
DEFINE_double(rod, pushid::kReferenceRod, "the person's rod (ankles to hip), m");
DEFINE_string(id, "",
              "instead of --from and --to: a recording of --recordings, whose states are smoothed "
              "and whose gaps are filled");
DEFINE_string(out, "", "write states, and the forces that drove them, here (CSV)");
DEFINE_string(json_out, "", "write the actions here (JSON)");

namespace pushid {
namespace {

MaybeError ReadEnds(PathFlags* flags) {
  const Result<PathEnd> from = ParsePathEnd("--from", FLAGS_from, true);
  if (!from.ok()) return from.error();
  flags->from = from.value();
  std::stringstream list(FLAGS_to);
  for (std::string text; std::getline(list, text, ';');) {
    const std::string name(Trimmed(text));
    const Result<PathEnd> to = ParsePathEnd("--to", name, false);
    if (!to.ok()) return to.error();
    if (name.empty()) return Error{"--to has an empty end; a person at rest upright is x=0,xd=0"};
    if (!flags->to.empty() && to.value().rates_held != flags->to.front().rates_held) {
      return Error{
          "--to fixes velocities in some ends and leaves them free in others, so their "
          "probabilities cannot be compared; name a velocity in all ends or in none"};
    }
    flags->to.push_back(to.value());
    flags->end_names.push_back(name);
  }
  if (!flags->to.empty()) return std::nullopt;
  return Require("to", FLAGS_to, "give the final state, as in --to=x=0.5,xd=0");
}

}  // namespace

Result<PathFlags> PathFlagsFromCommandLine() {
  if (MaybeError missing = RequireModel()) return *missing;
  PathFlags flags;
  flags.between = FLAGS_id.empty();
  if (flags.between) {
    if (MaybeError error = ReadEnds(&flags)) return *error;
  } else {
    for (const char* flag : {"from", "to", "frames", "fps", "mass", "rod"}) {
      if (!Given(flag)) continue;
      return Error{std::string("--id smooths a recording, which gives both ends; leave --") + flag +
                   " out"};
    }
  }
  for (MaybeError error :
       {CheckRange("frames", FLAGS_frames, 6, 100000), CheckRange("fps", FLAGS_fps, 10, 10000),
        CheckRange("mass", FLAGS_mass, 5, 500), CheckRange("rod", FLAGS_rod, 0.2, 2),
        CheckOutputFiles({FLAGS_out, FLAGS_json_out})}) {
    if (error) return *error;
  }
  flags.body = {FLAGS_mass, FLAGS_rod, 0.0};
  flags.fps = FLAGS_fps;
  flags.frames = FLAGS_frames;
  flags.id = FLAGS_id;
  flags.out = FLAGS_out;
  flags.json_out = FLAGS_json_out;
  return flags;
}

}  // namespace pushid
