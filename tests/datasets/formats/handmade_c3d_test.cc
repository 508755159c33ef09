// C3D: what the format allows and the project's own writer does not make.
#include "tests/datasets/handmade_c3d.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/datasets/c3d_samples.h"
#include "tests/datasets/c3d_writer.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr C3dProcessor kProcessors[] = {C3dProcessor::kIntel, C3dProcessor::kDec,
                                        C3dProcessor::kMips};

class HandmadeC3dTest : public TempDirTest {
 protected:
  C3dFile Read(const HandmadeC3d& file) {
    return Unwrapped(ReadC3d(WriteText("a.c3d", file.Bytes())));
  }
  std::string Problem(const HandmadeC3d& file) {
    return ProblemOf(ReadC3d(WriteText("a.c3d", file.Bytes())));
  }
  // A file of three channels, 100 raw each, with whatever `add` says of them.
  template <typename Add>
  static HandmadeC3d ThreeChannels(Add add) {
    HandmadeC3d file;
    file.raw = {100, 100, 100};
    file.Group("ANALOG");
    add(&file);
    return file;
  }
  // The first sample of each channel.
  static std::vector<double> Samples(const C3dFile& file) {
    std::vector<double> samples;
    for (const C3dAnalogChannel& channel : file.analog) samples.push_back(channel.samples[0]);
    return samples;
  }
};

TEST_F(HandmadeC3dTest, SamplesAreRawLessOffsetTimesBothScales) {
  struct Case {
    const char* what;
    HandmadeC3d (*make)(C3dProcessor);
    std::vector<double> force;
  };
  const Case cases[] = {
      {"unsigned", &UnsignedC3d, {200.0}},
      {"unsigned, unsaid", &UnsaidUnsignedC3d, {-100.0, 100.0}},
      {"offset and general scale", &OffsetC3d, {300.0, -900.0}},
      {"300 channels", &ManyChannelsC3d, std::vector<double>(300, 100.0)},
  };
  for (const Case& one : cases) {
    for (C3dProcessor processor : kProcessors) {
      for (bool floating : {false, true}) {
        SCOPED_TRACE(one.what + (" " + NameOf(processor)) + (floating ? " float" : " integer"));
        HandmadeC3d file = one.make(processor);
        file.floating = floating;
        const C3dFile read = Read(file);
        ASSERT_EQ(read.analog.size(), one.force.size());
        EXPECT_EQ(read.num_frames(), 3);
        for (std::size_t i = 0; i < one.force.size(); ++i) {
          ASSERT_EQ(read.analog[i].samples.size(), 3u);
          // The scale is a float in the file.
          EXPECT_NEAR(read.analog[i].samples[2], one.force[i], 1e-5) << i;
        }
      }
    }
  }
}

TEST_F(HandmadeC3dTest, ScalesAreOfEveryChannelOrOfNone) {
  using Numbers = std::vector<double>;
  EXPECT_EQ(Samples(Read(ThreeChannels([](HandmadeC3d*) {}))), Numbers(3, 100.0));
  EXPECT_EQ(Samples(Read(ThreeChannels([](HandmadeC3d* file) {
              file->Reals("SCALE", {}, {0});
              file->Reals("OFFSET", {90.0}, {});  // one value without dimensions
            }))),
            Numbers(3, 10.0));
  // Programs leave room for more channels than they used.
  EXPECT_EQ(Samples(Read(ThreeChannels([](HandmadeC3d* file) {
              file->Reals("SCALE", {1.0, 2.0, 3.0, 4.0}, {4});
            }))),
            (Numbers{100.0, 200.0, 300.0}));
  const std::string scale = Problem(ThreeChannels([](HandmadeC3d* file) {
    file->Reals("SCALE", {1.0, 2.0}, {2});
  }));
  EXPECT_TRUE(Contains(scale, "a.c3d: ANALOG:SCALE ends after 2 of 3 analog channels"));
  EXPECT_TRUE(Contains(scale, "before 'channel_3'; export the file again"));
  EXPECT_TRUE(Contains(
      Problem(ThreeChannels([](HandmadeC3d* file) { file->Integers("OFFSET", {1}, {1}); })),
      "ANALOG:OFFSET ends after 1 of 3 analog channels"));
}

