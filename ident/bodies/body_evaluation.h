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

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "ident/bodies/body_metrics.h"
#include "ident/model/fitted_model.h"
#include "ident/model/identified_model.h"
#include "models/restoration/postprocess.h"
#include "models/restoration/restoration.h"

namespace pushid {

// Restored and post-processed.
std::vector<BodyMotion> RestoreBodies(const Restoration& restoration,
                                      const PostprocessOptions& options,
                                      const std::vector<RestorationInput>& people);

// Their `observed` beside a predictor that is shown so many frames: one is the first pose, which
// everybody knows.
inline int SeenByBaselines(int shown) { return shown > 1 ? shown : 0; }
std::vector<BodyMotion> StaticBodies(const BodyRecording& recording, int observed = 0);
std::vector<BodyMotion> ConstantVelocityBodies(const BodyRecording& recording, int observed = 0);

// The score of a recording whose bodies could not be predicted.
BodyScore FailedBodies(const BodyRecording& recording, const std::string& failure);

// By the names above; the scores in the order of the calls.
using BodyScores = std::map<std::string, std::vector<BodyScore>>;
void ScoreRestoration(const IdentifiedModel& model, const Restoration& restoration,
                      const PostprocessOptions& options, const BodyRecording& recording,
                      BodyScores* scores, int observed = 0, ForecastUse use = ForecastUse::kStack);

using BodyEvaluation = std::map<std::string, BodySummary>;
BodyEvaluation SummarizeAll(const std::vector<BodyRecording>& recordings, const BodyScores& scores,
                            const LabelKeys& group_by = UsualGroups());
// The scores of each recording, by name.
BodyEvaluation SummarizeAll(const std::vector<BodyRecording>& recordings,
                            const std::vector<std::map<std::string, BodyScore>>& by_recording);

// Scores of bodies as JSON and as tables.

// Adds the body's keys (MPJPE_m, MBLE_m, ...) to an evaluation's JSON (model_json.h): to the
// means, groups and recordings at the top (of the restoration, or of the generator), to
// baselines.static and baselines.constant_velocity, and as new entries baselines.rigid (and
// peers'), true_pendulum, recorded and restoration_drawn (ident/training/restoration_chain.h).
void AddBodyJson(const BodyEvaluation& evaluation, nlohmann::ordered_json* json);

// The means over recordings of what AddBodyJson added to. file: where it stands, for errors.
Result<BodyMetrics> MeanBodyMetrics(const nlohmann::ordered_json& json, const std::string& file);

nlohmann::ordered_json MeanJson(const BodyMean& mean);
nlohmann::ordered_json ToJson(const BodySummary& summary, bool with_recordings);

// A row per predictor, a column per metric; then the restoration by label.
std::string BodyText(const BodyEvaluation& evaluation);
// Root and pose errors at fixed times (TimedError), a row per predictor.
std::string TimedErrorsText(const BodyEvaluation& evaluation);

}  // namespace pushid
