// Clips of exponential maps: read, refused with line and column, cut into the protocol's windows.
#include "datasets/loading/generator_data.h"
#include "tests/mocap_support.h"
#include "tests/simulators/synthetic_clips.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

class MocapFolderTest : public TempDirTest {
 protected:
  void SetUp() override {
    TempDirTest::SetUp();
    WriteText("skeleton.json", kSmallSkeleton);
    for (int i = 1; i <= 11; ++i) {
      WriteText("train/sway/sway_" + std::to_string(i) + ".txt", SmallClip(120 + i, 0.3, i));
    }
  }
  MocapFolder Read(const std::string& folder) { return Unwrapped(ReadMocapFolder(folder)); }
  std::string Complaint(const std::string& clip) {
    WriteText("train/sway/sway_1.txt", clip);
    return ProblemOf(ReadMocapFolder(Path("")));
  }
};

// Joint 1 hangs on the root and stands at its offset; joint 2's offset of 0.3 m is turned by joint
// 1's map, about z; joint 5 shares joint 1's place.
TEST_F(MocapFolderTest, AFrameByHand) {
  WriteText("train/sway/sway_1.txt",
            "9,9,9,0,0,0,0,0,1.5707963267948966,0,0,0,0,0,0,0,0,0,0,0,0\n");
  const MocapFolder mocap = Read(Path(""));
  const Eigen::VectorXf pose = mocap.clips[0].motion.col(0);
  ASSERT_EQ(pose.size(), 12);
  EXPECT_LT((pose.segment<3>(0) - Eigen::Vector3f(0, 0.5f, 0)).norm(), 1e-6f);
  EXPECT_LT((pose.segment<3>(3) - Eigen::Vector3f(0.3f, 0.5f, 0)).norm(), 1e-6f);
  EXPECT_LT((pose.segment<3>(6) - Eigen::Vector3f(0.3f, 0.3f, 0)).norm(), 1e-6f);
  EXPECT_LT((pose.segment<3>(9) - Eigen::Vector3f(0.3f, 0.7f, 0)).norm(), 1e-6f);
  EXPECT_EQ(mocap.skeleton.layout.weights, (std::vector<float>{2, 1, 1, 1}));
  EXPECT_EQ(mocap.skeleton.layout.parents, (std::vector<int>{kFixedPoint, 0, 1, 1}));
  EXPECT_EQ(mocap.skeleton.layout.mirrored, (std::vector<int>{0, 1, 3, 2}));
}

TEST_F(MocapFolderTest, ClipsStandInTheOrderOfTheirNumbersAndTheLastValidates) {
  const MocapFolder mocap = Read(Path(""));
  ASSERT_EQ(mocap.clips.size(), 11u);
  EXPECT_EQ(mocap.clips[1].name, "sway_2");
  EXPECT_EQ(mocap.clips[10].name, "sway_11");
  EXPECT_TRUE(IsValidationClip(mocap, mocap.clips[10]));
  EXPECT_FALSE(IsValidationClip(mocap, mocap.clips[9]));
  EXPECT_EQ(LearntMotions(mocap, false).size(), 20u);
  EXPECT_EQ(LearntMotions(mocap, true).size(), 22u);
}

TEST_F(MocapFolderTest, TestClipsAreNeverLearntFrom) {
  EXPECT_TRUE(MakeForecastWindows(Read(Path("")), ForecastProtocol::kTest).empty())
      << "no other clips stand in for them";
  WriteText("test/sway/sway_1.txt", SmallClip(400, 0.3, 0));
  const MocapFolder mocap = Read(Path(""));
  EXPECT_EQ(LearntMotions(mocap, true).size(), 22u);
  EXPECT_EQ(MakeForecastWindows(mocap, ForecastProtocol::kTest).size(), 8u);
}

TEST_F(MocapFolderTest, AFolderOfActionsFindsItsSkeletonOneHigher) {
  EXPECT_EQ(Read(Path("train")).clips.size(), 11u);
  EXPECT_EQ(Read(Path("train/")).clips.size(), 11u);
}

