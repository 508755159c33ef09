// apps: pushid-generate: motion continued by a learned generator, judged and shown.
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/flags/command_line.h"
#include "apps/flags/generate_flags.h"
#include "apps/flags/recording_flags.h"
#include "apps/generate.h"
#include "datasets/files/json_file.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/generators/push_particles.h"
#include "ident/problem/parallel.h"
#include "ident/validation/scores_report.h"

namespace {

using namespace pushid;
using Json = nlohmann::ordered_json;

// Once for all recordings whose pushes are of such kinds.
void WarnOfPushKinds(const GeneratorSettings& settings,
                     const std::vector<BodyRecording>& recordings) {
  std::set<std::string> told;
  for (const BodyRecording& recording : recordings) {
    const std::string other = OtherPushKinds(settings, recording.pendulum.scene);
    if (!other.empty() && told.insert(other).second) Warn(other);
  }
}

int FromGroups(const LoadedGenerator& loaded, const GenerateFlags& flags) {
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
  const std::optional<SocialReport> social = CompareSocially(bodies, cues, &evaluation);
  std::printf("%s\n%s", BodyText(evaluation).c_str(), TimedErrorsText(evaluation).c_str());
  if (social) std::printf("\n%s", SocialText(*social).c_str());
  if (flags.Shows()) {
    const std::vector<std::string> figures =
        social ? SocialFigures(*social, "generator") : std::vector<std::string>();
    for (const std::string& file : ShowGroup(loaded, flags, *shown, physics, figures)) {
      std::printf("%s\n", file.c_str());
    }
  }
  Json json = ResultHead(kScoresSchema);
  AddBodyJson(evaluation, &json);
  if (social) json["social"] = ToJson(*social);
  if (flags.json_out.empty()) return kDone;
  json["run"] = {{"seconds_per_recording", seconds}};
  OrFail(WriteJson(flags.json_out, json));
  return kDone;
}

int Run() {
  const GenerateFlags flags = GenerateFlagsFromCommandLine();
  LoadedGenerator loaded = OrFail(LoadGenerator(flags.model, flags.changes));
  CheckKindFlags(flags, loaded.kind);
  if (flags.observed > 0) loaded.settings.observed = flags.observed;
  return RowOf(loaded.kind).groups ? FromGroups(loaded, flags) : GenerateFromClips(loaded, flags);
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(argc, argv,
                        "pushid-generate continues observed motion with a learned generator and "
                        "reports the error against the recording.\n\n"
                        "  pushid-generate --model=generator --folder=cmu_mocap "
                        "--protocol=validation --json_out=errors.json",
                        Run);
}
