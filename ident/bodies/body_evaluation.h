// ident: restored bodies beside the baselines that any restoration has to beat.
//
//   restoration        predicted pendulum, restored
//   true_pendulum      the recorded pendulum, restored: what the restoration itself errs
//   rigid              predicted pendulum, first pose carried by the rod's tip
//   static             no person moves
//   constant_velocity  the recording until the last push ends, then the pose carried on with the
//                      hip's last velocity
//   recorded           the recording against itself: its own FSE
//
// observed: frames that were seen first (prediction/online_predictor.h), 0: none; the
// baselines then go on from the last of them, and restorations begin with them. Only frames that
// were not seen count, but in restoration_all_frames. Where nothing was observed, frames 1 on count
// of everybody, though constant_velocity knows those of the push.
#pragma once

#include <array>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ident/bodies/body_recording.h"
#include "ident/figures/text_table.h"
#include "ident/model/identified_model.h"
#include "ident/prediction/evaluation.h"
#include "ident/validation/group_metrics.h"
#include "models/restoration/postprocess.h"
#include "models/restoration/restoration.h"

namespace pushid {

// Distances of predicted bodies from recorded ones.
//
// For one recording, means over the frames that count, people and all 22 joints unless said
// otherwise. Those are frames 1 .. T-1, and of a predictor that was shown more than frame 0 only
// the frames that it was not shown, first_frame .. T-1; scores of all frames are called so.
//
//   MPJPE      |joint - recorded joint|, m
//   hipADE     the same of the hip alone; hipFDE: at the last frame
//   MBLE       | |bone| - |recorded bone| |, over 21 bones, m
//   FSE        of ankles in contact (below H = 2.5 cm above their own height at frame 0): the
//              horizontal way since the frame before times (2 - 2^(h/H)), h above the height at
//              frame 0 and at least 0; cm per frame. Mean over the contacts of a person, then over
//              people.
//   relative   MPJPE of joint - hip against recorded joint - hip (the hip counts as a joint, zero)
// Means over recordings have standard errors over recordings, as those of hipADE.

// Errors up to a time after the last shown frame, means over the frames until then and over people,
// m, as MRT (Wang et al., NeurIPS 2021) has them and SDM's Tables 1 and 2 after it.
inline constexpr std::array<int, 3> kErrorSeconds = {1, 2, 3};
inline constexpr std::pair<const char*, MetricId> kTimedErrors[] = {
    {"total", kMpjpe}, {"root", kHipAde}, {"pose", kRelativeMpjpe}};

struct BodyScore : Score {
  std::vector<BodyMotion> predicted = {};  // of more than one person; groups are judged together
  // Errors up to kErrorSeconds, where the recording lasts so long; without FSE.
  std::array<std::optional<Metrics>, kErrorSeconds.size()> at = {};
};

// predicted: one motion per person, with as many frames as the recording, which are more than
// first_frame. first_frame: the first that counts, at least 1: frames before it were shown.
BodyScore ScoreBodies(const BodyRecording& recording, const std::vector<BodyMotion>& predicted,
                      int first_frame = 1);

// FSE of one motion, cm per frame, of ways that end at first_frame or later; negative when no ankle
// ever touches the floor.
double FootSkate(const BodyMotion& motion, int first_frame = 1);

struct BodySummary : ScoreMeans {
  std::vector<BodyScore> recordings;
  // Means of the recordings that last so long; no errors.
  std::array<MeanScore, kErrorSeconds.size()> at;
  std::optional<GroupMetrics> groups;  // of all recordings of more than one person, if any
};

// scores in the order of recordings.
BodySummary SummarizeBodies(const std::vector<BodyRecording>& recordings,
                            std::vector<BodyScore> scores,
                            const LabelKeys& group_by = UsualGroups());

// Restored and post-processed.
std::vector<BodyMotion> RestoreBodies(const Restoration& restoration,
                                      const PostprocessOptions& options,
                                      const std::vector<RestorationInput>& people);

std::vector<BodyMotion> StaticBodies(const BodyRecording& recording, int observed = 0);
std::vector<BodyMotion> ConstantVelocityBodies(const BodyRecording& recording, int observed = 0);

// Scores by the names above, in the order of the calls.
using BodyScores = std::map<std::string, std::vector<BodyScore>>;
void ScoreRestoration(const IdentifiedModel& model, const Restoration& restoration,
                      const PostprocessOptions& options, const BodyRecording& recording,
                      BodyScores* scores, int observed = 0, ForecastUse use = ForecastUse::kBoth);

// A generator's forecast after `observed` frames, at least 1, and the baselines beside it:
// generator, generator_all_frames, static and constant_velocity.
void ScoreForecast(const BodyRecording& recording, const std::vector<BodyMotion>& forecast,
                   int observed, BodyScores* scores);

using BodyEvaluation = std::map<std::string, BodySummary>;
BodyEvaluation SummarizeAll(const std::vector<BodyRecording>& recordings, const BodyScores& scores,
                            const LabelKeys& group_by = UsualGroups());
// Scores of bodies as JSON and as tables.

// Adds the body's keys (MPJPE_m, MBLE_m, ...) to an evaluation's JSON (model_json.h): to the
// means, groups and recordings at the top (of the restoration, or of the generator), to
// baselines.static and baselines.constant_velocity, and as new entries baselines.rigid (and
// peers'), true_pendulum, recorded and restoration_drawn (ident/training/restoration_training.h).
void AddBodyJson(const BodyEvaluation& evaluation, nlohmann::ordered_json* json);

nlohmann::ordered_json ToJson(const BodySummary& summary, bool with_recordings);

// A row per predictor, a column per metric.
TextTable BodyTable(const BodyEvaluation& evaluation);
// The table, then the restoration by label.
std::string BodyText(const BodyEvaluation& evaluation);
// Errors up to fixed times (kTimedErrors), a row per predictor.
std::string TimedErrorsText(const BodyEvaluation& evaluation);

}  // namespace pushid
