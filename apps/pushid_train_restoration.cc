// apps: pushid-train-restoration: networks that turn pendulums into bodies.
#include <gflags/gflags.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "apps/flags/recording_flags.h"
#include "apps/flags/restoration_flags.h"
#include "apps/support/app_support.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "datasets/files/number_text.h"
#include "ident/bodies/body_report.h"
#include "ident/results/result_json.h"
#include "ident/training/curve_svg.h"
#include "ident/training/restoration_training_run.h"
#include "models/self_network.h"

DEFINE_string(model, "", "model that pushid-fit --model_out wrote: which pendulum is fitted");
DEFINE_string(
    kind, "window",
    "what is trained: window (fast, default), cvae (LDP's chain), or simlpe (siMLPe, which "
    "continues 12 given frames, for --peer of pushid-evaluate)");
DEFINE_string(coordinates, "tip",
              "cvae: joints against the rod's tip (tip), or against the hip at frame 0 (ldp)");
DEFINE_string(out, "", "folder to write: restoration.json, weights.npy, curve.svg");
DEFINE_string(json_out, "", "--crossvalidate: write the scores here (JSON)");
DEFINE_int32(crossvalidate, 0,
             "folds: instead of writing a restoration, refit pendulum and restoration in every "
             "fold and score the recordings held out; 0: off");
DEFINE_int32(inner_folds, 4, "folds of the out-of-fold pendulum predictions");
DEFINE_double(held_out, 0.15, "share of the recordings by which training stops early");
DEFINE_double(checkpoint_seconds, 20.0, "time between two checkpoints in --out");
DEFINE_double(effort, 1.0, "multiplies the number of training steps");
DEFINE_bool(predicted_pendulums, true, "learn from out-of-fold predicted pendulums too");
DEFINE_bool(mirrored, true, "learn from mirrored copies too");
DEFINE_string(more_settings, "",
              "also learn how bodies follow recorded pendulums from these settings (as --setting "
              "names them); their pendulums are not fitted and nothing of them is scored");
DEFINE_uint64(seed, 1, "seed of weights, batches, noise and folds");
DEFINE_int32(num_threads, 1, "threads of the training; only one repeats to the last bit");

