// People who are pushed, as particles and back.
#include <gtest/gtest.h>

#include "ident/generators/generator_files.h"
#include "tests/models/body_samples.h"
#include "tests/models/generators/generator_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

// Somebody of 80 kg at (2, -1) who is pushed from frame 1 to 3, and somebody who is not.
BodyRecording OnePushed(int frames) {
  BodyRecording recording;
  recording.pendulum.id = "push";
  recording.pendulum.subject_ids = {"A", "B"};
  Scene& scene = recording.pendulum.scene;
  for (int n = 0; n < 2; ++n) {
    ScenePerson person;
    person.body.mass = 80.0;
    scene.people.push_back(person);
    BodyMotion body;
    for (int t = 0; t < frames; ++t) {
      body.push_back(Placed(StandingPose(), 0.0, {2.0 + 0.01 * t, n - 1.0, 0.0}));
    }
    recording.bodies.push_back(body);
    recording.pendulum.hip.emplace_back(frames);
  }
  scene.pushes.push_back(MakeScenePush(0, 1, PushKind::kNet, {{160, 8, 40, -4}, {80, 0, 0, 0}}));
  recording.joint_names.assign(kBodyJoints, "joint");
  return recording;
}

TEST(PushParticlesTest, PlacesCountFromTheHipAndPushesFromTheirFrame) {
  const BodyRecording recording = OnePushed(6);
  const ObservedMotion person = ParticlesOf(recording, 0);
  EXPECT_LT(person.frames.col(0).head<2>().norm(), 1e-6f);
  EXPECT_FLOAT_EQ(person.frames(2, 0), 1.0f);  // the hip's height stays
  EXPECT_EQ(person.controls.col(0), Eigen::Vector4f::Zero());
  EXPECT_EQ(person.controls.col(1), Eigen::Vector4f(2.0f, 0.1f, 0.5f, -0.05f));
  EXPECT_EQ(person.controls.col(2), Eigen::Vector4f(1, 0, 0, 0));
  EXPECT_TRUE(ParticlesOf(recording, 1).controls.isZero());
  const BodyMotion back = BodyFromParticles(person.frames, person.place);
  for (int t = 0; t < 6; ++t) {
    EXPECT_LT((back[t] - recording.bodies[0][t]).cwiseAbs().maxCoeff(), 1e-6);
  }
}

TEST(PushParticlesTest, TheMirrorIsThatOfBodies) {
  const BodyRecording recording = OnePushed(3);
  const ObservedMotion person = ParticlesOf(recording, 0);
  const Trajectories mirrored = Mirrored(person.frames, PushLayout(recording.joint_names));
  const Pose pose = BodyFromParticles(person.frames, Eigen::Vector2f::Zero())[0];
  EXPECT_LT((BodyFromParticles(mirrored, Eigen::Vector2f::Zero())[0] - Mirrored(pose)).norm(),
            1e-6);
}

// Forecasts of zero velocity: the last pose that was seen stays.
class StillGenerator : public MotionGenerator {
 public:
  explicit StillGenerator(ParticleLayout layout) : layout_(std::move(layout)) {}
  const ParticleLayout& layout() const override { return layout_; }
  std::vector<Trajectories> Forecast(const std::vector<ObservedMotion>& people,
                                     int frames) const override {
    std::vector<Trajectories> still;
    for (const ObservedMotion& person : people) {
      still.push_back(person.frames.rightCols(1).replicate(1, frames));
    }
    return still;
  }

 private:
  ParticleLayout layout_;
};

TEST(PushParticlesTest, AGeneratorGoesOnWhereTheRecordingWasShownTo) {
  const BodyRecording recording = OnePushed(10);
  GeneratorSettings settings;
  settings.observed = 4;
  settings.rate = 60.0;
  const StillGenerator still(PushLayout(recording.joint_names));
  const auto bodies = Unwrapped(GenerateBodies(settings, still, recording));
  ASSERT_EQ(bodies[1].size(), 10u);
  EXPECT_LT((bodies[1][3] - recording.bodies[1][3]).norm(), 1e-6);
  EXPECT_LT((bodies[1][9] - recording.bodies[1][3]).norm(), 1e-6);
  settings.rate = 100.0;
  EXPECT_TRUE(
      Contains(ProblemOf(GenerateBodies(settings, still, recording)), "60 frames per second"));
  settings.rate = 60.0;
  settings.observed = 10;
  EXPECT_FALSE(GenerateBodies(settings, still, recording).ok());
}

TEST(PushParticles, PushesOfAnotherKindAreNamed) {
  Scene scene = OnePushed(5).pendulum.scene;
  scene.pushes[0].kind = PushKind::kExternal;
  GeneratorSettings settings;
  settings.push_kinds = {PushKind::kNet};
  EXPECT_TRUE(Contains(OtherPushKinds(settings, scene),
                       "of kind net and is applied to pushes of kind external"));
  settings.push_kinds = {PushKind::kNet, PushKind::kExternal};
  EXPECT_EQ(OtherPushKinds(settings, scene), "");
  settings.push_kinds.clear();
  EXPECT_EQ(OtherPushKinds(settings, scene), "") << "not known";
}

}  // namespace
}  // namespace pushid
