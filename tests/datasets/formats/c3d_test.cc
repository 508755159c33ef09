// C3D: what the writer makes the reader reads, for every processor and number format; hand-made
// bytes; damaged files; the two real files, where they are.
#include "datasets/formats/c3d.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "datasets/sensors/force_sensors.h"
#include "tests/datasets/c3d_samples.h"
#include "tests/datasets/c3d_writer.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

// The folder of the real C3D files; "" when there are none.
std::string C3dSamplesRoot() {
  return SharedFolder("PUSHID_C3D_SAMPLES", "c3d_samples", "Vicon.c3d");
}

constexpr char kNoC3dSamples[] =
    "the real C3D files are not here; name their folder by PUSHID_C3D_SAMPLES";

class C3dTest : public TempDirTest {
 protected:
  C3dFile Reread(const C3dFile& file) {
    EXPECT_EQ(ProblemOf(WriteC3d(Path("a.c3d"), file)), "no error");
    return Unwrapped(ReadC3d(Path("a.c3d")));
  }

  // The message for the sample with bytes changed.
  std::string Damaged(std::size_t at, const std::string& bytes) {
    EXPECT_FALSE(WriteC3d(Path("a.c3d"), SampleC3d()));
    std::string text = ReadText(Path("a.c3d"));
    text.replace(at, bytes.size(), bytes);
    WriteText("b.c3d", text);
    return ProblemOf(ReadC3d(Path("b.c3d")));
  }
};

// The floats of the C3D manual's three processors, and VAX ones from DEC's own tables.
TEST(C3dBytesTest, HandMadeNumbers) {
  const auto real = [](const char* bytes, C3dProcessor processor) {
    return C3dBytes(std::string_view(bytes, 4), processor).Real(0);
  };
  EXPECT_EQ(real("\x00\x00\x80\x3f", C3dProcessor::kIntel), 1.0);
  EXPECT_EQ(real("\x3f\x80\x00\x00", C3dProcessor::kMips), 1.0);
  EXPECT_EQ(real("\x80\x40\x00\x00", C3dProcessor::kDec), 1.0);
  EXPECT_EQ(real("\x80\xc0\x00\x00", C3dProcessor::kDec), -1.0);
  EXPECT_EQ(real("\x60\x41\x00\x00", C3dProcessor::kDec), 3.5);
  EXPECT_EQ(real("\x49\x41\xd0\x0f", C3dProcessor::kDec), static_cast<double>(3.14159f));
  EXPECT_EQ(real("\x00\x00\x00\x00", C3dProcessor::kDec), 0.0);
  const C3dBytes intel("\x34\x12", C3dProcessor::kIntel), mips("\x12\x34", C3dProcessor::kMips);
  EXPECT_EQ(intel.Word(0), 0x1234);
  EXPECT_EQ(mips.Word(0), 0x1234);
  EXPECT_EQ(C3dBytes("\xfe\xff", C3dProcessor::kDec).Integer(0), -2);
}

TEST(C3dBytesTest, WhatIsWrittenIsRead) {
  for (C3dProcessor processor : {C3dProcessor::kIntel, C3dProcessor::kDec, C3dProcessor::kMips}) {
    for (double value : {0.0, 1.0, -1.0, 0.1, 1234.5678, -9.87e-20, 3e20, 16777215.0, 0.99999999}) {
      std::string bytes;
      AppendC3dReal(value, processor, &bytes);
      ASSERT_EQ(bytes.size(), 4u);
      EXPECT_EQ(C3dBytes(bytes, processor).Real(0), static_cast<double>(static_cast<float>(value)))
          << NameOf(processor) << " " << value;
    }
  }
}

