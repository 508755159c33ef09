// apps: pushid-report: an identified model in words and tables.
#include <gflags/gflags.h>

#include <cstdio>

#include "apps/app_support.h"
#include "ident/report_text.h"
#include "ident/result_json.h"
#include "ident/truth_table.h"

DEFINE_string(model, "", "model that pushid-fit --model_out wrote");
DEFINE_string(truth, "", "manifest.json of pushid-simulate: only compare with its true values");

namespace {

int Run() {
  using namespace pushid;
  if (MaybeError missing =
          Require("model", FLAGS_model, "give a file that pushid-fit --model_out wrote")) {
    return Fail(*missing);
  }
  const Result<FitResult> result = ReadFitResult(FLAGS_model);
  if (!result.ok()) return Fail(result.error());
  if (!FLAGS_truth.empty()) {
    const Result<std::map<std::string, double>> truth = ReadTruth(FLAGS_truth);
    if (!truth.ok()) return Fail(truth.error());
    std::printf("%s", TruthTable(result.value(), truth.value()).c_str());
    return kDone;
  }
  std::printf("%s", ReportText(result.value()).c_str());
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(argc, argv,
                        "pushid-report prints an identified model.\n\n  pushid-report "
                        "--model=model.json",
                        Run);
}
