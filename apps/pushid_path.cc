// apps: pushid-path: most probable paths under a model's process noise, and smoothed recordings.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/flags/command_line.h"
#include "apps/flags/model_flags.h"
#include "apps/flags/path_flags.h"
#include "apps/flags/recording_flags.h"
#include "datasets/files/json_file.h"
#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"

namespace {

using namespace pushid;

nlohmann::ordered_json ActionJson(const ProbablePath& path) {
  return {{"action", path.action()},
          {"noise_action", path.noise_action},
          {"divergence_action", path.divergence_action}};
}

// The CSV of the path and the JSON.
int Write(const PathFlags& flags, const ProbablePath& path, double dt,
          nlohmann::ordered_json json) {
  if (!flags.out.empty()) {
    if (MaybeError error = WritePathCsv(flags.out, path, dt)) return Fail(*error);
    std::printf("%d frames written to %s\n", path.states.num_frames(), flags.out.c_str());
  }
  if (flags.json_out.empty()) return kDone;
  json["version"] = Version();
  json["configuration"] = EffectiveFlags();
  if (MaybeError error = WriteJson(flags.json_out, json)) return Fail(*error);
  return kDone;
}

int Between(const PathFlags& flags, const IdentifiedModel& model) {
  TextTable table({"end", "action", "of noise", "of divergence"}, {true, false, false, false});
  nlohmann::ordered_json json;
  size_t best = 0;
  std::vector<ProbablePath> paths;
  for (size_t i = 0; i < flags.to.size(); ++i) {
    Result<ProbablePath> path =
        PathBetween(model, flags.body, flags.fps, flags.from, flags.to[i], flags.frames);
    if (!path.ok()) return Fail(path.error());
    const ProbablePath& found = path.value();
    table.Add({flags.end_names[i], Rounded(found.action(), 4), Rounded(found.noise_action, 4),
               Rounded(found.divergence_action, 4)});
    nlohmann::ordered_json one = ActionJson(found);
    one["end"] = flags.end_names[i];
    json["paths"].push_back(one);
    paths.push_back(std::move(path.value()));
    if (paths[i].action() < paths[best].action()) best = i;
  }
  json["most_probable"] = flags.end_names[best];
  std::printf("%s", table.ToString().c_str());
  if (paths.size() > 1) {
    std::printf("most probable: %s\n", flags.end_names[best].c_str());
  }
  std::printf(
      "action: -log probability density of the path, up to a constant that depends on its "
      "frames\n");
  return Write(flags, paths[best], 1.0 / flags.fps, json);
}

int Smooth(const PathFlags& flags, const IdentifiedModel& model) {
  const Result<std::vector<Recording>> recordings = LoadFlaggedRecordings({flags.id});
  if (!recordings.ok()) return Fail(recordings.error());
  const PendulumRecording recording =
      MakePendulumRecording(recordings.value().front(), model.mapping);
  const Result<ProbablePath> path = SmoothPath(model, recording);
  if (!path.ok()) return Fail(path.error());
  const ProbablePath& found = path.value();
  double furthest = 0.0;
  for (int n = 0; n < recording.num_people(); ++n) {
    for (int t = 0; t < recording.num_frames(); ++t) {
      if (recording.Weight(n, t) <= 0.0) continue;
      const Vector4<double> apart = found.states.At(t, n).q - recording.states[n][t].q;
      furthest = std::max(furthest, apart.head<2>().norm());
    }
  }
  std::printf("%s: %d frames smoothed; action %s, measurements %s; feet moved by up to %s mm\n",
              recording.id.c_str(), recording.num_frames(), Rounded(found.action(), 4).c_str(),
              Rounded(found.measurement_cost, 4).c_str(), Rounded(1e3 * furthest, 3).c_str());
  nlohmann::ordered_json json = ActionJson(found);
  json["recording"] = recording.id;
  json["measurement_cost"] = found.measurement_cost;
  return Write(flags, found, recording.scene.dt, json);
}

int Run() {
  const Result<PathFlags> flags = PathFlagsFromCommandLine();
  if (!flags.ok()) return Fail(flags.error());
  const Result<IdentifiedModel> model = LoadFlaggedModel();
  if (!model.ok()) return Fail(model.error());
  return flags.value().between ? Between(flags.value(), model.value())
                               : Smooth(flags.value(), model.value());
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(
      argc, argv,
      "pushid-path finds the most probable path of a person between two states, and smooths "
      "recordings.\n\n  pushid-path --model=model.json --from=xd=0.5 --to='x=0.4,xd=0; x=0.8,xd=0' "
      "--frames=90 --out=path.csv\n  pushid-path --model=model.json "
      "--recordings=M/manifest.json --id=NAME --out=states.csv",
      Run);
}