TEST_F(MocapFolderTest, MalformedClipsAreNamedWithLineAndColumn) {
  EXPECT_TRUE(Contains(Complaint("1,2,3\n"), "sway_1.txt:1:5: the line ends after 3 numbers"));
  const std::string good = SmallClip(1, 0.1, 0);
  EXPECT_TRUE(Contains(Complaint(good + "0,abc" + good.substr(8)),
                       "sway_1.txt:2:3: number 2: 'abc' is not a number"));
  EXPECT_TRUE(Contains(Complaint(good.substr(0, good.size() - 1) + ",7\n"),
                       "the line has more numbers than it should"));
  EXPECT_TRUE(Contains(Complaint("nan" + good.substr(8)), "sway_1.txt:1:1: number 1: "));
  EXPECT_TRUE(Contains(Complaint("\n\n"), "the file has no frames"));
}

TEST_F(MocapFolderTest, SkeletonsThatDoNotHangTogetherAreRefused) {
  const auto complaint = [&](const std::string& from, const std::string& to) {
    std::string text = kSmallSkeleton;
    text.replace(text.find(from), from.size(), to);
    return ProblemOf(ReadMocapSkeleton(WriteText("skeleton.json", text)));
  };
  EXPECT_TRUE(Contains(complaint("[-1, 0, 1", "[-1, 2, 1"), "an earlier joint"));
  EXPECT_TRUE(Contains(complaint("[1, 2, 3, 4]", "[1, 2, 3, 9]"), "holds '9'"));
  EXPECT_TRUE(Contains(complaint("\"5\": 1", "\"5\": 0"), "a joint that is not used"));
  EXPECT_TRUE(Contains(complaint("3-3 <-> 4-4", "3-3 <-> 4-5"), "do not match"));
  EXPECT_TRUE(Contains(complaint("3-3 <-> 4-4", "3-3 <-> 5-5"), "not used"));
  EXPECT_TRUE(Contains(complaint("[0, 300, 0]", "[0, 300]"), "lists of three numbers"));
  EXPECT_TRUE(Contains(complaint("\"used\"", "\"other\""), "used is missing"));
}

TEST_F(MocapFolderTest, NothingThereIsSaid) {
  EXPECT_TRUE(Contains(ProblemOf(ReadMocapFolder(Path("nowhere"))), "skeleton.json"));
  WriteText("empty/skeleton.json", kSmallSkeleton);
  EXPECT_TRUE(Contains(ProblemOf(ReadMocapFolder(Path("empty"))), "no clips"));
}

TEST(ForecastWindowsTest, TestWindowsStartWhereTheLiteratureDoes) {
  EXPECT_EQ(TestWindowStarts(300), (std::vector<int>{130, 102, 47, 140, 51, 33, 171, 105}));
  EXPECT_TRUE(TestWindowStarts(75).empty());
  EXPECT_EQ(TestWindowStarts(76), std::vector<int>(8, 0));
}

TEST_F(MocapFolderTest, WindowsAreCutWhereTheyStart) {
  const MocapFolder mocap = Read(Path(""));
  const auto windows = MakeForecastWindows(mocap, ForecastProtocol::kValidation, 3);
  // 131 frames, every second: 66; starts 0 .. 16.
  ASSERT_EQ(windows.size(), 6u);
  const Trajectories motion = EverySecond(mocap.clips[10].motion, 0);
  EXPECT_EQ(windows[1].observed.col(0), motion.col(3));
  EXPECT_EQ(windows[1].future.col(24), motion.col(3 + 49));
  EXPECT_EQ(MakeForecastWindows(mocap, ForecastProtocol::kValidation).size(), 9u);
}

// Three numbers of translation and 32 maps a line; the right knee bends by a quarter turn about x.
std::string Human36mClip(int frames) {
  std::string text;
  for (int t = 0; t < frames; ++t) {
    for (int i = 0; i < 99; ++i)
      text += std::string(i > 0 ? "," : "") + (i == 9 ? "1.5707963" : "0");
    text += "\n";
  }
  return text;
}

