// Files that the BVH reader refuses, with a message that says where and why.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "datasets/formats/bvh.h"
#include "tests/datasets/raw_bvh.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

using BvhErrorsTest = TempDirTest;

constexpr char kGood[] =
    "HIERARCHY\n"                                 // line 1
    "ROOT Hips\n"                                 // 2
    "{\n"                                         // 3
    "OFFSET 0 0 0\n"                              // 4
    "CHANNELS 3 Xposition Yposition Zposition\n"  // 5
    "JOINT Leg\n"                                 // 6
    "{\n"                                         // 7
    "OFFSET 0 0 -900\n"                           // 8
    "CHANNELS 3 Zrotation Yrotation Xrotation\n"  // 9
    "End Site\n"                                  // 10
    "{\n"                                         // 11
    "OFFSET 0 0 -50\n"                            // 12
    "}\n"                                         // 13
    "}\n"                                         // 14
    "}\n"                                         // 15
    "MOTION\n"                                    // 16
    "Frames: 3\n"                                 // 17
    "Frame Time: 0.016667\n"                      // 18
    "1 2 3 4 5 6\n"                               // 19
    "1 2 3 4 5 6\n"                               // 20
    "1 2 3 4 5 7\n";                              // 21

struct Damage {
  const char* from;               // the first occurrence in kGood ...
  const char* to;                 // ... is replaced by this
  std::vector<std::string> says;  // parts of the message; "#12" stands for "<file>:12: "
};

TEST_F(BvhErrorsTest, EveryDamageIsNamedWithItsLine) {
  const std::vector<Damage> damages = {
      {"HIERARCHY", "HIERARCH", {"#1", "not a BVH file"}},
      {"Hips", "", {"#2", "no name"}},
      {"ROOT", "JOINT", {"#2", "outside of any ROOT"}},
      {"JOINT Leg", "ROOT Leg", {"#6", "is a } missing"}},
      {"JOINT Leg", "JOINT Hips", {"#6", "'Hips'", "unique"}},
      {"{\nOFFSET 0 0 0", "OFFSET 0 0 0", {"#3", "{ must follow"}},
      {"OFFSET 0 0 0\n", "", {"#14", "'Hips' has no OFFSET"}},
      {"OFFSET 0 0 -50\n", "", {"#12", "End Site has no OFFSET"}},
      {"OFFSET 0 0 0\n", "OFFSET 0 0 0\nOFFSET 0 0 0\n", {"#5", "second OFFSET"}},
      {"OFFSET 0 0 -900", "OFFSET 0 zero -900", {"#8", "'zero' is not a number"}},
      {"OFFSET 0 0 -900", "OFFSET 0 0", {"#9", "three numbers", "'CHANNELS'"}},
      {"OFFSET 0 0 -900", "OFFSET 0 0 inf", {"#8", "'inf' is not a finite number"}},
      {"OFFSET 0 0 -900", "OFFSET 0 0 1e999", {"#8", "'1e999' does not fit"}},
      {"3 Zrotation", "3 Wrotation", {"#9", "'Leg'", "'Wrotation' is not a channel", "Zrotation"}},
      {"3 Zrotation", "4 Zrotation", {"#10", "'End' is not a channel"}},
      {"3 Zrotation", "2 Zrotation", {"#9", "'Xrotation' is not expected"}},
      {"3 Zrotation", "7 Zrotation", {"#9", "0 to 6"}},
      {"3 Zrotation", "-1 Zrotation", {"#9", "0 to 6"}},
      {"3 Zrotation", "Zrotation", {"#9", "0 to 6", "'Zrotation'"}},
      {"3 Zrotation", "3 Xrotation", {"#9", "'Leg' lists Xrotation twice"}},
      {"CHANNELS 3 Z", "CHANNELS 0\nCHANNELS 3 Z", {"#10", "second CHANNELS"}},
      {"}\nMOTION", "MOTION", {"#15", "1 closing } missing"}},
      {"}\nMOTION", "}\n}\nMOTION", {"#16", "has no matching {"}},
      {"MOTION", "", {"#17", "'Frames:' is not expected"}},
      {"MOTION", "MOTION now", {"#16", "'now'"}},
      {"Frames: 3\n", "", {"#17", "'Frames:' is expected", "'Frame Time: 0.016667'"}},
      {"Frames: 3", "Frames: -3", {"#17", "1 or more", "'-3'"}},
      {"Frames: 3", "Frames: 0", {"#17", "1 or more"}},
      {"Frames: 3", "Frames: 3.5", {"#17", "whole number", "'3.5'"}},
      {"Frames: 3", "Frames: three", {"#17", "'three'"}},
      {"Frames: 3", "Frames: 2", {"#21", "wrong frame count", "is 2"}},
      {"Frames: 3", "Frames: 4", {"#21", "wrong frame count", "is 4", "after 3", "truncated"}},
      {"Frames: 3", "Frames: 2000000000", {"#21", "wrong frame count", "is 2000000000"}},
      {"Frames: 3", "Frames: 99999999999", {"#17", "whole number"}},
      {"Frame Time: 0.016667\n", "", {"#18", "'Frame Time:' is expected"}},
      {"0.016667", "", {"#18", "a number is missing"}},
      {"0.016667", "0", {"#18", "frame time is 0 s", "10000 to 1 frames per second"}},
      {"0.016667", "-0.016667", {"#18", "frame time is -0.016667 s"}},
      {"0.016667", "16.667", {"#18", "frame time is 16.667 s"}},
      {"0.016667", "1e-7", {"#18", "frame time is 1e-07 s"}},
      {"0.016667", "nan", {"#18", "'nan' is not a finite number"}},
      {"0.016667", "0,016667", {"#18", "a point, not a comma"}},
      {"4 5 7", "4 5", {"#21", "has 5 numbers, not 6", "truncated"}},
      {"4 5 7", "4 5 7 8", {"#21", "more than the 6 numbers"}},
      {"4 5 7", "4 5 NaN", {"#21", "number 6 of the row (Leg Xrotation)", "'NaN'", "finite"}},
      {"4 5 7", "-inf 5 7", {"#21", "number 4 of the row (Leg Zrotation)", "'-inf'"}},
      {"4 5 7", "4 five 7", {"#21", "(Leg Yrotation)", "'five' is not a number"}},
      {"4 5 7", "4 5.0.1 7", {"#21", "'5.0.1' is not a number"}},
      {"4 5 7", "4 +-5 7", {"#21", "'+-5' is not a number"}},
      {"4 5 7", "4 0x1p3 7", {"#21", "'0x1p3' is not a number"}},
      {"4 5 7", "4 5,5 7", {"#21", "'5,5'", "a point, not a comma"}},
      {"4 5 7", "4 1e400 7", {"#21", "does not fit"}},
  };
  for (const Damage& damage : damages) {
    std::string text = kGood;
    const std::size_t at = text.find(damage.from);
    ASSERT_NE(at, std::string::npos) << damage.from;
    text.replace(at, std::string(damage.from).size(), damage.to);
    const std::string path = WriteText("bad.bvh", text);
    const Result<PointMotion> positions = ReadBvhPoints(path);
    const Result<BvhMotion> motion = ReadBvh(path);
    SCOPED_TRACE(std::string(damage.from) + " -> " + damage.to);
    ASSERT_FALSE(positions.ok());
    ASSERT_FALSE(motion.ok());
    EXPECT_EQ(positions.error().ToString(), motion.error().ToString());
    for (const std::string& part : damage.says) {
      EXPECT_TRUE(Contains(motion.error().ToString(),
                           part[0] == '#' ? path + ":" + part.substr(1) + ": " : part));
    }
  }
}

