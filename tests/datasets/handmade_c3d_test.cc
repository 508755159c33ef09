// C3D: what the format allows and the project's own writer does not make.
#include "tests/datasets/handmade_c3d.h"

#include <gtest/gtest.h>

#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr C3dProcessor kProcessors[] = {C3dProcessor::kIntel, C3dProcessor::kDec,
                                        C3dProcessor::kMips};

class HandmadeC3dTest : public TempDirTest {
 protected:
  C3dFile Read(const HandmadeC3d& file) {
    const Result<C3dFile> read = ReadC3d(WriteText("a.c3d", file.Bytes()));
    EXPECT_TRUE(read.ok()) << read.error().ToString();
    return read.ok() ? read.value() : C3dFile{};
  }
  std::string Problem(const HandmadeC3d& file) {
    const Result<C3dFile> read = ReadC3d(WriteText("a.c3d", file.Bytes()));
    return read.ok() ? "no error" : read.error().ToString();
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
      {"offset and general scale", &OffsetC3d, {300.0, -900.0}},
  };
  for (const Case& one : cases) {
    for (C3dProcessor processor : kProcessors) {
      for (bool floating : {false, true}) {
        SCOPED_TRACE(one.what + (" " + Name(processor)) + (floating ? " float" : " integer"));
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

TEST_F(HandmadeC3dTest, EventsOfTheHeader) {
  for (C3dProcessor processor : kProcessors) {
    const C3dFile read = Read(HeaderEventsC3d(processor));
    ASSERT_EQ(read.events.size(), 2u) << Name(processor);
    EXPECT_EQ(read.events[0].label, "RHS");
    EXPECT_EQ(read.events[0].time_s, 1.5);
    EXPECT_EQ(read.events[1].label, "LTO2");
    EXPECT_EQ(read.events[1].time_s, 2.25);
  }
  // Without the number that says so, they are none.
  HandmadeC3d none = HeaderEventsC3d();
  std::string bytes = none.Bytes();
  bytes[298] = 0;
  const Result<C3dFile> read = ReadC3d(WriteText("b.c3d", bytes));
  ASSERT_TRUE(read.ok()) << read.error().ToString();
  EXPECT_TRUE(read.value().events.empty());
}

TEST_F(HandmadeC3dTest, EventsOfTheGroupComeBeforeThoseOfTheHeader) {
  HandmadeC3d file = HeaderEventsC3d();
  file.Group("EVENT");
  file.Integers("USED", {1}, {});
  file.Reals("TIMES", {1.0, 7.0}, {2, 1});
  const C3dFile read = Read(file);
  ASSERT_EQ(read.events.size(), 1u);
  EXPECT_EQ(read.events[0].time_s, 67.0);
}

// The upper half of each count is that of a negative integer.
TEST_F(HandmadeC3dTest, MoreFramesThanTheHeaderCounts) {
  constexpr int kFrames = 65536 + 40000;
  for (C3dProcessor processor : kProcessors) {
    for (const HandmadeC3d& file :
         {TrialC3d(kFrames, processor), LongFramesC3d(kFrames, processor)}) {
      const C3dFile read = Read(file);
      EXPECT_EQ(read.announced_frames, kFrames);
      ASSERT_EQ(read.num_frames(), kFrames) << Name(processor);
      EXPECT_EQ(read.points[0][kFrames - 1], Eigen::Vector3d((kFrames - 1) % 1000, 200.0, 300.0));
    }
  }
  HandmadeC3d cut = TrialC3d(kFrames);
  cut.frames = 70000;
  EXPECT_TRUE(Contains(Problem(cut), "of 105536 frames: it is truncated"));
}

}  // namespace
}  // namespace pushid
