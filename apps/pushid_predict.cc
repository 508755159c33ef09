// apps: pushid-predict: what happens after a push, from the first frame and the push alone.
#include "apps/flags/command_line.h"
#include "apps/flags/model_flags.h"
#include "apps/flags/observed_flags.h"
#include "apps/flags/recording_flags.h"
#include "apps/flags/restoration_flags.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/bodies/body_recording.h"
#include "ident/figures/text_table.h"
#include "ident/formations/formation_run.h"
#include "ident/model/model_rollout.h"
#include "ident/parameters/presets.h"
#include "ident/prediction/online_predictor.h"
#include "ident/prediction/predicted_steps.h"
#include "ident/prediction/prediction.h"

DEFINE_string(id, "", "the recording that gives the first frame and the push");
DEFINE_string(out, "",
              "write the trajectory here (CSV: states, hip, forces by part); with --restoration "
              "the bodies instead, if the name ends in .bvh (one file per person)");
DEFINE_int32(frames, 0, "frames to predict; 0: as many as the recording has");
DEFINE_double(push_scale, pushid::ChangedPushes{}.scale,
              "what-if: multiply the recorded pushes by this, as in 1.37");
DEFINE_string(push_again, "",
              "what-if: frames at which the recorded push comes again, comma-separated, with its "
              "strength against the first, as in 40,80:1.5; --frames gives it time");
DEFINE_string(poses_out, "", "--restoration: joint positions (CSV: frame, person, joint, x, y, z)");

