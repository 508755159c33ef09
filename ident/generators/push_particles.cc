// ident: bodies to particles and back.
#include "ident/generators/push_particles.h"

#include <cmath>

#include "datasets/files/number_text.h"

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
  for (const ScenePush& push : scene.pushes) {
    if (push.person != person) continue;
    for (int t = push.start_frame; t < std::min(frames, push.EndFrame()); ++t) {
      particles.motion.controls.col(t) +=
          (push.force[t - push.start_frame] / scene.people[person].body.mass).cast<float>();
    }
  }
  return particles;
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
                                               const BodyRecording& recording) {
  const double rate = 1.0 / recording.pendulum.scene.dt;
  if (std::abs(rate - settings.rate) > 0.01 * settings.rate) {
    return Error{"recording " + recording.pendulum.id + " has " + Rounded(rate, 3) +
                 " frames a second; the generator was trained at " + Rounded(settings.rate, 3) +
                 ": resample the recording"};
  }
  const int frames = recording.num_frames(), observed = settings.observed;
  if (frames <= observed) {
    return Error{"recording " + recording.pendulum.id + " has " + std::to_string(frames) +
                 " frames; the generator is given " + std::to_string(observed) +
                 " and has nothing to forecast"};
  }
  std::vector<BodyMotion> bodies;
  std::vector<ObservedMotion> people;
  std::vector<Eigen::Vector3d> origins;
  for (int n = 0; n < recording.num_people(); ++n) {
    PushedParticles particles = ParticlesOf(recording, n);
    particles.motion.frames = Trajectories(particles.motion.frames.leftCols(observed));
    people.push_back(std::move(particles.motion));
    origins.push_back(particles.origin);
  }
  const std::vector<Trajectories> forecasts = generator.Forecast(people, frames - observed);
  for (size_t n = 0; n < people.size(); ++n) {
    Trajectories whole(people[n].frames.rows(), frames);
    whole << people[n].frames, forecasts[n];
    bodies.push_back(BodyFromParticles(whole, origins[n]));
  }
  return bodies;
}

}  // namespace pushid
