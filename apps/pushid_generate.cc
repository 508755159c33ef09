// apps: pushid-generate: motion continued by a learned generator, judged and shown.
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "apps/flags/command_line.h"
#include "apps/flags/generate_flags.h"
#include "apps/flags/recording_flags.h"
#include "apps/generate_groups.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "datasets/files/number_text.h"
#include "datasets/files/random.h"
#include "ident/bodies/body_report.h"
#include "ident/generators/forecast_scene.h"
#include "ident/generators/forecast_spread.h"
#include "ident/generators/path_search.h"

namespace {

using namespace pushid;
using Json = nlohmann::ordered_json;

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// All windows are forecast together, in pieces that fit the memory.
constexpr size_t kTogether = 64;

std::vector<Trajectories> Forecasts(const MotionGenerator& generator,
                                    const std::vector<ForecastWindow>& windows) {
  std::vector<Trajectories> all;
  for (size_t i = 0; i < windows.size(); i += kTogether) {
    std::vector<ObservedMotion> people;
    for (size_t k = i; k < std::min(i + kTogether, windows.size()); ++k) {
      people.push_back({windows[k].observed});
    }
    for (Trajectories& motion : generator.Forecast(people, kForecastFrames)) {
      all.push_back(std::move(motion));
    }
  }
  return all;
}

std::vector<std::vector<SampledFuture>> Samples(const MotionGenerator& generator,
                                                const std::vector<ForecastWindow>& windows,
                                                const GenerateFlags& flags) {
  Random random(flags.seed);
  const NormalSource normal = [&random] { return random.Normal(); };
  ProgressLine line;
  std::vector<std::vector<SampledFuture>> all;
  for (const ForecastWindow& window : windows) {
    all.push_back(
        generator.Sample({{window.observed}}, kForecastFrames, flags.samples, normal).front());
    line.Show("sampling futures: window " + std::to_string(all.size()) + " of " +
              std::to_string(windows.size()));
  }
  line.Finish();
  return all;
}

MaybeError Show(const ForecastScene& scene, const GenerateFlags& flags) {
  if (!flags.poses_out.empty()) {
    const auto files = WritePoses(flags.poses_out, scene);
    if (!files.ok()) return files.error();
    for (const std::string& file : files.value()) std::printf("%s\n", file.c_str());
  }
  const auto write = [](const std::string& file, const std::string& content) -> MaybeError {
    if (MaybeError error = WriteFileAtomically(file, content)) return error;
    std::printf("%s\n", file.c_str());
    return std::nullopt;
  };
  if (!flags.strip_out.empty()) {
    if (MaybeError error = write(flags.strip_out, ForecastStripSvg(scene, flags.poses)))
      return error;
  }
  return flags.page_out.empty() ? std::nullopt : write(flags.page_out, ForecastPageHtml(scene));
}

// The windows of one action, all of the first where none is named.
Result<size_t> FindWindow(const std::vector<ForecastWindow>& windows, const std::string& action,
                          int number) {
  int found = 0;
  std::string of = action.empty() ? windows.front().action : action;
  for (size_t i = 0; i < windows.size(); ++i) {
    if (windows[i].action == of && found++ == number) return i;
  }
  return Error{"there are " + std::to_string(found) + " windows of " + Quoted(of) +
               "; --window and --target_window count them from 0 on"};
}

// The scene's forecast becomes the most probable path to the target; its outcome goes to `json`.
MaybeError SearchPath(const MotionGenerator& generator, const GenerateFlags& flags,
                      const Eigen::VectorXf& target, ForecastScene* scene, Json* json) {
  scene->title += ", towards the end of window " + std::to_string(flags.target_window);
  if (flags.samples == 0) {
    const Result<MinimizedPath> path =
        PathToPose(generator, {scene->observed}, kForecastFrames, target);
    if (!path.ok()) return path.error();
    const MinimizedPath& found = path.value();
    (*json)["path"] = {{"distance_m", found.distance},
                       {"log_likelihood", found.log_likelihood},
                       {"log_likelihood_of_forecast", found.of_forecast},
                       {"iterations", found.iterations}};
    std::printf(
        "the most probable path to the end of window %d, %s m from it: log likelihood %s, of the "
        "forecast %s (%d iterations)\n",
        flags.target_window, Rounded(found.distance, 3).c_str(),
        Rounded(found.log_likelihood, 4).c_str(), Rounded(found.of_forecast, 4).c_str(),
        found.iterations);
    scene->forecast = found.motion;
    return std::nullopt;
  }
  const Result<PathChoice> path =
      MostProbablePath(scene->futures, target, flags.target_distance, scene->layout);
  if (!path.ok()) return path.error();
  const PathChoice& choice = path.value();
  (*json)["path"] = {{"future", choice.future + 1},
                     {"near", choice.near},
                     {"distance_m", choice.distance},
                     {"log_likelihood", choice.log_likelihood}};
  std::printf("%d of %d futures end near window %d; the most probable is the %d., %s m from it\n",
              choice.near, flags.samples, flags.target_window, choice.future + 1,
              Rounded(choice.distance, 3).c_str());
  scene->forecast = scene->futures[choice.future].motion;
  return std::nullopt;
}

// The window's forecast and futures; of a search its outcome goes to `json`.
Result<ForecastScene> SceneOf(const LoadedGenerator& loaded, const GenerateFlags& flags,
                              const std::vector<ForecastWindow>& windows, Json* json) {
  const Result<size_t> at = FindWindow(windows, flags.action, flags.window);
  if (!at.ok()) return at.error();
  const ForecastWindow& window = windows[at.value()];
  ForecastScene scene;
  scene.dt = 1.0 / loaded.settings.rate;
  scene.layout = loaded.settings.layout;
  scene.title = window.action + ", window " + std::to_string(flags.window);
  scene.observed = window.observed;
  scene.recorded = window.future;
  scene.forecast = loaded.generator->Forecast({{window.observed}}, kForecastFrames).front();
  if (flags.samples > 0) {
    Random random(flags.seed);
    const NormalSource normal = [&random] { return random.Normal(); };
    scene.futures =
        loaded.generator->Sample({{window.observed}}, kForecastFrames, flags.samples, normal)
            .front();
  }
  if (flags.target_window < 0) return scene;
  const Result<size_t> target = FindWindow(windows, flags.action, flags.target_window);
  if (!target.ok()) return target.error();
  const Eigen::VectorXf end = windows[target.value()].future.rightCols(1);
  if (MaybeError error = SearchPath(*loaded.generator, flags, end, &scene, json)) return *error;
  return scene;
}

int FromClips(const LoadedGenerator& loaded, const GenerateFlags& flags) {
  const Result<MocapFolder> mocap = ReadMocapFolder(flags.folder);
  if (!mocap.ok()) return Fail(mocap.error());
  const ParticleLayout& layout = loaded.settings.layout;
  if (mocap.value().skeleton.layout.names != layout.names) {
    return Fail(Error{"these clips have " +
                          std::to_string(mocap.value().skeleton.layout.num_particles()) +
                          " particles, other ones than the " +
                          std::to_string(layout.num_particles()) + " that the generator knows",
                      flags.folder});
  }
  const auto windows = MakeForecastWindows(mocap.value(), flags.protocol, flags.stride);
  if (windows.empty()) {
    return Fail(
        Error{"no clip of --protocol=" + NameOf(flags.protocol) + " is long enough for a window",
              flags.folder});
  }
  const double before = Now();
  const ForecastErrors errors = ErrorsOf(windows, Forecasts(*loaded.generator, windows), layout);
  const double per_window = (Now() - before) / static_cast<double>(windows.size());
  std::printf("%s", ForecastErrorsText(errors).c_str());
  Json json = {{"version", Version()}, {"configuration", EffectiveFlags()}};
  json.update(ToJson(errors));
  json["baselines"]["zero_velocity"] = ToJson(ErrorsOf(windows, ZeroVelocity(windows), layout));
  if (flags.samples > 0 && flags.target_window < 0) {
    const ForecastSpread spread =
        SpreadOf(windows, Samples(*loaded.generator, windows, flags), layout);
    std::printf("\n%s", ForecastSpreadText(spread).c_str());
    AddSpreadJson(spread, &json);
  }
  if (flags.Shows() || flags.target_window >= 0) {
    const Result<ForecastScene> scene = SceneOf(loaded, flags, windows, &json);
    if (!scene.ok()) return Fail(scene.error());
    if (MaybeError error = Show(scene.value(), flags)) return Fail(*error);
  }
  json["run"] = {{"seconds_per_window", per_window}};
  if (flags.json_out.empty()) return kDone;
  if (MaybeError error = WriteJson(flags.json_out, json)) return Fail(*error);
  return kDone;
}

Result<ForecastScene> SceneOf(const LoadedGenerator& loaded, const GenerateFlags& flags,
                              const BodyRecording& recording) {
  if (flags.person >= recording.num_people()) {
    return Error{"recording " + recording.pendulum.id + " has " +
                 std::to_string(recording.num_people()) + " people; --person counts from 0 on"};
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
                    const BodyRecording& recording, const std::optional<IdentifiedModel>& physics) {
  if (loaded.kind == GeneratorKind::kDiffusion) {
    const Result<std::vector<std::string>> files = ShowGroup(loaded, flags, recording, physics);
    if (!files.ok()) return files.error();
    for (const std::string& file : files.value()) std::printf("%s\n", file.c_str());
    return std::nullopt;
  }
  const Result<ForecastScene> scene = SceneOf(loaded, flags, recording);
  return scene.ok() ? Show(scene.value(), flags) : MaybeError(scene.error());
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
    return Fail(Error{"--id is '" + flags.id + "', no recording of these"});
  }
  double seconds = 0.0;
  for (const BodyRecording& recording : bodies.value()) {
    const double before = Now();
    const auto generated = GenerateWith(loaded, recording, physics.value());
    if (!generated.ok()) return Fail(generated.error());
    seconds += (Now() - before) / static_cast<double>(bodies.value().size());
    scores["generator"].push_back(ScoreBodies(recording, generated.value()));
    scores["static"].push_back(ScoreBodies(recording, StaticBodies(recording)));
    scores["constant_velocity"].push_back(
        ScoreBodies(recording, ConstantVelocityBodies(recording)));
  }
  const BodyEvaluation evaluation = SummarizeAll(bodies.value(), scores);
  std::printf("%s", BodyText(evaluation).c_str());
  if (flags.Shows()) {
    if (MaybeError error = ShowPush(loaded, flags, *shown, physics.value())) return Fail(*error);
  }
  Json json = {{"version", Version()}, {"configuration", EffectiveFlags()}};
  AddBodyJson(evaluation, &json);
  if (flags.samples > 0 && loaded.kind == GeneratorKind::kDiffusion) {
    const Result<GroupSpread> spread = SpreadOf(loaded, flags, bodies.value(), physics.value());
    if (!spread.ok()) return Fail(spread.error());
    std::printf("\n%s", SpreadText(spread.value()).c_str());
    json["spread"] = ToJson(spread.value());
  }
  if (flags.frames > 0) {
    const Result<Json> rows = ShowSeconds(loaded, bodies.value(), physics.value(), flags.frames);
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
  return data == GeneratorData::kCmu ? FromClips(loaded.value(), flags.value())
                                     : FromPushes(loaded.value(), flags.value());
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(argc, argv,
                        "pushid-generate continues observed motion by a learned generator, and "
                        "says how far it is from what was recorded.\n\n  pushid-generate "
                        "--model=generator --dataset=cmu --folder=cmu_mocap "
                        "--protocol=validation --json_out=errors.json",
                        Run);
}