namespace {

using namespace pushid;

constexpr int kMostFrames = 1000000;  // hours of motion

// The first output that holds bodies; empty where there is none.
std::string BodyOutput() {
  if (!FLAGS_poses_out.empty()) return "poses_out";
  return IsBodyFile(FLAGS_out) ? "out=" + FLAGS_out : "";
}

// Errors are printed only where the recording itself is predicted.
bool IsThatOfTheRecording() {
  return FLAGS_frames == 0 && FLAGS_push_scale == 1.0 && FLAGS_push_again.empty();
}

ChangedPushes ChangedPushesFromCommandLine() {
  ChangedPushes changed;
  changed.scale = FLAGS_push_scale;
  for (const std::string& spaced : SplitList(FLAGS_push_again)) {
    const std::string word(Trimmed(spaced));
    const size_t colon = word.find(':');
    std::int64_t frame = 0;
    double times = 1.0;
    if (!ParseInteger(word.substr(0, colon), &frame) || std::abs(frame) > kMostFrames ||
        (colon != std::string::npos && !ParseDouble(word.substr(colon + 1), &times))) {
      throw Error{"--push_again: " + Quoted(word) +
                  " is not a frame's number; give numbers as in 40,80 or 40:1.5"};
    }
    changed.again.emplace_back(static_cast<int>(frame), times);
  }
  return changed;
}

RestorationFlags CheckedFlags() {
  RequireModel();
  Require("id", FLAGS_id, "name a recording of the manifest");
  Require("out", FLAGS_out, "name the CSV or BVH file to write");
  const RestorationFlags restoration = RestorationFlagsFromCommandLine();
  const std::string needy = BodyOutput();
  if (!needy.empty() && !restoration.given()) throw NeedsRestoration(needy);
  if (FLAGS_frames != 0 && (FLAGS_frames < 2 || FLAGS_frames > kMostFrames)) {
    throw Error{"--frames must be 0, or lie between 2 and " + std::to_string(kMostFrames)};
  }
  if (ObservedFrames() > 0) {
    RefuseGiven({"push_scale", "push_again"},
                "--observed is for the recorded motion, and --{} for another push than made it; "
                "leave one out");
  }
  OrFail(CheckOutputFiles({FLAGS_poses_out, FLAGS_out}));
  return restoration;
}

std::vector<std::string> WriteScene(const BodyScene& scene, const BodyRecording& recording,
                                    const Prediction& prediction) {
  std::vector<std::string> files = {FLAGS_out};
  if (IsBodyFile(FLAGS_out)) {
    files = OrFail(WriteBodyBvh(FLAGS_out, scene));
  } else {
    OrFail(WriteTrajectoryCsv(FLAGS_out, recording.pendulum, prediction));
  }
  if (!FLAGS_poses_out.empty()) {
    OrFail(WriteJointsCsv(FLAGS_poses_out, scene));
    files.push_back(FLAGS_poses_out);
  }
  return files;
}

// Restores bodies, writes what the flags name and prints, for a whole recording also how far they
// are from the recorded ones.
void WriteBodies(const RestorationFlags& flags, const Recording& recorded,
                 const Prediction& prediction) {
  const std::unique_ptr<Restoration> restoration =
      LoadFlaggedRestoration(flags, static_cast<int>(recorded.people.size()));
  const BodyRecording recording = OrFail(MakeBodyRecording(recorded));
  std::vector<BodyMotion> bodies =
      RestoreBodies(*restoration, flags.postprocess, PredictedPeople(recording, prediction));
  BodyScore score;
  if (IsThatOfTheRecording()) {
    score = ScoreBodies(recording, bodies, std::max(1, prediction.observed));
  }
  ToLaboratory(recording.pendulum.scene, &bodies);
  const BodyScene scene = SceneOf(recording, std::move(bodies));
  const std::vector<std::string> files = WriteScene(scene, recording, prediction);
  std::printf("%s: %d frames of %d %s predicted (%s)\n", scene.id.c_str(), scene.num_frames(),
              scene.num_people(), scene.num_people() == 1 ? "body" : "bodies",
              std::string(restoration->kind()).c_str());
  for (const std::string& file : files) std::printf("  %s\n", file.c_str());
  if (IsThatOfTheRecording()) {
    std::printf("against the recording: %s\n", MetricsText(kBodyMetrics, score.value, 3).c_str());
  }
}

void WritePendulums(const PendulumRecording& recording, const Prediction& prediction) {
  OrFail(WriteTrajectoryCsv(FLAGS_out, recording, prediction));
  std::printf("%s: %d frames predicted, written to %s\n", recording.id.c_str(),
              prediction.path.num_frames(), FLAGS_out.c_str());
  if (IsThatOfTheRecording()) {
    const RecordingScore score = ScoreHip(recording, prediction.hip, prediction.observed);
    std::printf("against the recording: %s\n",
                MetricsText(TableMetrics(prediction.observed), score.value, 3).c_str());
  }
}

int Run() {
  const RestorationFlags restoration = CheckedFlags();
  const ChangedPushes changed = ChangedPushesFromCommandLine();
  const IdentifiedModel model = LoadFlaggedModel();
  const std::vector<Recording> recordings =
      LoadFlaggedRecordings({FLAGS_id}, restoration.given() || NeedsJoints(model.options));
  const PendulumRecording recorded = MakePendulumRecording(recordings.front());
  OrFail(CheckChangedPushes(changed, recorded,
                            FLAGS_frames > 0 ? FLAGS_frames : recorded.num_frames()));
  const PendulumRecording recording = WithPushes(recorded, changed);
  WarnGrouped(InputWarnings(model, {recording}));
  CheckObservedFlag({recording}, &model);
  if (FLAGS_frames != 0 && FLAGS_frames <= ObservedFrames()) {
    return Fail("--frames=" + std::to_string(FLAGS_frames) + " leaves none to predict after " +
                "--observed=" + std::to_string(ObservedFrames()) + "; it must be larger");
  }
  const Prediction prediction =
      OrFail(PredictFrom(model, recording, ObservedFrames(), FLAGS_frames, ForecastUseFlag()));
  if (!prediction.status.ok) {
    return Fail("recording " + recording.id + ": " + OutsideText(prediction.status), kFitFailed);
  }
  if (restoration.given()) {
    WriteBodies(restoration, recordings.front(), prediction);
  } else {
    WritePendulums(recording, prediction);
  }
  if (changed.Any()) {
    std::printf("%s; no recorded motion to compare with\n",
                ChangedPushesText(changed, recording).c_str());
  }
  const FittedModel fitted = OrFail(ReadFittedModel(ModelFile()));
  std::printf("%s", TextLines(PersonText(fitted.fit, model, {recording})).c_str());
  std::printf("%s", PredictedStepsText(recording, prediction).c_str());
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(argc, argv,
                        "pushid-predict predicts the motion after a push, from a recording's first "
                        "frame and the push.\n"
                        "  pushid-predict --model=model.json --recordings=held-out/manifest.json "
                        "--id=S01_00_weak --out=trajectory.csv",
                        Run);
}
