// ident: scores of restorations and baselines.
#include "ident/bodies/body_evaluation.h"

#include <algorithm>

#include "ident/prediction/prediction.h"

namespace pushid {
namespace {

BodyScore Failed(const BodyRecording& recording, const RolloutStatus& status) {
  BodyScore score;
  score.id = recording.pendulum.id;
  score.frames = recording.num_frames();
  score.failure = std::string(status.quantity) + " of person " + std::to_string(status.person) +
                  " leaves the model's domain at frame " + std::to_string(status.frame);
  return score;
}

}  // namespace

std::vector<BodyMotion> RestoreBodies(const Restoration& restoration,
                                      const PostprocessOptions& options,
                                      const std::vector<RestorationInput>& people) {
  std::vector<BodyMotion> motions = restoration.Restore(people);
  for (size_t n = 0; n < people.size(); ++n) Finish(people[n], options, &motions[n]);
  return motions;
}

std::vector<BodyMotion> StaticBodies(const BodyRecording& recording) {
  std::vector<BodyMotion> motions;
  for (const BodyMotion& body : recording.bodies) motions.emplace_back(body.size(), body.front());
  return motions;
}

std::vector<BodyMotion> ConstantVelocityBodies(const BodyRecording& recording) {
  const int last = std::min(recording.pendulum.scene.LastPushEnd(), recording.num_frames() - 1);
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
                      BodyScores* scores) {
  const auto add = [&](const char* name, const std::vector<BodyMotion>& bodies) {
    (*scores)[name].push_back(ScoreBodies(recording, bodies));
  };
  const std::vector<RestorationInput> recorded = RecordedPeople(recording);
  add("true_pendulum", RestoreBodies(restoration, options, recorded));
  add("static", StaticBodies(recording));
  add("constant_velocity", ConstantVelocityBodies(recording));
  add("recorded", recording.bodies);
  const Prediction prediction = Predict(model, recording.pendulum);
  if (!prediction.status.ok) {
    for (const char* name : {"restoration", "rigid"}) {
      (*scores)[name].push_back(Failed(recording, prediction.status));
    }
    return;
  }
  const std::vector<RestorationInput> people = PredictedPeople(recording, prediction);
  add("restoration", RestoreBodies(restoration, options, people));
  add("rigid", RigidRestoration().Restore(people));
}

BodyEvaluation SummarizeAll(const std::vector<BodyRecording>& recordings,
                            const BodyScores& scores) {
  BodyEvaluation evaluation;
  for (const auto& [name, of_name] : scores) {
    evaluation[name] = SummarizeBodies(recordings, of_name);
  }
  return evaluation;
}

}  // namespace pushid
