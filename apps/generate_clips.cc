// apps: windows of clips forecast and sampled, and paths to a pose.
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/flags/command_line.h"
#include "apps/generate.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "datasets/files/number_text.h"
#include "datasets/files/random.h"
#include "ident/forecasts/forecast_scene.h"
#include "ident/forecasts/forecast_spread.h"
#include "ident/parameters/option_names.h"
#include "ident/problem/parallel.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

// All windows are forecast together, in pieces that fit the memory.
constexpr size_t kTogether = 64;
constexpr double kTargetDistance = 0.05;  // m; what counts as near the target of a path

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

// The windows of one action, all of the first where none is named.
size_t FindWindow(const std::vector<ForecastWindow>& windows, const std::string& action,
                  int number) {
  int found = 0;
  std::string of = action.empty() ? windows.front().action : action;
  for (size_t i = 0; i < windows.size(); ++i) {
    if (windows[i].action == of && found++ == number) return i;
  }
  throw Error{"there are " + std::to_string(found) + " windows of " + Quoted(of) +
              "; --window and --target_window count from 0"};
}

// The scene's forecast becomes the most probable path to the target; its outcome goes to `json`.
void SearchPath(const GenerateFlags& flags, const Eigen::VectorXf& target, ForecastScene* scene,
                Json* json) {
  scene->title += ", towards the end of window " + std::to_string(flags.target_window);
  const PathChoice choice =
      OrFail(MostProbablePath(scene->futures, target, kTargetDistance, scene->layout));
  (*json)["path"] = {{"future", choice.future + 1},
                     {"near", choice.near},
                     {"distance_m", choice.distance},
                     {"log_likelihood", choice.log_likelihood}};
  std::printf("%d of %d futures end near window %d; the most probable is the %d., %s m from it\n",
              choice.near, flags.samples, flags.target_window, choice.future + 1,
              Rounded(choice.distance, 3).c_str());
  scene->forecast = scene->futures[choice.future].motion;
}

// The window's forecast and futures; of a search its outcome goes to `json`.
ForecastScene SceneOfWindow(const LoadedGenerator& loaded, const GenerateFlags& flags,
                            const std::vector<ForecastWindow>& windows, Json* json) {
  const size_t at = FindWindow(windows, flags.action, flags.window);
  const ForecastWindow& window = windows[at];
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
  const size_t target = FindWindow(windows, flags.action, flags.target_window);
  const Eigen::VectorXf end = windows[target].future.rightCols(1);
  SearchPath(flags, end, &scene, json);
  return scene;
}

// What --poses_out, --svg_out and --html_out ask for; their names go to stdout.
void ShowForecast(const ForecastScene& scene, const GenerateFlags& flags) {
  if (!flags.poses_out.empty()) {
    const auto files = OrFail(WritePoses(flags.poses_out, scene));
    for (const std::string& file : files) std::printf("%s\n", file.c_str());
  }
  const auto write = [](const std::string& file, const std::string& content) {
    OrFail(WriteFileAtomically(file, content));
    std::printf("%s\n", file.c_str());
  };
  if (!flags.svg_out.empty()) write(flags.svg_out, ForecastStripSvg(scene, kStripPoses));
  if (!flags.html_out.empty()) write(flags.html_out, ForecastPageHtml(scene));
}

}  // namespace

int GenerateFromClips(const LoadedGenerator& loaded, const GenerateFlags& flags) {
  const MocapFolder mocap = OrFail(ReadMocapFolder(flags.folder));
  const ParticleLayout& layout = loaded.settings.layout;
  if (mocap.skeleton.layout.names != layout.names) {
    return Fail(Error{"these clips have " + std::to_string(mocap.skeleton.layout.num_particles()) +
                          " particles, which are not the " +
                          std::to_string(layout.num_particles()) + " particles of the generator",
                      flags.folder});
  }
  const auto windows =
      MakeForecastWindows(mocap, flags.protocol, flags.protocol == ForecastProtocol::kAll ? 8 : 0);
  if (windows.empty()) {
    return Fail(
        Error{"no clip of --protocol=" + NameOf(flags.protocol) + " is long enough for a window",
              flags.folder});
  }
  const double before = Now();
  const ForecastErrors errors = ErrorsOf(windows, Forecasts(*loaded.generator, windows), layout);
  const double per_window = (Now() - before) / static_cast<double>(windows.size());
  std::printf("%s", ForecastErrorsText(errors).c_str());
  Json json = ResultHead("pushid-forecasts/1");
  json.update(ToJson(errors));
  json["baselines"]["zero_velocity"] = ToJson(ErrorsOf(windows, ZeroVelocity(windows), layout));
  if (flags.samples > 0 && flags.target_window < 0) {
    const ForecastSpread spread =
        SpreadOf(windows, Samples(*loaded.generator, windows, flags), layout);
    std::printf("\n%s", ForecastSpreadText(spread).c_str());
    AddSpreadJson(spread, &json);
  }
  if (flags.Shows() || flags.target_window >= 0) {
    const ForecastScene scene = SceneOfWindow(loaded, flags, windows, &json);
    ShowForecast(scene, flags);
  }
  json["run"] = {{"seconds_per_window", per_window}};
  if (flags.json_out.empty()) return kDone;
  OrFail(WriteJson(flags.json_out, json));
  return kDone;
}

}  // namespace pushid
