// apps: pushid-push by flag.
#include "apps/flags/push_flags.h"

#include <gflags/gflags.h>

#include "apps/flags/command_line.h"

DEFINE_string(id, "", "the recording");
DEFINE_int32(person, pushid::PushFlags{}.person, "who is pushed, counted from 0");
DEFINE_string(out, "", "write the push here (CSV)");

DEFINE_int32(first_frame, pushid::PushFlags{}.window.start,
             "inverse dynamics: first frame of the window; -1: found by itself");
DEFINE_int32(end_frame, pushid::PushFlags{}.window.end,
             "inverse dynamics: frame after the window; -1: found by itself");
DEFINE_int32(smoothing, pushid::PushFlags{}.smoothing,
             "inverse dynamics: Savitzky-Golay window in frames, odd, at least 5; 0: none (2 mm of "
             "noise then make 600 N)");

namespace pushid {
namespace {

// A flag of the other way would be taken and do nothing.
MaybeError CheckInverseDynamics() {
  for (const char* flag : {"first_frame", "end_frame", "smoothing"}) {
    if (SensorGiven() && Given(flag)) {
      return Error{std::string("--") + flag + " belongs to inverse dynamics, not to --sensor"};
    }
  }
  if (FLAGS_first_frame < -1 || FLAGS_end_frame < -1) {
    return Error{"--first_frame and --end_frame are frames, counted from 0"};
  }
  return std::nullopt;
}

}  // namespace

Result<PushFlags> PushFlagsFromCommandLine() {
  for (MaybeError missing : {Require("id", FLAGS_id, "name a recording of the manifest"),
                             Require("out", FLAGS_out, "name the CSV file to write")}) {
    if (missing) return *missing;
  }
  if (MaybeError error = CheckInverseDynamics()) return *error;
  if (Given("resample_fps")) {
    return Error{
        "a push has a row for each of the recording's own frames; leave --resample_fps out"};
  }
  const Result<SensorFlags> sensor = SensorFlagsFromCommandLine();
  if (!sensor.ok()) return sensor.error();
  if (MaybeError error = CheckOutputFiles({FLAGS_out})) return *error;
  return PushFlags{
      FLAGS_id,       FLAGS_person, FLAGS_out, sensor.value(), {FLAGS_first_frame, FLAGS_end_frame},
      FLAGS_smoothing};
}

}  // namespace pushid
