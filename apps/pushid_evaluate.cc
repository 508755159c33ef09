// apps: pushid-evaluate: how far a model's predictions are from recordings, beside the baselines.
#include <gflags/gflags.h>

#include <cstdio>

#include "apps/app_support.h"
#include "apps/model_flags.h"
#include "apps/recording_flags.h"
#include "datasets/atomic_file.h"
#include "datasets/json_file.h"
#include "ident/report_text.h"
#include "ident/result_json.h"

DEFINE_string(json_out, "", "write the scores here (JSON)");
DEFINE_bool(per_recording, true, "print a line for every recording");

namespace {

int Run() {
  using namespace pushid;
  const Result<IdentifiedModel> model = LoadFlaggedModel();
  if (!model.ok()) return Fail(model.error());
  if (!FLAGS_json_out.empty()) {
    if (MaybeError error = CheckWritable(FLAGS_json_out)) return Fail(*error);
  }
  const Result<std::vector<Recording>> recordings = LoadFlaggedRecordings();
  if (!recordings.ok()) return Fail(recordings.error());
  const Evaluation evaluation =
      Evaluate(model.value(), MapRecordings(recordings.value(), model.value().mapping));
  std::printf("%s", EvaluationText(evaluation, FLAGS_per_recording).c_str());
  if (!FLAGS_json_out.empty()) {
    nlohmann::ordered_json json = ToJson(evaluation);
    json["version"] = Version();
    json["configuration"] = EffectiveFlags();
    if (MaybeError error = WriteJson(FLAGS_json_out, json)) return Fail(*error);
  }
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(argc, argv,
                        "pushid-evaluate compares a model's predictions with recordings.\n\n  "
                        "pushid-evaluate --model=model.json --recordings=M/manifest.json "
                        "--setting=single --json_out=scores.json",
                        Run);
}
