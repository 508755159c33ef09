// ident: scores of restorations and baselines.
#include "ident/bodies/body_evaluation.h"

#include <algorithm>

#include "ident/fit/model_rollout.h"
#include "ident/prediction/online_predictor.h"

namespace pushid {

BodyScore FailedBodies(const BodyRecording& recording, const std::string& failure) {
  BodyScore score;
  score.id = recording.pendulum.id;
  score.frames = recording.num_frames();
  score.failure = failure;
  return score;
}

std::vector<BodyMotion> RestoreBodies(const Restoration& restoration,
                                      const PostprocessOptions& options,
                                      const std::vector<RestorationInput>& people) {
  std::vector<BodyMotion> motions = restoration.Restore(people);
  for (size_t n = 0; n < people.size(); ++n) Finish(people[n], options, &motions[n]);
  return motions;
}

std::vector<BodyMotion> StaticBodies(const BodyRecording& recording, int observed) {
  std::vector<BodyMotion> motions;
  for (const BodyMotion& body : recording.bodies) {
    BodyMotion motion(body.begin(), body.begin() + std::max(1, observed));
    motion.resize(body.size(), Pose(motion.back()));
    motions.push_back(std::move(motion));
  }
  return motions;
}

std::vector<BodyMotion> ConstantVelocityBodies(const BodyRecording& recording, int observed) {
  const int known = observed > 0 ? observed - 1 : recording.pendulum.scene.LastPushEnd();
  const int last = std::min(known, recording.num_frames() - 1);
  std::vector<BodyMotion> motions;
  for (const BodyMotion& body : recording.bodies) {
    BodyMotion motion(body.begin(), body.begin() + last + 1);
    Eigen::Vector3d step = Eigen::Vector3d::Zero();
    if (last > 0) step = (body[last] - body[last - 1]).col(0);
    while (motion.size() < body.size()) {
      const Pose next = motion.back().colwise() + step;
      motion.push_back(next);
    }
    motions.push_back(std::move(motion));
  }
  return motions;
}

void ScoreRestoration(const IdentifiedModel& model, const Restoration& restoration,
                      const PostprocessOptions& options, const BodyRecording& recording,
                      BodyScores* scores, int observed) {
  const auto add = [&](const char* name, const std::vector<BodyMotion>& bodies,
                       int first_frame = 1) {
    (*scores)[name].push_back(ScoreBodies(recording, bodies, first_frame));
  };
  const std::vector<RestorationInput> recorded = RecordedPeople(recording, observed);
  add("true_pendulum", RestoreBodies(restoration, options, recorded));
  add("static", StaticBodies(recording, observed));
  add("constant_velocity", ConstantVelocityBodies(recording, observed));
  add("recorded", recording.bodies);
  const Result<Prediction> predicted = PredictFrom(model, recording.pendulum, observed);
  if (!predicted.ok() || !predicted.value().status.ok) {
    const std::string failure =
        predicted.ok() ? OutsideText(predicted.value().status) : predicted.error().message;
    std::vector<const char*> names = {"restoration", "rigid"};
    if (observed > 0) names.push_back("restoration_after_given");
    for (const char* name : names) (*scores)[name].push_back(FailedBodies(recording, failure));
    return;
  }
  const Prediction& prediction = predicted.value();
  const std::vector<RestorationInput> people = PredictedPeople(recording, prediction);
  const std::vector<BodyMotion> restored = RestoreBodies(restoration, options, people);
  add("restoration", restored);
  if (observed > 0) add("restoration_after_given", restored, observed);
  add("rigid", RigidRestoration().Restore(people));
}

BodyEvaluation SummarizeAll(const std::vector<BodyRecording>& recordings, const BodyScores& scores,
                            const LabelKeys& group_by) {
  BodyEvaluation evaluation;
  for (const auto& [name, of_name] : scores) {
    evaluation[name] = SummarizeBodies(recordings, of_name, group_by);
  }
  return evaluation;
}

BodyEvaluation SummarizeAll(const std::vector<BodyRecording>& recordings,
                            const std::vector<std::map<std::string, BodyScore>>& by_recording) {
  BodyScores all;
  for (const auto& scores : by_recording) {
    for (const auto& [name, score] : scores) all[name].push_back(score);
  }
  return SummarizeAll(recordings, all);
}

}  // namespace pushid