TEST_F(C3dTest, RoundTripOfEveryFormat) {
  const C3dFile original = SampleC3d();
  for (C3dProcessor processor : {C3dProcessor::kIntel, C3dProcessor::kDec, C3dProcessor::kMips}) {
    for (bool floating : {true, false}) {
      SCOPED_TRACE(NameOf(processor) + (floating ? " float" : " integer"));
      C3dFile file = original;
      file.processor = processor;
      file.floating = floating;
      const C3dFile read = Reread(file);
      EXPECT_EQ(read.processor, processor);
      EXPECT_EQ(read.floating, floating);
      EXPECT_EQ(read.point_rate_hz, 100.0);
      EXPECT_EQ(read.analog_rate_hz, 1000.0);
      EXPECT_EQ(read.point_unit, "mm");
      EXPECT_EQ(read.screen_y, "+Z");
      EXPECT_EQ(read.first_frame, 5);
      EXPECT_EQ(read.point_names, original.point_names);
      ASSERT_EQ(read.num_frames(), original.num_frames());
      ASSERT_EQ(read.points.size(), original.points.size());
      const double tolerance = floating ? 1e-4 : 0.03;  // mm; 1000 / 32000 for integers
      for (std::size_t i = 0; i < read.points.size(); ++i) {
        for (int frame = 0; frame < read.num_frames(); ++frame) {
          const bool seen = original.points[i][frame].allFinite();
          EXPECT_EQ(read.points[i][frame].allFinite(), seen) << i << " " << frame;
          if (seen) {
            EXPECT_LT((read.points[i][frame] - original.points[i][frame]).norm(), tolerance);
          }
        }
      }
      ASSERT_EQ(read.analog.size(), original.analog.size());
      for (std::size_t i = 0; i < read.analog.size(); ++i) {
        EXPECT_EQ(read.analog[i].name, original.analog[i].name);
        EXPECT_EQ(read.analog[i].unit, original.analog[i].unit);
        ASSERT_EQ(read.analog[i].samples.size(), original.analog[i].samples.size());
        for (std::size_t k = 0; k < read.analog[i].samples.size(); ++k) {
          EXPECT_NEAR(read.analog[i].samples[k], original.analog[i].samples[k],
                      floating ? 1e-3 : 0.05);
        }
      }
      ASSERT_EQ(read.platforms.size(), 1u);
      EXPECT_EQ(read.platforms[0].channels, original.platforms[0].channels);
      EXPECT_TRUE(read.platforms[0].corners.isApprox(original.platforms[0].corners, 1e-6));
    }
  }
}

TEST_F(C3dTest, ManyPointsTakeLabels2) {
  C3dFile file = SampleC3d();
  file.analog.clear();
  file.platforms.clear();
  file.points.clear();
  file.point_names.clear();
  for (int i = 0; i < 300; ++i) {
    file.point_names.push_back("m" + std::to_string(i));
    file.points.push_back(std::vector<Eigen::Vector3d>(4, Eigen::Vector3d(i + 1.0, 2.0, 3.0)));
  }
  const C3dFile read = Reread(file);
  ASSERT_EQ(read.points.size(), 300u);
  EXPECT_EQ(read.point_names[299], "m299");
  EXPECT_EQ(read.points[299][3].x(), 300.0);
}

// Every channel has its own scale, those from the 256th on in SCALE2.
TEST_F(C3dTest, ManyChannelsTakeScale2) {
  C3dFile file = SampleC3d();
  file.platforms.clear();
  file.analog.clear();
  for (int i = 0; i < 510; ++i) {
    file.analog.push_back({"c" + std::to_string(i), "N", std::vector<double>(10, i + 1.0)});
  }
  for (bool floating : {true, false}) {
    file.floating = floating;
    const C3dFile read = Reread(file);
    ASSERT_EQ(read.analog.size(), 510u);
    for (int i = 0; i < 510; ++i) EXPECT_NEAR(read.analog[i].samples[9], i + 1.0, 1e-4) << i;
    ASSERT_NE(read.parameters.Find("ANALOG", "OFFSET2"), nullptr);
    EXPECT_EQ(read.parameters.Find("ANALOG", "SCALE2")->numbers.size(), 255u);
    EXPECT_EQ(read.parameters.Find("ANALOG", "SCALE3"), nullptr);
  }
}