// A file cut anywhere is an error, with two exceptions that cannot be told from a whole file:
// before the last newline, and within the last number.
TEST_F(BvhErrorsTest, CutAnywhere) {
  const std::string text = kGood;
  for (std::size_t length = 0; length + 2 < text.size(); ++length) {
    const Result<BvhMotion> read = ReadBvh(WriteText("cut.bvh", text.substr(0, length)));
    ASSERT_FALSE(read.ok()) << text.substr(0, length);
    EXPECT_FALSE(read.error().message.empty());
  }
}

// To the last bit, in every form that a file may have.
TEST_F(BvhErrorsTest, NumbersInEveryForm) {
  const std::vector<std::string> tokens = {"0",
                                           "-0",
                                           "7",
                                           "-7.25",
                                           "1.",
                                           ".5",
                                           "0.1",
                                           "455.778020",
                                           "-3.324210",
                                           "1e3",
                                           "-2.5E-3",
                                           "+4.5",
                                           "000.000001",
                                           "9007199254740993",
                                           "9007199254740992.5",
                                           "0.3333333333333333",
                                           "12345678901234567890",
                                           "0.0000000000000001234",
                                           "99999.999999999999"};
  std::string row;
  for (const std::string& token : tokens) row += " " + token;
  std::string joints, ends;
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    joints += (i == 0 ? "ROOT a" : "JOINT a") + std::to_string(i) +
              " { OFFSET 0 0 0 CHANNELS 1 Xrotation ";
    ends += " }";
  }
  const std::string path =
      WriteText("forms.bvh", "HIERARCHY\n" + joints + "End Site { OFFSET 0 0 0 }" + ends +
                                 "\nMOTION\nFrames: 2\nFrame Time: 1\n" + row + "\n" + row + "\n");
  const BvhMotion read = Unwrapped(ReadBvh(path));
  // Where nobody asks for their values too; otherwise all are kept.
  PointReadOptions of_root;
  of_root.choose = [](const PointMotion&) { return std::vector<int>{0}; };
  EXPECT_EQ(Unwrapped(ReadBvhPoints(path, of_root)).positions[0].size(), 2u);
  of_root.kept_rows = 1 << 30;
  EXPECT_EQ(Unwrapped(ReadBvhPoints(path, of_root)).values, read.values);
  ASSERT_EQ(read.values.size(), 2 * tokens.size());
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    const double expected = std::strtod(tokens[i].c_str(), nullptr);
    EXPECT_EQ(read.values[i], expected) << tokens[i];
    EXPECT_EQ(std::signbit(read.values[i]), std::signbit(expected)) << tokens[i];
  }
}

TEST_F(BvhErrorsTest, FilesThatAreNone) {
  EXPECT_EQ(ProblemOf(ReadBvh(Path("missing.bvh"))),
            Path("missing.bvh") + ": there is no such file");
  EXPECT_TRUE(Contains(ProblemOf(ReadBvh(Path(""))), "this is a folder"));
  EXPECT_FALSE(ReadBvh("").ok());
  EXPECT_FALSE(ReadBvh(WriteText("empty.bvh", "")).ok());
  EXPECT_FALSE(ReadBvh(WriteText("zeros.bvh", std::string(100000, '\0'))).ok());
}

TEST_F(BvhErrorsTest, NoChannelsAtAll) {
  EXPECT_TRUE(Contains(
      ProblemOf(ReadBvh(WriteText(
          "a.bvh", "HIERARCHY\nROOT a { OFFSET 0 0 0 }\nMOTION\nFrames: 1\nFrame Time: 1\n\n"))),
      "a.bvh:3: no joint has any channels"));
}

}  // namespace
}  // namespace pushid
