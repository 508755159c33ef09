// apps: pushid-evaluate: how far a model's predictions are from recordings, beside the baselines.
#include <gflags/gflags.h>

#include <cstdio>
#include <optional>

#include "apps/flags/model_flags.h"
#include "apps/flags/recording_flags.h"
#include "apps/flags/restoration_flags.h"
#include "apps/support/app_support.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "ident/bodies/body_report.h"
#include "ident/bodies/simlpe_files.h"
#include "ident/validation/scores_json.h"
#include "ident/validation/scores_text.h"
#include "models/self_network.h"

DEFINE_string(json_out, "", "write the scores here (JSON)");
DEFINE_string(
    peer, "",
    "with --restoration: the folder of a siMLPe (pushid-train-restoration --kind=simlpe) to "
    "compare with");
DEFINE_bool(per_recording, true, "print a line for every recording");

namespace {

using namespace pushid;

// Bodies beside pendulums, where --restoration asks for them; else nothing.
Result<std::optional<BodyEvaluation>> Bodies(const IdentifiedModel& model,
                                             const std::vector<Recording>& recordings) {
  if (FLAGS_restoration.empty() && !FLAGS_peer.empty()) {
    return Error{"--peer needs --restoration to be compared with"};
  }
  if (FLAGS_restoration.empty()) return std::optional<BodyEvaluation>();
  const Result<std::unique_ptr<Restoration>> restoration =
      LoadFlaggedRestoration(RodMoves(model.options));
  if (!restoration.ok()) return restoration.error();
  const Result<PostprocessOptions> postprocess = PostprocessOfFlags();
  if (!postprocess.ok()) return postprocess.error();
  const Result<std::vector<BodyRecording>> bodies = MakeBodyRecordings(recordings, model.mapping);
  if (!bodies.ok()) return bodies.error();
  BodyScores scores;
  for (const BodyRecording& body : bodies.value()) {
    ScoreRestoration(model, *restoration.value(), postprocess.value(), body, &scores);
  }
  if (!FLAGS_peer.empty()) {
    const Result<SimlpeWeights> simlpe = LoadSimlpe(FLAGS_peer);
    if (!simlpe.ok()) return simlpe.error();
    for (const BodyRecording& body : bodies.value()) ScoreSimlpe(simlpe.value(), body, &scores);
  }
  return std::optional<BodyEvaluation>(SummarizeAll(bodies.value(), scores));
}

int Run() {
  const Result<IdentifiedModel> model = LoadFlaggedModel();
  if (!model.ok()) return Fail(model.error());
  if (!FLAGS_json_out.empty()) {
    if (MaybeError error = CheckWritable(FLAGS_json_out)) return Fail(*error);
  }
  const Result<std::vector<Recording>> recordings =
      LoadFlaggedRecordings({}, !FLAGS_restoration.empty());
  if (!recordings.ok()) return Fail(recordings.error());
  const Result<std::optional<BodyEvaluation>> bodies = Bodies(model.value(), recordings.value());
  if (!bodies.ok()) return Fail(bodies.error());
  const Evaluation evaluation =
      Evaluate(model.value(), MakePendulumRecordings(recordings.value(), model.value().mapping));
  std::printf("%s", EvaluationText(evaluation, FLAGS_per_recording).c_str());
  nlohmann::ordered_json json = ToJson(evaluation);
  if (bodies.value()) {
    std::printf("\n%s", BodyText(*bodies.value()).c_str());
    AddBodyJson(*bodies.value(), &json);
  }
  if (!FLAGS_json_out.empty()) {
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