TEST_F(C3dTest, DamagedFilesAreNamed) {
  EXPECT_TRUE(Contains(Damaged(1, "\x51"), "at byte 1: this is not a C3D file"));
  EXPECT_TRUE(Contains(Damaged(0, "\xff"), "the parameters should be here"));
  EXPECT_TRUE(Contains(Damaged(515, "\x50"), "the processor is 80"));
  EXPECT_TRUE(Contains(Damaged(4, "\x03"), "not a multiple of 10"));
  EXPECT_TRUE(Contains(Damaged(20, std::string(4, '\0')), "the frame rate is 0"));
  EXPECT_TRUE(Contains(Damaged(12, std::string("\x00\x00\xc0\x7f", 4)), "the scale of the points"));
  EXPECT_TRUE(Contains(Damaged(8, "\x01"), "the file has no frames"));
  EXPECT_TRUE(Contains(Damaged(16, std::string(2, '\0')), "does not give the start of the data"));
  // The distance of the first group to the next record.
  EXPECT_TRUE(Contains(Damaged(523, "\xff\x7f"), "ends inside its parameters"));
  EXPECT_TRUE(Contains(Damaged(523, "\x01"), "the next parameter begins inside this one"));
}

TEST_F(C3dTest, TruncatedAnywhereIsAnErrorOrTheWholeFrames) {
  ASSERT_FALSE(WriteC3d(Path("a.c3d"), SampleC3d()));
  const std::string text = ReadText(Path("a.c3d"));
  // The last block is filled up; what counts ends before.
  const int frames = SampleC3d().num_frames();
  for (std::size_t size = 0; size + 512 < text.size(); size += 37) {
    WriteText("b.c3d", text.substr(0, size));
    EXPECT_FALSE(ReadC3d(Path("b.c3d")).ok()) << size;
    const Result<C3dFile> read = ReadC3d(Path("b.c3d"), true);
    if (!read.ok()) continue;
    EXPECT_LT(read.value().num_frames(), frames);
    EXPECT_EQ(read.value().announced_frames, frames);
  }
}

TEST_F(C3dTest, WhatCannotBeWritten) {
  const auto message = [this](const C3dFile& file) {
    const MaybeError failed = WriteC3d(Path("bad.c3d"), file);
    return failed ? failed->ToString() : "written";
  };
  C3dFile file = SampleC3d();
  file.points[1].pop_back();
  EXPECT_TRUE(Contains(message(file), "tracks differ in length"));
  file = SampleC3d();
  file.analog[0].samples[3] = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(Contains(message(file), "is not finite"));
  EXPECT_TRUE(Contains(message(C3dFile{}), "0 frames"));
  EXPECT_EQ(CountFiles(), 0);
}

TEST(C3dSamples, Vicon) {
  if (C3dSamplesRoot().empty()) GTEST_SKIP() << kNoC3dSamples;
  const C3dFile file = Unwrapped(ReadC3d(C3dSamplesRoot() + "/Vicon.c3d"));
  EXPECT_EQ(file.num_frames(), 580);
  EXPECT_EQ(file.points.size(), 51u);
  EXPECT_EQ(file.point_rate_hz, 100.0);
  EXPECT_EQ(file.analog.size(), 38u);
  EXPECT_EQ(file.analog_rate_hz, 2000.0);
  EXPECT_EQ(file.analog[0].samples.size(), 11600u);
  EXPECT_EQ(file.analog[0].name, "Voltage.1");
  EXPECT_EQ(file.point_unit, "mm");
  EXPECT_TRUE(file.platforms.empty());
  const int hip = FindPoint(file, "Daphnee:ASISr");
  ASSERT_GE(hip, 0);
  const int other = FindPoint(file, "Daphnee:ASISl");
  ASSERT_GE(other, 0);
  // The two front points of a person's pelvis, mm.
  EXPECT_NEAR((file.points[hip][0] - file.points[other][0]).norm(), 250.0, 100.0);
}

// The sample announces 1149 frames and holds 29.
TEST(C3dSamples, OptotrakIsCutShort) {
  if (C3dSamplesRoot().empty()) GTEST_SKIP() << kNoC3dSamples;
  const std::string path = C3dSamplesRoot() + "/Optotrak.c3d";
  const C3dFile file = Unwrapped(ReadC3d(path, true));
  EXPECT_EQ(file.points.size(), 54u);
  EXPECT_EQ(file.announced_frames, 1149);
  EXPECT_EQ(file.point_rate_hz, 30.0);
  if (file.num_frames() == file.announced_frames) return;  // another copy, a whole one
  EXPECT_TRUE(
      Contains(ProblemOf(ReadC3d(path)),
               "the file ends after " + std::to_string(file.num_frames()) + " of 1149 frames"));
}

}  // namespace
}  // namespace pushid
