// Peers from files, and their scores.
#include "ident/peers/peer_files.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/models/mrt_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

// Frames dt apart; the pendulum is not looked at.
BodyRecording Walking(int people, int frames, double dt = 1.0 / 60.0) {
  BodyRecording recording;
  recording.pendulum.id = "a";
  recording.pendulum.labels.Set(kSettingLabel, "row_1");
  recording.pendulum.scene.dt = dt;
  recording.bodies = WalkingGroup(people, frames);
  for (const BodyMotion& body : recording.bodies) {
    const RestorationInput person = WithPendulum(body[0], 80);
    recording.pendulum.scene.people.push_back(
        {person.body, {person.q[0], Vector4<double>::Zero()}});
    recording.pendulum.subject_ids.push_back("s");
    recording.pendulum.hip.emplace_back(frames, body[0].col(0));
    recording.pendulum.states.emplace_back(
        frames, PendulumState<double>{person.q[0], Vector4<double>::Zero()});
  }
  return recording;
}

// Holds the last given poses.
class HoldingPeer : public Peer {
 public:
  std::string_view name() const override { return "holding"; }
  int given_frames() const override { return 10; }
  std::vector<BodyMotion> Continue(const std::vector<BodyMotion>& people,
                                   int frames) const override {
    std::vector<BodyMotion> motions;
    for (const BodyMotion& person : people) {
      BodyMotion motion(person.begin(), person.begin() + given_frames());
      motion.resize(frames, motion.back());
      motions.push_back(motion);
    }
    return motions;
  }
};

TEST(PeerScoresTest, GivenFramesCountOnlyWhereAllFramesDo) {
  const BodyRecording recording = Walking(2, 30);
  BodyScores scores;
  ScorePeer(HoldingPeer(), recording, &scores);
  double sum = 0.0;
  for (int t = 10; t < 30; ++t) {
    for (const BodyMotion& body : recording.bodies) {
      sum += (body[t] - body[9]).col(0).norm() / 2.0;
    }
  }
  EXPECT_NEAR(scores["holding"][0].value[kHipAde], sum / 20.0, 1e-12);
  EXPECT_NEAR(scores["holding_all_frames"][0].value[kHipAde], sum / 29.0, 1e-12);
}

// 59 frames at 120 Hz are 30 at the peers' rate, of which 10 last for 20 of the recording's. Of
// these the last lies between a given frame and a predicted one, and errs by up to a step.
TEST(PeerScoresTest, OtherRatesAreResampled) {
  BodyScores scores;
  ScorePeer(HoldingPeer(), Walking(1, 59, 1.0 / 120.0), &scores);
  EXPECT_NEAR(scores["holding"][0].value[kHipAde] * 39.0,
              scores["holding_all_frames"][0].value[kHipAde] * 58.0, 0.02);
  EXPECT_EQ(AtPeerRate(WalkingGroup(1, 59)[0], 1.0 / 120.0).size(), 30u);
}

TEST(PeerScoresTest, ARecordingThatIsTooShortFailsByName) {
  BodyScores scores;
  ScorePeer(MrtPeer(RandomMrt()), Walking(2, 21), &scores);
  for (const char* name : {"mrt", "mrt_all_frames"}) {
    EXPECT_EQ(scores[name][0].id, "a");
    EXPECT_TRUE(Contains(scores[name][0].failure, "shorter than the 20 frames that mrt is given"));
  }
  ScorePeer(MrtPeer(RandomMrt()), Walking(2, 22), &scores);
  EXPECT_EQ(scores["mrt"][1].failure, "");
}

using PeerFilesTest = TempDirTest;

TEST_F(PeerFilesTest, MrtComesBackToTheLastBit) {
  RestorationFile file;
  file.kind = RestorationKind::kMrt;
  (*file.settings)[kMrtSizeKey] = "small";
  AddTensors(RandomMrt(), &file.tensors);
  ASSERT_FALSE(WriteRestorationFile(Path("m"), file));
  const auto peer = Unwrapped(LoadPeer(Path("m")));
  EXPECT_EQ(peer->name(), "mrt");
  const std::vector<BodyMotion> group = WalkingGroup(2, 20);
  EXPECT_EQ(peer->Continue(group, 50)[1][49], MrtPeer(RandomMrt()).Continue(group, 50)[1][49]);
}

TEST_F(PeerFilesTest, WhatIsWrongIsNamed) {
  const auto error = [this](const RestorationFile& file) {
    EXPECT_FALSE(WriteRestorationFile(Path("p"), file));
    return ProblemOf(LoadPeer(Path("p")));
  };
  RestorationFile file;
  EXPECT_TRUE(Contains(error(file),
                       "'window'; it must be mrt (what follows a pendulum is "
                       "named by --restoration)"));
  file.kind = RestorationKind::kMrt;
  EXPECT_TRUE(Contains(error(file), "scaling.tokens.mean is missing; train again"));
  AddTensors(RandomMrt(), &file.tensors);
  (*file.settings)[kMrtSizeKey] = "large";
  EXPECT_TRUE(Contains(error(file), "size is 'large'; it must be small or published"));
  (*file.settings)[kMrtSizeKey] = "published";
  EXPECT_TRUE(Contains(error(file), "local_token.weights is 64 x 66, not 128 x 66"));
  EXPECT_TRUE(Contains(ProblemOf(LoadPeer(Path("nowhere"))), "--peer"));
}

}  // namespace
}  // namespace pushid
