// apps: pushid-evaluate: how far a model's predictions are from recordings, beside the baselines.
#include <set>

#include "apps/flags/command_line.h"
#include "apps/flags/futures_flags.h"
#include "apps/flags/model_flags.h"
#include "apps/flags/observed_flags.h"
#include "apps/flags/recording_flags.h"
#include "apps/flags/restoration_flags.h"
#include "datasets/files/json_file.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/formations/formation_run.h"
#include "ident/parameters/presets.h"
#include "ident/prediction/predicted_steps.h"
#include "ident/prediction/prediction.h"
#include "ident/validation/scores_report.h"

DEFINE_string(group_by, pushid::LabelKeysText(pushid::UsualGroups()),
              "labels that scores are grouped by: subject, or any label of the manifest");
DEFINE_string(json_out, "", "write the scores here (JSON)");
DEFINE_bool(details, false, "print all tables instead of one screen");
DEFINE_bool(per_recording, false, "print all tables, and a line and the steps of every recording");

namespace {

using namespace pushid;

// Evaluates bodies beside pendulums, where --restoration asks for them.
std::optional<BodyEvaluation> Bodies(const RestorationFlags& flags, const IdentifiedModel& model,
                                     const std::vector<Recording>& recordings) {
  if (!flags.given()) return std::nullopt;
  size_t people = 0;
  for (const Recording& recording : recordings) people = std::max(people, recording.people.size());
  const std::unique_ptr<Restoration> restoration =
      LoadFlaggedRestoration(flags, static_cast<int>(people));
  const std::vector<BodyRecording> bodies = OrFail(MakeBodyRecordings(recordings));
  BodyScores scores;
  for (const BodyRecording& body : bodies) {
    ScoreRestoration(model, *restoration, flags.postprocess, body, &scores, ObservedFrames(),
                     ForecastUseFlag());
  }
  return SummarizeAll(bodies, scores, ParseLabelKeys(FLAGS_group_by));
}

// Whether errors are of recordings that the model was fitted to, which predictions of new ones are
// not; empty where they are not.
std::string FittedText(const FittedModel& model, const std::vector<PendulumRecording>& recordings) {
  std::set<std::string> fitted;
  for (const FittedRecording& r : model.fit.recordings) fitted.insert(r.content_hash);
  const auto among = std::count_if(recordings.begin(), recordings.end(), [&](const auto& r) {
    return !r.content_hash.empty() && fitted.count(r.content_hash) > 0;
  });
  if (among == 0) return "";
  return " The model was fitted to " + std::to_string(among) + " of the " +
         std::to_string(recordings.size()) +
         " recordings; pushid-crossvalidate has the errors on recordings left out of the fit.";
}

int Run() {
  RequireModel();
  const RestorationFlags restoration = RestorationFlagsFromCommandLine();
  OrFail(CheckOutputFiles({FLAGS_json_out}));
  const int drawn = DrawnFutures();
  CheckObservedFlag();
  const IdentifiedModel model = LoadFlaggedModel();
  CheckDraws(model);
  const std::vector<Recording> recordings =
      LoadFlaggedRecordings({}, restoration.given() || NeedsJoints(model.options));
  const std::vector<PendulumRecording> pendulums = MakePendulumRecordings(recordings);
  CheckObservedFlag(pendulums, &model);
  const LabelKeys group_by = ParseLabelKeys(FLAGS_group_by);
  OrFail(CheckGroups(pendulums, group_by));
  const std::optional<BodyEvaluation> bodies = Bodies(restoration, model, recordings);
  WarnGrouped(InputWarnings(model, pendulums));
  const Evaluation evaluation = Evaluate(model, pendulums, ObservedFrames(), group_by,
                                         ForecastUseFlag(), {drawn, kFuturesSeed});
  const FittedModel fitted = OrFail(ReadFittedModel(ModelFile()));
  const std::string person = PersonText(fitted.fit, model, pendulums);
  const std::string steps = StepsReport(pendulums, FLAGS_per_recording);
  if (FLAGS_details || FLAGS_per_recording) {
    std::printf("%s\n%s%s%s", EvaluationText(evaluation, FLAGS_per_recording).c_str(),
                steps.c_str(), TextLines(person).c_str(),
                bodies ? ("\n" + BodyText(*bodies)).c_str() : "");
  } else {
    Screen screen = EvaluationScreen(evaluation);
    screen.verdict += FittedText(fitted, pendulums);
    screen.paragraphs.insert(screen.paragraphs.end(), {steps, person});
    if (bodies) screen.tables.push_back(BodyTable(*bodies));
    std::printf("%s", screen.ToString().c_str());
  }
  nlohmann::ordered_json json = ResultHead(kScoresSchema);
  json.update(ToJson(evaluation));
  AddStepsJson(pendulums, &json);
  if (!person.empty()) json["person"] = person;
  if (bodies) AddBodyJson(*bodies, &json);
  WriteIfNamed(FLAGS_json_out, json);
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(
      argc, argv,
      "pushid-evaluate measures the errors of a model's predictions, beside two baselines.\n"
      "  pushid-evaluate --model=model.json --recordings=held-out/manifest.json "
      "--json_out=scores.json",
      Run);
}