TEST_F(MocapFolderTest, Human36mIsReadByItsSubjects) {
  for (const char* clip : {"S1/walking_1", "S5/walking_1", "S5/walking_2", "S11/walking_1"}) {
    WriteText("h36m/" + std::string(clip) + ".txt", Human36mClip(400));
  }
  const MocapFolder mocap = Read(Path("h36m"));
  ASSERT_EQ(mocap.clips.size(), 4u);
  EXPECT_EQ(mocap.skeleton.layout.num_particles(), 22);
  EXPECT_EQ(mocap.skeleton.layout.joints, 32);
  const Eigen::VectorXf pose = mocap.clips[0].motion.col(0);
  // Knee (joint 2) below its hip at x = -132.9 mm; the shin, turned about x, points along z.
  EXPECT_LT((pose.segment<3>(0) - Eigen::Vector3f(-0.132949f, -0.442895f, 0)).norm(), 1e-5f);
  const Eigen::Vector3f ankle(-0.132949f, -0.442895f, 0.454206f);  // row vectors: x R
  EXPECT_LT((pose.segment<3>(3) - ankle).norm(), 1e-5f);
  int tested = 0, validation = 0;
  for (const MocapClip& clip : mocap.clips) {
    EXPECT_EQ(clip.action, "walking");
    EXPECT_EQ(clip.is_test, clip.subject == 5);
    tested += clip.is_test;
    validation += IsValidationClip(mocap, clip);
  }
  EXPECT_EQ(tested, 2);
  EXPECT_EQ(validation, 1);
  EXPECT_EQ(LearntMotions(mocap, false).size(), 2u);  // both phases of subject 1
  EXPECT_EQ(MakeForecastWindows(mocap, ForecastProtocol::kTest).size(), 8u);
  for (const auto& [first, second] : PairedWindowStarts(200, 167)) {
    EXPECT_TRUE(first >= 16 && first < 50);
    EXPECT_EQ(second, 16);  // the only one
  }
  EXPECT_TRUE(PairedWindowStarts(200, 166).empty());
  WriteText("h36m/S5/walking_2.txt", "1,2,3\n");
  EXPECT_TRUE(Contains(ProblemOf(ReadMocapFolder(Path("h36m"))), "a line has 99 numbers"));
}

// Written and read back: four actions, in which bones keep their length and a seed its figures.
TEST_F(MocapFolderTest, SyntheticClipsWalk) {
  SyntheticClipOptions options;
  options.clips = 2;
  options.frames = 200;
  ASSERT_FALSE(WriteSyntheticClips(Path("made"), options));
  const MocapFolder made = Read(Path("made"));
  ASSERT_EQ(made.clips.size(), 12u);
  const ParticleLayout& layout = made.skeleton.layout;
  for (const MocapClip& clip : made.clips) {
    EXPECT_EQ(clip.is_test, clip.name.back() == '3');
    const Eigen::MatrixXf lengths = BoneLengths(clip.motion, layout);
    EXPECT_LT((lengths.colwise() - lengths.col(0)).cwiseAbs().maxCoeff(), 1e-5f);
    // The knee (particle 0) hangs 42 cm below a hip that does not move.
    EXPECT_NEAR(lengths(0, 0), 0.42f, 1e-5f);
  }
  ASSERT_FALSE(WriteSyntheticClips(Path("again"), options));
  EXPECT_EQ(Read(Path("again")).clips[5].motion, made.clips[5].motion);
  options.seed = 2;
  ASSERT_FALSE(WriteSyntheticClips(Path("other"), options));
  EXPECT_NE(Read(Path("other")).clips[5].motion, made.clips[5].motion);
}

TEST(RealMocapTest, TheValidationSplitHasTheWindowsOfTheProtocol) {
  if (MocapRoot().empty()) GTEST_SKIP() << kNoMocap;
  const MocapFolder mocap = Unwrapped(ReadMocapFolder(MocapRoot()));
  EXPECT_EQ(mocap.skeleton.layout.num_particles(), 25);
  std::map<std::string, int> windows;
  for (const ForecastWindow& window :
       MakeForecastWindows(mocap, ForecastProtocol::kValidation, 1)) {
    ++windows[window.action];
  }
  EXPECT_EQ(windows, (std::map<std::string, int>{{"basketball", 153},
                                                 {"basketball_signal", 1571},
                                                 {"directing_traffic", 1803},
                                                 {"jumping", 127},
                                                 {"running", 27},
                                                 {"soccer", 238},
                                                 {"walking", 116}}));
}

}  // namespace
}  // namespace pushid
