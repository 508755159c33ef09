// apps: the flags of pushid-fit alone.
#include "apps/flags/fit_flags.h"

#include <gflags/gflags.h>

DEFINE_string(model_out, "", "write the identified model here (JSON)");
DEFINE_int32(resample, pushid::FitFlags{}.resample,
             "fit bootstrap replica k: as many people or recordings (--bootstrap_by), drawn with "
             "replacement from --seed and k; 0: the recordings as they are");
DEFINE_string(body_restoration, "",
              "folder that pushid-train-restoration --kind=window wrote, for --body_weight");
DEFINE_bool(check, pushid::FitFlags{}.check,
            "only check the flags: nothing is read, fitted or written");
DEFINE_bool(list_parameters, pushid::FitFlags{}.list_parameters,
            "only print every parameter: name, symbol, unit, meaning, when to free it (Markdown)");

namespace pushid {

Result<FitFlags> FitFlagsFromCommandLine() {
  if (FLAGS_resample < 0) return Error{"--resample must not be negative"};
  return FitFlags{FLAGS_model_out, FLAGS_resample, FLAGS_body_restoration, FLAGS_check,
                  FLAGS_list_parameters};
}

}  // namespace pushid