namespace {

using namespace pushid;

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

MaybeError CheckFlags() {
  if (MaybeError missing =
          Require("model", FLAGS_model, "give a file that pushid-fit --model_out wrote")) {
    return missing;
  }
  const auto kind = RestorationKindFromName(FLAGS_kind);
  if (!kind || !RowOf(*kind).trained) {
    return Error{"--kind is '" + FLAGS_kind + "'; it must be " + TrainedRestorationKinds()};
  }
  if (!CvaeCoordinatesFromName(FLAGS_coordinates)) {
    return Error{"--coordinates is '" + FLAGS_coordinates + "'; it must be tip or ldp"};
  }
  if (FLAGS_crossvalidate == 0) {
    if (MaybeError missing = Require("out", FLAGS_out, "name the folder to write")) return missing;
  } else if (FLAGS_crossvalidate < 2) {
    return Error{"--crossvalidate must be 0 or at least 2 folds"};
  }
  if (FLAGS_inner_folds < 2) return Error{"--inner_folds must be at least 2"};
  if (!(FLAGS_held_out > 0.0 && FLAGS_held_out <= 0.5)) {
    return Error{"--held_out must lie above 0 and not above 0.5"};
  }
  if (!(FLAGS_effort > 0.0 && FLAGS_effort <= 100.0)) {
    return Error{"--effort must lie above 0 and not above 100"};
  }
  if (!(FLAGS_checkpoint_seconds >= 0.0)) return Error{"--checkpoint_seconds must not be negative"};
  if (FLAGS_num_threads < 1) return Error{"--num_threads must be positive"};
  return std::nullopt;
}

Result<RestorationRunOptions> RunOptions() {
  const Result<FitResult> fit = ReadFitResult(FLAGS_model);
  if (!fit.ok()) return fit.error();
  const Result<PostprocessOptions> postprocess = PostprocessOfFlags();
  if (!postprocess.ok()) return postprocess.error();
  RestorationRunOptions options;
  options.fit = fit.value().options;
  if (RodMoves(options.fit.model)) {
    return Error{"its rod moves, and bodies hang on rods of constant length; fit --rod=constant",
                 FLAGS_model};
  }
  options.fit.num_threads = FLAGS_num_threads;
  options.postprocess = postprocess.value();
  options.inner_folds = FLAGS_inner_folds;
  options.held_out = FLAGS_held_out;
  options.predicted_pendulums = FLAGS_predicted_pendulums;
  options.mirrored = FLAGS_mirrored;
  options.training.kind = *RestorationKindFromName(FLAGS_kind);
  options.training.coordinates = *CvaeCoordinatesFromName(FLAGS_coordinates);
  options.training.effort = FLAGS_effort;
  options.training.seed = FLAGS_seed;
  options.training.num_threads = FLAGS_num_threads;
  options.training.checkpoint_seconds = FLAGS_checkpoint_seconds;
  return options;
}

// "window, epoch 12: 43 %, 12 s left"; the time left from the share done so far.
class TrainingLine {
 public:
  void Show(const std::string& step, double done) {
    const std::string name = step.substr(0, step.rfind(' '));
    if (name != step_) step_ = name, start_ = Now(), done_at_start_ = done;
    std::string text =
        step + ": " + std::to_string(static_cast<int>(std::lround(100.0 * done))) + " %";
    const double gained = done - done_at_start_;
    if (gained > 0.0) {
      const double left = (Now() - start_) / gained * (1.0 - done);
      text += ", " + std::to_string(static_cast<int>(std::lround(left))) + " s left";
    }
    line_.Show(text);
  }
  void Finish() { line_.Finish(); }

