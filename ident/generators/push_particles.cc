// ident: bodies to particles and back.
#include "ident/generators/push_particles.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "datasets/files/number_text.h"
#include "datasets/manifest/recording.h"
#include "ident/model/model_rollout.h"
#include "ident/prediction/online_predictor.h"

namespace pushid {

ParticleLayout PushLayout(const std::vector<std::string>& joint_names) {
  ParticleLayout layout;
  layout.names = joint_names;
  layout.mirrored_axis = 1;
  layout.joints = kBodyJoints;
  layout.weights.assign(kBodyJoints, 1.0f);
  layout.fixed = Eigen::Matrix3Xf::Zero(3, kBodyJoints);
  for (int j = 0; j < kBodyJoints; ++j) {
    layout.mirrored.push_back(MirroredJoint(j));
    layout.parents.push_back(j == kBodyHip ? kNoBone : kBodyParents[j]);
  }
  return layout;
}

PushedParticles ParticlesOf(const BodyRecording& recording, int person) {
  const BodyMotion& body = recording.bodies[person];
  const int frames = static_cast<int>(body.size());
  PushedParticles particles;
  particles.origin << body.front()(0, kBodyHip), body.front()(1, kBodyHip), 0.0;
  Trajectories& motion = particles.motion.frames;
  motion.resize(3 * kBodyJoints, frames);
  for (int t = 0; t < frames; ++t) {
    const Pose pose = body[t].colwise() - particles.origin;
    motion.col(t) = pose.reshaped().cast<float>();
  }
  particles.motion.controls = Eigen::MatrixXf::Zero(kPushControls, frames);
  const Scene& scene = recording.pendulum.scene;
  particles.motion.place = particles.origin.head<2>().cast<float>();
  particles.motion.mass = static_cast<float>(scene.people[person].body.mass);
  for (const ScenePush& push : scene.pushes) {
    if (push.person != person) continue;
    for (int t = push.start_frame; t < std::min(frames, push.EndFrame()); ++t) {
      particles.motion.controls.col(t) +=
          (push.force[t - push.start_frame] / scene.people[person].body.mass).cast<float>();
    }
  }
  return particles;
}

GroupHips PendulumHips(const BodyRecording& recording, const Prediction& prediction) {
  GroupHips hips;
  for (const RestorationInput& person : PredictedPeople(recording, prediction)) {
    const Pose& first = person.first_pose;
    const Eigen::Vector3d origin(first(0, kBodyHip), first(1, kBodyHip), 0.0);
    Eigen::Matrix3Xf hip(3, person.q.size());
    for (size_t t = 0; t < person.q.size(); ++t) {
      const int frame = static_cast<int>(t);
      hip.col(frame) = (TipAt(person, frame) - origin).cast<float>();
    }
    hips.push_back(std::move(hip));
  }
  return hips;
}

Result<Prediction> PredictBeside(const GeneratorSettings& settings, const IdentifiedModel& physics,
                                 const BodyRecording& recording, int frames) {
  Result<Prediction> predicted =
      PredictFrom(physics, recording.pendulum, ShownToPhysics(settings), frames);
  if (!predicted.ok() || predicted.value().status.ok) return predicted;
  return Error{"recording " + recording.pendulum.id + ": physics " +
                   OutsideText(predicted.value().status) + "; leave out --physics",
               physics.source};
}

std::vector<ObservedMotion> GroupOf(const BodyRecording& recording, const GroupHips& hips) {
  std::vector<ObservedMotion> group;
  for (int n = 0; n < recording.num_people(); ++n) {
    group.push_back(ParticlesOf(recording, n).motion);
    if (!hips.empty()) group.back().pendulum = hips[n];
  }
  return group;
}

std::vector<PushKind> PushKindsOf(const Scene& scene) {
  std::set<PushKind> kinds;
  for (const ScenePush& push : scene.pushes) kinds.insert(push.kind);
  return {kinds.begin(), kinds.end()};
}

std::string OtherPushKinds(const GeneratorSettings& settings, const Scene& scene) {
  if (settings.push_kinds.empty()) return "";
  const auto& learned = settings.push_kinds;
  std::string known, other;
  for (const PushKind kind : learned) known += (known.empty() ? "" : ", ") + NameOf(kind);
  for (const PushKind kind : PushKindsOf(scene)) {
    if (std::find(learned.begin(), learned.end(), kind) != learned.end()) continue;
    other += (other.empty() ? "" : ", ") + NameOf(kind);
  }
  if (other.empty()) return "";
  return "the generator was trained on pushes of kind " + known +
         " and is applied to pushes of kind " + other +
         ": predicted displacements may be too large or too small (an external push is complete, "
         "the others continue after their frames)";
}

bool AtRateOf(const GeneratorSettings& settings, double dt) {
  return std::abs(1.0 / dt - settings.rate) <= 0.01 * settings.rate;
}

BodyMotion BodyFromParticles(const Trajectories& motion, const Eigen::Vector3d& origin) {
  BodyMotion body(motion.cols());
  for (size_t t = 0; t < body.size(); ++t) {
    const Eigen::VectorXd pose = motion.col(static_cast<Eigen::Index>(t)).cast<double>();
    body[t] = pose.reshaped(3, kBodyJoints).colwise() + origin;
  }
  return body;
}

Result<std::vector<BodyMotion>> GenerateBodies(const GeneratorSettings& settings,
                                               const MotionGenerator& generator,
                                               const BodyRecording& recording,
                                               const GroupHips& hips, int frames) {
  const double dt = recording.pendulum.scene.dt;
  if (!AtRateOf(settings, dt)) {
    return Error{"recording " + recording.pendulum.id + " has " + Rounded(1.0 / dt, 3) +
                 " frames per second; the generator was trained at " + Rounded(settings.rate, 3) +
                 ": resample the recording"};
  }
  const int observed = settings.observed, recorded = recording.num_frames();
  if (frames == 0) frames = recorded;
  if (std::min(frames, recorded) <= observed) {
    return Error{"of recording " + recording.pendulum.id + " there are " +
                 std::to_string(std::min(frames, recorded)) + " frames; the generator is given " +
                 std::to_string(observed) + " and has nothing to forecast"};
  }
  std::vector<ObservedMotion> people = GroupOf(recording, hips);
  for (ObservedMotion& person : people) {
    person.frames = Trajectories(person.frames.leftCols(observed));
  }
  const std::vector<Trajectories> forecasts = generator.Forecast(people, frames - observed);
  std::vector<BodyMotion> bodies;
  for (size_t n = 0; n < people.size(); ++n) {
    Trajectories whole(people[n].frames.rows(), frames);
    whole << people[n].frames, forecasts[n];
    const Eigen::Vector2d place = people[n].place.cast<double>();
    bodies.push_back(BodyFromParticles(whole, {place.x(), place.y(), 0.0}));
  }
  return bodies;
}

}  // namespace pushid
