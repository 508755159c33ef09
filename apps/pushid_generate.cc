// apps: pushid-generate: motion continued by a learned generator, judged and shown.
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/flags/command_line.h"
#include "apps/flags/generate_flags.h"
#include "apps/flags/recording_flags.h"
#include "apps/generate.h"
#include "datasets/files/json_file.h"
#include "datasets/files/random.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/generators/push_particles.h"
#include "ident/problem/parallel.h"
#include "ident/validation/scores_report.h"

namespace {

using namespace pushid;
using Json = nlohmann::ordered_json;

ForecastScene SceneOfPerson(const LoadedGenerator& loaded, const GenerateFlags& flags,
                            const BodyRecording& recording) {
  if (flags.person >= recording.num_people()) {
    throw Error{"recording " + recording.pendulum.id + " has " +
                std::to_string(recording.num_people()) + " people; --person counts from 0"};
  }
  const GeneratorSettings& settings = loaded.settings;
  const ObservedMotion whole = ParticlesOf(recording, flags.person).motion;
  const int after = recording.num_frames() - settings.observed;
  const ObservedMotion person = {whole.frames.leftCols(settings.observed), whole.controls};
  ForecastScene scene;
  scene.title = recording.pendulum.id + ", " + recording.pendulum.subject_ids[flags.person];
  scene.dt = recording.pendulum.scene.dt;
  scene.layout = settings.layout;
  scene.observed = person.frames;
  scene.recorded = whole.frames.rightCols(after);
  scene.forecast = loaded.generator->Forecast({person}, after).front();
  if (flags.samples > 0) {
    Random random(flags.seed);
    scene.futures =
        loaded.generator
            ->Sample({person}, after, flags.samples, [&random] { return random.Normal(); })
            .front();
  }
  return scene;
}

// One recording as it is shown: a person of it and what particles make of that, or the whole group.
void ShowPush(const LoadedGenerator& loaded, const GenerateFlags& flags,
              const BodyRecording& recording, const std::optional<IdentifiedModel>& physics,
              const std::vector<std::string>& figures) {
  if (RowOf(loaded.kind).groups) {
    const auto files = ShowGroup(loaded, flags, recording, physics, figures);
    for (const std::string& file : files) std::printf("%s\n", file.c_str());
    return;
  }
  ShowForecast(SceneOfPerson(loaded, flags, recording), flags);
}

// Once for all recordings whose pushes are of such kinds.
void WarnOfPushKinds(const GeneratorSettings& settings,
                     const std::vector<BodyRecording>& recordings) {
  std::set<std::string> told;
  for (const BodyRecording& recording : recordings) {
    const std::string other = OtherPushKinds(settings, recording.pendulum.scene);
    if (!other.empty() && told.insert(other).second) Warn(other);
  }
}

int FromPushes(const LoadedGenerator& loaded, const GenerateFlags& flags) {
  const std::optional<IdentifiedModel> physics = LoadPhysics(flags.physics);
  const std::vector<Recording> recordings = LoadFlaggedRecordings({}, true);
  const std::vector<BodyRecording> bodies = OrFail(MakeBodyRecordings(recordings));
  BodyScores scores;
  const BodyRecording* shown = nullptr;
  for (const BodyRecording& recording : bodies) {
    if (recording.pendulum.id == flags.id) shown = &recording;
  }
  if (flags.Shows() && shown == nullptr) {
    return Fail(Error{"--id is '" + flags.id + "', which is not one of the recordings"});
  }
  WarnOfPushKinds(loaded.settings, bodies);
  const SocialCues cues = FlaggedCues(flags, bodies);
  double seconds = 0.0;
  for (const BodyRecording& recording : bodies) {
    const double before = Now();
    const auto generated = GenerateWith(loaded, recording, physics);
    seconds += (Now() - before) / static_cast<double>(bodies.size());
    const int observed = loaded.settings.observed, seen = SeenByBaselines(observed);
    const auto score = [&](const char* name, const std::vector<BodyMotion>& forecast) {
      scores[name].push_back(ScoreBodies(recording, forecast, observed));
    };
    score("generator", generated);
    if (observed > 1) {
      scores["generator_all_frames"].push_back(ScoreBodies(recording, generated));
    }
    score("static", StaticBodies(recording, seen));
    score("constant_velocity", ConstantVelocityBodies(recording, seen));
  }
  BodyEvaluation evaluation = SummarizeAll(bodies, scores);
  std::optional<SocialReport> social;
  std::vector<std::string> figures;
  if (RowOf(loaded.kind).groups) {
    social = CompareSocially(bodies, cues, &evaluation);
    if (social) figures = SocialFigures(*social, "generator");
  }
  std::printf("%s\n%s", BodyText(evaluation).c_str(), TimedErrorsText(evaluation).c_str());
  if (social) std::printf("\n%s", SocialText(*social).c_str());
  if (flags.Shows()) ShowPush(loaded, flags, *shown, physics, figures);
  Json json = ResultHead(kScoresSchema);
  AddBodyJson(evaluation, &json);
  if (social) json["social"] = ToJson(*social);
  if (flags.samples > 0 && RowOf(loaded.kind).groups) {
    const GroupSpread spread = SpreadOf(loaded, flags, bodies, physics);
    std::printf("\n%s", SpreadText(spread).c_str());
    json["spread"] = ToJson(spread);
  }
  if (flags.frames > 0) {
    json["seconds"] = ShowSeconds(loaded, bodies, physics, cues, flags.frames);
  }
  if (flags.json_out.empty()) return kDone;
  json["run"] = {{"seconds_per_recording", seconds}};
  OrFail(WriteJson(flags.json_out, json));
  return kDone;
}

int Run() {
  GenerateFlags flags = GenerateFlagsFromCommandLine();
  LoadedGenerator loaded = OrFail(LoadGenerator(flags.model, flags.changes));
  CheckKindFlags(flags, loaded.kind);
  TakeChoice(&flags, &loaded);
  if (flags.observed > 0) loaded.settings.observed = flags.observed;
  const GeneratorData data = loaded.settings.data;
  if (data != flags.data) {
    return Fail(
        Error{"this generator forecasts " + NameOf(data) + "; give --dataset=" + NameOf(data),
              flags.model});
  }
  return data == GeneratorData::kCmu ? GenerateFromClips(loaded, flags) : FromPushes(loaded, flags);
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(argc, argv,
                        "pushid-generate continues observed motion with a learned generator and "
                        "reports the error against the recording.\n\n"
                        "  pushid-generate --model=generator --dataset=cmu --folder=cmu_mocap "
                        "--protocol=validation --json_out=errors.json",
                        Run);
}