 private:
  ProgressLine line_;
  std::string step_;
  double start_ = 0.0, done_at_start_ = 0.0;
};

int CrossValidate(const std::vector<BodyRecording>& recordings,
                  const RestorationRunOptions& options) {
  TrainingLine line;
  const Result<ChainValidation> validation =
      CrossValidateChain(recordings, options, FLAGS_crossvalidate, FLAGS_seed,
                         [&](const std::string& step, double done) { line.Show(step, done); });
  line.Finish();
  if (!validation.ok()) return Fail(validation.error());
  std::printf("%s", BodyText(validation.value().evaluation).c_str());
  if (FLAGS_json_out.empty()) return kDone;
  nlohmann::ordered_json json = {{"version", Version()}, {"configuration", EffectiveFlags()}};
  AddBodyJson(validation.value().evaluation, &json);
  json["run"] = {{"training_seconds", validation.value().training_seconds}};
  if (MaybeError error = WriteJson(FLAGS_json_out, json)) return Fail(*error);
  return kDone;
}

nlohmann::ordered_json Provenance(const std::vector<BodyRecording>& recordings,
                                  const TrainedRestoration& trained) {
  nlohmann::ordered_json json = {{"version", Version()}, {"configuration", EffectiveFlags()}};
  json["recordings"] = nlohmann::ordered_json::array();
  for (const BodyRecording& recording : recordings) {
    json["recordings"].push_back(
        {{"id", recording.pendulum.id}, {"content_hash", recording.pendulum.content_hash}});
  }
  json["curve"] = nlohmann::ordered_json::array();
  for (const TrainingPoint& p : trained.curve) {
    nlohmann::ordered_json point = {{"epoch", p.epoch},
                                    {"training_loss", p.training_loss},
                                    {"held_out_loss", p.validation_loss}};
    if (!p.stage.empty()) point["stage"] = p.stage;
    json["curve"].push_back(point);
  }
  return json;
}

int Train(const std::vector<BodyRecording>& recordings, RestorationRunOptions options) {
  std::error_code failed;
  std::filesystem::create_directories(FLAGS_out, failed);
  if (failed) return Fail(Error{"cannot make this folder: " + failed.message(), FLAGS_out});
  const auto in_out = [](const char* name) {
    return (std::filesystem::path(FLAGS_out) / name).string();
  };
  options.training.checkpoint = in_out("checkpoint.bin");
  if (MaybeError error = CheckWritable(options.training.checkpoint)) return Fail(*error);
  std::vector<int> all(recordings.size());
  for (size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  TrainingLine line;
  const double before = Now();
  Result<TrainedRestoration> trained =
      TrainFromRecordings(recordings, all, options,
                          [&](const std::string& step, double done) { line.Show(step, done); });
  line.Finish();
  if (!trained.ok()) return Fail(trained.error());
  RestorationFile& file = trained.value().file;
  file.training = Provenance(recordings, trained.value());
  const std::string title = FLAGS_kind + " restoration, " + std::to_string(recordings.size()) +
                            " recordings (" + FLAGS_setting + ")";
  if (MaybeError error = WriteFileAtomically(in_out("curve.svg"),
                                             TrainingCurveSvg(trained.value().curve, title))) {
    return Fail(*error);
  }
  if (MaybeError error = WriteRestorationFile(FLAGS_out, file)) return Fail(*error);
  const TrainingPoint& last = trained.value().curve.back();
  std::printf("%s: %zu points of the curve, held-out loss %s at the end, %s s%s; %s\n",
              title.c_str(), trained.value().curve.size(), Rounded(last.validation_loss, 3).c_str(),
              Rounded(Now() - before, 3).c_str(),
              trained.value().resumed ? " (resumed from a checkpoint)" : "",
              in_out("restoration.json").c_str());
  return kDone;
}

// Those of --more_settings, without the ones that are learnt from (and scored) anyway.
MaybeError AddMoreRecordings(const std::vector<Recording>& known, RestorationRunOptions* options) {
  if (FLAGS_more_settings.empty()) return std::nullopt;
  const Result<std::vector<Recording>> more = LoadBodiesOfSetting(FLAGS_more_settings);
  if (!more.ok()) return more.error();
  for (const Recording& recording : more.value()) {
    bool is_known = false;
    for (const Recording& other : known) is_known = is_known || other.id == recording.id;
    if (is_known) continue;
    Result<BodyRecording> body = MakeBodyRecording(recording, options->fit.mapping);
    if (!body.ok()) return body.error();
    options->more.push_back(std::move(body.value()));
  }
  return std::nullopt;
}

int Run() {
  if (MaybeError error = CheckFlags()) return Fail(*error);
  Result<RestorationRunOptions> options = RunOptions();
  if (!options.ok()) return Fail(options.error());
  if (!FLAGS_json_out.empty()) {
    if (MaybeError error = CheckWritable(FLAGS_json_out)) return Fail(*error);
  }
  const Result<std::vector<Recording>> recordings = LoadFlaggedRecordings({}, true);
  if (!recordings.ok()) return Fail(recordings.error());
  if (MaybeError error = CheckPushed(recordings.value())) return Fail(*error);
  const Result<std::vector<BodyRecording>> bodies =
      MakeBodyRecordings(recordings.value(), options.value().fit.mapping);
  if (!bodies.ok()) return Fail(bodies.error());
  if (MaybeError error = AddMoreRecordings(recordings.value(), &options.value())) {
    return Fail(*error);
  }
  if (FLAGS_crossvalidate > 0) return CrossValidate(bodies.value(), options.value());
  return Train(bodies.value(), options.value());
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(argc, argv,
                        "pushid-train-restoration trains the networks that turn a pendulum's path "
                        "into the motion of a body.\nStarted again with the same --out, it goes on "
                        "where it was broken off.\n\n  pushid-train-restoration "
                        "--recordings=M/manifest.json --setting=single --model=model.json "
                        "--out=restoration",
                        Run);
}
