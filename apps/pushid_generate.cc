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

Result<ForecastScene> SceneOfPerson(const LoadedGenerator& loaded, const GenerateFlags& flags,
                                    const BodyRecording& recording) {
  if (flags.person >= recording.num_people()) {
    return Error{"recording " + recording.pendulum.id + " has " +
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
MaybeError ShowPush(const LoadedGenerator& loaded, const GenerateFlags& flags,
                    const BodyRecording& recording, const std::optional<IdentifiedModel>& physics,
                    const std::vector<std::string>& figures) {
  if (RowOf(loaded.kind).groups) {
    const auto files = ShowGroup(loaded, flags, recording, physics, figures);
    if (!files.ok()) return files.error();
    for (const std::string& file : files.value()) std::printf("%s\n", file.c_str());
    return std::nullopt;
  }
  const Result<ForecastScene> scene = SceneOfPerson(loaded, flags, recording);
  return scene.ok() ? ShowForecast(scene.value(), flags) : MaybeError(scene.error());
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
  const Result<std::optional<IdentifiedModel>> physics = LoadPhysics(flags.physics);
  if (!physics.ok()) return Fail(physics.error());
  const Result<std::vector<Recording>> recordings = LoadFlaggedRecordings({}, true);
  if (!recordings.ok()) return Fail(recordings.error());
  const Result<std::vector<BodyRecording>> bodies =
      MakeBodyRecordings(recordings.value(), SkeletonMapping::kExact);
  if (!bodies.ok()) return Fail(bodies.error());
  BodyScores scores;
  const BodyRecording* shown = nullptr;
  for (const BodyRecording& recording : bodies.value()) {
    if (recording.pendulum.id == flags.id) shown = &recording;
  }
  if (flags.Shows() && shown == nullptr) {
    return Fail(Error{"--id is '" + flags.id + "', which is not one of the recordings"});
  }
  WarnOfPushKinds(loaded.settings, bodies.value());
  const Result<SocialCues> cues = FlaggedCues(flags, bodies.value());
  if (!cues.ok()) return Fail(cues.error());
  double seconds = 0.0;
  for (const BodyRecording& recording : bodies.value()) {
    const double before = Now();
    const auto generated = GenerateWith(loaded, recording, physics.value());
    if (!generated.ok()) return Fail(generated.error());
    seconds += (Now() - before) / static_cast<double>(bodies.value().size());
    const int observed = loaded.settings.observed, seen = SeenByBaselines(observed);
    const auto score = [&](const char* name, const std::vector<BodyMotion>& forecast) {
      scores[name].push_back(ScoreBodies(recording, forecast, observed));
    };
    score("generator", generated.value());
    if (observed > 1) {
      scores["generator_all_frames"].push_back(ScoreBodies(recording, generated.value()));
    }
    score("static", StaticBodies(recording, seen));
    score("constant_velocity", ConstantVelocityBodies(recording, seen));
  }
  BodyEvaluation evaluation = SummarizeAll(bodies.value(), scores);
  std::optional<SocialReport> social;
  std::vector<std::string> figures;
  if (RowOf(loaded.kind).groups) {
    social = CompareSocially(bodies.value(), cues.value(), &evaluation);
    if (social) figures = SocialFigures(*social, "generator");
  }
  std::printf("%s\n%s", BodyText(evaluation).c_str(), TimedErrorsText(evaluation).c_str());
  if (social) std::printf("\n%s", SocialText(*social).c_str());
  if (flags.Shows()) {
    if (MaybeError error = ShowPush(loaded, flags, *shown, physics.value(), figures)) {
      return Fail(*error);
    }
  }
  Json json = ResultHead(kScoresSchema);
  AddBodyJson(evaluation, &json);
  if (social) json["social"] = ToJson(*social);
  if (flags.samples > 0 && RowOf(loaded.kind).groups) {
    const Result<GroupSpread> spread = SpreadOf(loaded, flags, bodies.value(), physics.value());
    if (!spread.ok()) return Fail(spread.error());
    std::printf("\n%s", SpreadText(spread.value()).c_str());
    json["spread"] = ToJson(spread.value());
  }
  if (flags.frames > 0) {
    const Result<Json> rows =
        ShowSeconds(loaded, bodies.value(), physics.value(), cues.value(), flags.frames);
    if (!rows.ok()) return Fail(rows.error());
    json["seconds"] = rows.value();
  }
  if (flags.json_out.empty()) return kDone;
  json["run"] = {{"seconds_per_recording", seconds}};
  if (MaybeError error = WriteJson(flags.json_out, json)) return Fail(*error);
  return kDone;
}

int Run() {
  Result<GenerateFlags> flags = GenerateFlagsFromCommandLine();
  if (!flags.ok()) return Fail(flags.error());
  Result<LoadedGenerator> loaded = LoadGenerator(flags.value().model, flags.value().changes);
  if (!loaded.ok()) return Fail(loaded.error());
  if (MaybeError error = CheckKindFlags(flags.value(), loaded.value().kind)) return Fail(*error);
  if (MaybeError error = TakeChoice(&flags.value(), &loaded.value())) return Fail(*error);
  if (flags.value().observed > 0) loaded.value().settings.observed = flags.value().observed;
  const GeneratorData data = loaded.value().settings.data;
  if (data != flags.value().data) {
    return Fail(
        Error{"this generator forecasts " + NameOf(data) + "; give --dataset=" + NameOf(data),
              flags.value().model});
  }
  return data == GeneratorData::kCmu ? GenerateFromClips(loaded.value(), flags.value())
                                     : FromPushes(loaded.value(), flags.value());
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
