// apps: pushid-evaluate: how far a model's predictions are from recordings, beside the baselines.
#include <gflags/gflags.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/flags/body_flags.h"
#include "apps/flags/command_line.h"
#include "apps/flags/futures_flags.h"
#include "apps/flags/model_flags.h"
#include "apps/flags/recording_flags.h"
#include "apps/support/app_support.h"
#include "datasets/files/json_file.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/parameters/presets.h"
#include "ident/peers/peer_files.h"
#include "ident/prediction/evaluation.h"
#include "ident/prediction/prediction.h"
#include "ident/validation/held_out_spread.h"
#include "ident/validation/scores_report.h"

DEFINE_string(group_by, pushid::LabelKeysText(pushid::UsualGroups()),
              "labels that scores are grouped by: subject, or any label of the manifest");
DEFINE_string(json_out, "", "write the scores here (JSON)");
DEFINE_string(peer, "",
              "with --restoration: the folder of a peer (pushid-train-restoration "
              "--kind=mrt) to compare with");
DEFINE_bool(per_recording, true, "print a line for every recording");

namespace {

using namespace pushid;

// That of --restoration, once all flags have been checked.
Result<RestorationFlags> CheckedFlags() {
  if (MaybeError missing = RequireModel()) return *missing;
  const Result<RestorationFlags> restoration = RestorationFlagsFromCommandLine();
  if (!restoration.ok()) return restoration.error();
  for (MaybeError error : {CheckNeeds({"peer"}, {"restoration"}, " to be compared with"),
                           CheckOutputFiles({FLAGS_json_out})}) {
    if (error) return *error;
  }
  return restoration;
}

// Bodies beside pendulums, where --restoration asks for them; else nothing.
Result<std::optional<BodyEvaluation>> Bodies(const RestorationFlags& flags,
                                             const IdentifiedModel& model,
                                             const std::vector<Recording>& recordings) {
  if (!flags.given()) return std::optional<BodyEvaluation>();
  size_t people = 0;
  for (const Recording& recording : recordings) people = std::max(people, recording.people.size());
  const Result<std::unique_ptr<Restoration>> restoration =
      LoadFlaggedRestoration(flags, static_cast<int>(people));
  if (!restoration.ok()) return restoration.error();
  const Result<std::vector<BodyRecording>> bodies = MakeBodyRecordings(recordings, model.mapping);
  if (!bodies.ok()) return bodies.error();
  BodyScores scores;
  for (const BodyRecording& body : bodies.value()) {
    ScoreRestoration(model, *restoration.value(), flags.postprocess, body, &scores,
                     ObservedFrames(), ForecastUseFlag());
  }
  if (!FLAGS_peer.empty()) {
    const Result<std::unique_ptr<Peer>> peer = LoadPeer(FLAGS_peer);
    if (!peer.ok()) return peer.error();
    for (const BodyRecording& body : bodies.value()) ScorePeer(*peer.value(), body, &scores);
  }
  return std::optional<BodyEvaluation>(
      SummarizeAll(bodies.value(), scores, ParseLabelKeys(FLAGS_group_by)));
}

int Run() {
  const Result<RestorationFlags> restoration = CheckedFlags();
  if (!restoration.ok()) return Fail(restoration.error());
  const Result<FuturesFlags> drawn = FuturesFlagsFromCommandLine(false);
  if (!drawn.ok()) return Fail(drawn.error());
  if (MaybeError error = CheckObservedFlag()) return Fail(*error);
  const Result<IdentifiedModel> model = LoadFlaggedModel();
  if (!model.ok()) return Fail(model.error());
  if (MaybeError error = CheckDraws(drawn.value(), model.value())) return Fail(*error);
  const Result<std::vector<Recording>> recordings =
      LoadFlaggedRecordings({}, restoration.value().given() || NeedsJoints(model.value().options));
  if (!recordings.ok()) return Fail(recordings.error());
  const std::vector<PendulumRecording> pendulums =
      MakePendulumRecordings(recordings.value(), model.value().mapping);
  if (MaybeError error = CheckObservedFlag(pendulums, model.value())) return Fail(*error);
  const LabelKeys group_by = ParseLabelKeys(FLAGS_group_by);
  if (MaybeError error = CheckGroups(pendulums, group_by)) return Fail(*error);
  const Result<std::optional<BodyEvaluation>> bodies =
      Bodies(restoration.value(), model.value(), recordings.value());
  if (!bodies.ok()) return Fail(bodies.error());
  WarnGrouped(InputWarnings(model.value(), pendulums));
  const Evaluation evaluation =
      Evaluate(model.value(), pendulums, ObservedFrames(), group_by, ForecastUseFlag());
  std::printf("%s", EvaluationText(evaluation, FLAGS_per_recording).c_str());
  std::printf("\n%s", StepsReport(pendulums, FLAGS_per_recording).c_str());
  nlohmann::ordered_json json = ResultHead(kScoresSchema);
  json.update(ToJson(evaluation));
  if (const int draws = drawn.value().samples; draws > 0) {
    const auto futures = EvaluateFutures(model.value(), pendulums, draws, drawn.value().seed);
    if (!futures.ok()) return Fail(futures.error());
    std::printf("\n%s", FuturesText(std::vector<FuturesSummary>{futures.value()}).c_str());
    json["futures"] = ToJson(futures.value());
  }
  AddStepsJson(pendulums, &json);
  if (bodies.value()) {
    std::printf("\n%s", BodyText(*bodies.value()).c_str());
    AddBodyJson(*bodies.value(), &json);
  }
  if (!FLAGS_json_out.empty()) {
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
