// apps: pushid-report by flag.
#include "apps/flags/report_flags.h"

#include <gflags/gflags.h>

#include "apps/flags/command_line.h"

DEFINE_string(model, "", "model that pushid-fit --model_out wrote");
DEFINE_string(truth, "", "manifest.json of pushid-simulate: only compare with its true values");
DEFINE_string(html_out, "", "write the whole report here: one self-contained page (HTML)");
DEFINE_bool(text, pushid::ReportFlags{}.text, "print the whole report, not only the parameters");
DEFINE_int32(num_threads, pushid::ReportFlags{}.num_threads, "threads");
DEFINE_string(csv_dir, "", "write the numbers behind every plot into this folder (CSV)");

namespace pushid {

Result<ReportFlags> ReportFlagsFromCommandLine() {
  if (MaybeError missing =
          Require("model", FLAGS_model, "give a file that pushid-fit --model_out wrote")) {
    return *missing;
  }
  if (MaybeError error = CheckOutputFiles({FLAGS_html_out})) return *error;
  return ReportFlags{FLAGS_model,   FLAGS_truth, FLAGS_html_out,
                     FLAGS_csv_dir, FLAGS_text,  FLAGS_num_threads};
}

}  // namespace pushid