// The upper half of each count is that of a negative integer.
TEST_F(HandmadeC3dTest, MoreFramesThanTheHeaderCounts) {
  constexpr int kFrames = 65536 + 40000;
  for (C3dProcessor processor : kProcessors) {
    for (const HandmadeC3d& file :
         {TrialC3d(kFrames, processor), LongFramesC3d(kFrames, processor)}) {
      const C3dFile read = Read(file);
      EXPECT_EQ(read.announced_frames, kFrames);
      ASSERT_EQ(read.num_frames(), kFrames) << NameOf(processor);
      EXPECT_EQ(read.points[0][kFrames - 1], Eigen::Vector3d((kFrames - 1) % 1000, 200.0, 300.0));
    }
  }
  HandmadeC3d cut = TrialC3d(kFrames);
  cut.frames = 70000;
  EXPECT_TRUE(Contains(Problem(cut), "of 105536 frames: it is truncated"));
}

// Poses of two segments a frame, the second one turned and once not seen, and nothing else, as
// Theia3D writes them; or beside a point.
HandmadeC3d Poses(C3dProcessor processor, int points, int ratio) {
  HandmadeC3d file(processor);
  file.points = points;
  file.Group("ROTATION");
  file.Integers("USED", {2}, {});
  file.Integers("DATA_START", {points > 0 ? 4 : 3}, {});  // behind head, parameters and points
  file.Integers("RATIO", {ratio}, {});
  file.Texts("LABELS", {"pelvis_4X4", "l_foot"}, 12);
  for (int frame = 0; frame < file.frames * ratio; ++frame) {
    for (const auto& [turned, x] : {std::pair(false, 100.0), std::pair(true, 200.0)}) {
      const bool hidden = turned && frame == ratio;  // in the second frame
      const double c = turned ? 0.0 : 1.0, s = turned ? 1.0 : 0.0;
      for (double value : {c, s, 0.0, 0.0, -s, c, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, x + frame, 7.0, 8.0,
                           1.0, hidden ? -1.0 : 0.0}) {
        AppendC3dReal(value, processor, &file.behind);
      }
    }
  }
  return file;
}

TEST_F(HandmadeC3dTest, OriginsOfSegmentsArePoints) {
  for (C3dProcessor processor : kProcessors) {
    for (int points : {0, 1}) {
      for (int ratio : {1, 2}) {
        SCOPED_TRACE(NameOf(processor) + " " + std::to_string(points) + std::to_string(ratio));
        const C3dFile read = Read(Poses(processor, points, ratio));
        ASSERT_EQ(read.points.size(), points + 2u);
        EXPECT_EQ(read.num_frames(), 3);
        const int pelvis = FindPoint(read, "pelvis"), foot = FindPoint(read, "l_foot");
        ASSERT_GE(pelvis, 0);
        ASSERT_GE(foot, 0);
        for (int t = 0; t < 3; ++t) {
          EXPECT_EQ(read.points[pelvis][t], Eigen::Vector3d(100.0 + t * ratio, 7.0, 8.0));
        }
        EXPECT_EQ(read.points[foot][2], Eigen::Vector3d(200.0 + 2 * ratio, 7.0, 8.0));
        EXPECT_TRUE(std::isnan(read.points[foot][1].x()));
      }
    }
  }
}

TEST_F(HandmadeC3dTest, PosesCutShortAreAnError) {
  HandmadeC3d file = Poses(C3dProcessor::kIntel, 0, 1);
  file.behind.resize(file.behind.size() - 1);
  EXPECT_TRUE(Contains(Problem(file), "the file ends before the last pose of 3 frames"));
}

}  // namespace
}  // namespace pushid
