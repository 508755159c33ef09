// apps: pushid-evaluate by flag.
#include "apps/flags/evaluate_flags.h"

#include <gflags/gflags.h>

#include "apps/flags/command_line.h"
#include "apps/flags/model_flags.h"

DEFINE_string(json_out, "", "write the scores here (JSON)");
DEFINE_string(peer, "",
              "with --restoration: the folder of a peer (pushid-train-restoration --kind=simlpe or "
              "--kind=mrt) to compare with");
DEFINE_bool(per_recording, pushid::EvaluateFlags{}.per_recording,
            "print a line for every recording");

namespace pushid {

Result<EvaluateFlags> EvaluateFlagsFromCommandLine() {
  if (MaybeError missing = RequireModel()) return *missing;
  Result<RestorationFlags> restoration = RestorationFlagsFromCommandLine();
  if (!restoration.ok()) return restoration.error();
  if (!restoration.value().given() && !FLAGS_peer.empty()) {
    return Error{"--peer needs --restoration to be compared with"};
  }
  if (MaybeError error = CheckOutputFiles({FLAGS_json_out})) return *error;
  return EvaluateFlags{FLAGS_json_out, restoration.value(), FLAGS_peer, FLAGS_per_recording};
}

}  // namespace pushid
