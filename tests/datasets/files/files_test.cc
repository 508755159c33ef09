// Output files, hashes, JSON files and lines: the ground the readers and writers stand on.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <Eigen/LU>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>

#include "datasets/files/atomic_file.h"
#include "datasets/files/input_file.h"
#include "datasets/files/json_file.h"
#include "datasets/formats/units.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

using AtomicFileTest = TempDirTest;
using JsonFileTest = TempDirTest;
using InputFileTest = TempDirTest;

TEST_F(AtomicFileTest, WritesAndReplaces) {
  ASSERT_FALSE(WriteFileAtomically(Path("a"), "one"));
  EXPECT_EQ(ReadText(Path("a")), "one");
  ASSERT_EQ(::chmod(Path("a").c_str(), 0640), 0);
  ASSERT_FALSE(WriteFileAtomically(Path("a"), "two"));
  EXPECT_EQ(ReadText(Path("a")), "two");
  EXPECT_EQ(CountFiles(), 1);
  struct stat info {};
  ASSERT_EQ(::stat(Path("a").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0640u);
}

TEST_F(AtomicFileTest, WithoutCommitNothingHappens) {
  WriteText("a", "old");
  {
    AtomicFile file;
    ASSERT_FALSE(file.Open(Path("a")));
    file.Append(std::string(1 << 20, 'x'));
    EXPECT_EQ(CountFiles(), 2);
  }
  EXPECT_EQ(CountFiles(), 1);
  EXPECT_EQ(ReadText(Path("a")), "old");
}

TEST_F(AtomicFileTest, CheckWritableLeavesNoTrace) {
  EXPECT_FALSE(CheckWritable(Path("a")));
  EXPECT_EQ(CountFiles(), 0);
  WriteText("a", "old");
  EXPECT_FALSE(CheckWritable(Path("a")));
  EXPECT_EQ(ReadText(Path("a")), "old");
  EXPECT_EQ(CountFiles(), 1);
}

TEST_F(AtomicFileTest, SaysWhyNot) {
  const std::string no_folder = ProblemOf(CheckWritable(Path("no/such/a.json")));
  EXPECT_TRUE(Contains(no_folder, Path("no/such") + " does not exist"));
  EXPECT_TRUE(Contains(no_folder, "create it"));
  EXPECT_TRUE(Contains(ProblemOf(CheckWritable(folder_.string())), "this is a folder"));
  EXPECT_TRUE(CheckWritable(""));
  WriteText("file", "");
  EXPECT_TRUE(CheckWritable(Path("file/a.json")));
  EXPECT_TRUE(CheckWritable("/proc/a.json"));
}

TEST_F(AtomicFileTest, LinksStayLinks) {
  WriteText("target", "old");
  std::filesystem::create_symlink(Path("target"), Path("link"));
  ASSERT_FALSE(WriteFileAtomically(Path("link"), "new"));
  EXPECT_TRUE(std::filesystem::is_symlink(Path("link")));
  EXPECT_EQ(ReadText(Path("target")), "new");
}

TEST_F(AtomicFileTest, DevicesAreWrittenDirectly) {
  EXPECT_FALSE(WriteFileAtomically("/dev/null", "text"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  if (std::filesystem::is_character_file("/dev/full")) {
    EXPECT_TRUE(Contains(ProblemOf(WriteFileAtomically("/dev/full", "text")),
                         "/dev/full: cannot write it: No space left"));
  }
}

// A limit on the size of files stands in for a full disk.
TEST_F(AtomicFileTest, FullDiskLeavesNothingBehind) {
  WriteText("a", "old");
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto previous = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit tight{10000, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &tight), 0);
  const MaybeError failed = WriteFileAtomically(Path("a"), std::string(1 << 20, 'x'));
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, previous);
  ASSERT_TRUE(failed);
  EXPECT_TRUE(Contains(failed->ToString(), Path("a") + ": cannot write it: "));
  EXPECT_EQ(ReadText(Path("a")), "old");
  EXPECT_EQ(CountFiles(), 1);
}

TEST_F(InputFileTest, HashesAreThoseOfXxhsum) {
  // xxhsum -H2 of the empty file and of "pushid\n".
  EXPECT_EQ(HashFile(WriteText("empty", "")).value(), "99aa06d3014798d86001c324468d497f");
  EXPECT_EQ(HashFile(WriteText("a", "pushid\n")).value(),
            HashFile(WriteText("b", "pushid\n")).value());
  EXPECT_NE(HashFile(Path("a")).value(), HashFile(WriteText("b", "pushid")).value());
  EXPECT_FALSE(HashFile(Path("missing")).ok());
  // In pieces or as a whole, as long as it takes several reads.
  std::string text;
  for (int i = 0; i < 200000; ++i) text += std::to_string(i) + (i % 3 == 0 ? "\n" : " ");
  const std::string path = WriteText("long", text);
  ContentHash hash;
  hash.Add(std::string_view(text).substr(0, 12345));
  hash.Add(std::string_view(text).substr(12345));
  EXPECT_EQ(HashFile(path).value(), hash.Hex());
  LineReader reader(path);
  std::string_view line;
  std::string joined;
  while (reader.Next(&line)) joined.append(line).append("\n");
  joined.pop_back();  // the text has no newline at its end
  EXPECT_EQ(joined, text);
  EXPECT_EQ(reader.HashHex(), hash.Hex());
}

// Lines are blank that the other readers take for blank (IsBlank), and no others.
TEST_F(InputFileTest, BlankLinesArePassedOver) {
  LineReader reader(WriteText("a.txt", "\v\n \t\f\r\n\na\n\v"));
  std::string_view line;
  ASSERT_TRUE(reader.NextNonBlank(&line));
  EXPECT_EQ(line, "a");
  EXPECT_EQ(reader.line_number(), 4);
  EXPECT_FALSE(reader.NextNonBlank(&line));
}

// Windows programs write it, in front of UTF-8 too.
constexpr char kByteOrderMark[] = "\xEF\xBB\xBF";

TEST_F(InputFileTest, AByteOrderMarkIsSkippedOnce) {
  LineReader reader(WriteText("a.csv", std::string(kByteOrderMark) + "a\n" + kByteOrderMark));
  std::string_view line;
  ASSERT_TRUE(reader.Next(&line));
  EXPECT_EQ(line, "a");
  ASSERT_TRUE(reader.Next(&line));
  EXPECT_EQ(line, kByteOrderMark);
}

// The error of reading the first line.
MaybeError FirstLine(const std::string& path) {
  return Caught([&] {
    std::string_view line;
    LineReader(path).Next(&line);
  });
}

TEST_F(InputFileTest, WhatIsNoTextIsNamed) {
  using namespace std::string_literals;
  const std::pair<std::string, const char*> cases[] = {
      {"PK\3\4\x14\0\6\0"s, "a ZIP archive, as spreadsheets (.xlsx, .ods) are"},
      {"PK\3\4\n\0\0\0"s, "a ZIP archive"},  // a newline among its first bytes
      {"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1\0\0"s, "a binary file"},  // .xls
      {"\x1F\x8B\x08\0\0"s, "a binary file"},                      // gzip
      {"\2P\0\0"s, "a binary file"},                               // C3D
      {"\x89PNG\r\n\x1A\n\0"s, ""},                                // its first line is text
      {"time,force\0\n"s, "a binary file"},
      {"time,force\n0,\0\n"s, ""},
      {"PK,MK\n"s, ""},
      {"\xC3\xA9t\xC3\xA9,x\n"s, ""},
  };
  for (const auto& [bytes, says] : cases) {
    const MaybeError error = FirstLine(WriteText("a.csv", bytes));
    EXPECT_EQ(!error, *says == '\0') << bytes;
    if (*says == '\0') continue;
    EXPECT_TRUE(Contains(error->ToString(), std::string("this is no text, but ") + says));
  }
}

// A manifest that was written on another system.
TEST_F(InputFileTest, NamesThatOtherSystemsTake) {
  std::filesystem::create_directories(folder_ / "Bvh/Day 1");
  const std::string there = WriteText("Bvh/Day 1/S01_weak.bvh", "x");
  const auto message = [this](const std::string& name) { return ProblemOf(HashFile(Path(name))); };
  for (const char* name :
       {"Bvh/Day 1/s01_weak.bvh", "bvh/day 1/S01_WEAK.BVH", "BVH/Day 1/S01_weak.bvh",
        "Bvh/Day 1/S01_weak.Bvh", "bvh/DAY 1/s01_weak.bvh"}) {
    EXPECT_TRUE(Contains(message(name), "no such file; did you mean " + there + "?")) << name;
    EXPECT_FALSE(Contains(message(name), "separated")) << name;
  }
  for (const char* name : {"Bvh\\Day 1\\S01_weak.bvh", "bvh\\day 1/s01_weak.bvh"}) {
    EXPECT_TRUE(Contains(message(name), "did you mean " + there + "?; folders are separated by /"));
  }
  EXPECT_TRUE(Contains(message("gone\\a.bvh"), "no such file; folders are separated by /"));
  EXPECT_TRUE(Contains(message("Bvh\tS01.bvh"), "a control character, which \\b, \\t"));
  const std::string other = message("Bvh/Day 1/S01_strong.bvh");
  EXPECT_EQ(other.substr(other.rfind(':')), ": there is no such file");
}

// `text` of ASCII in units of `bytes`, with a byte order mark or without.
std::string Encoded(const std::string& text, int bytes, bool big_endian, bool mark) {
  std::string encoded;
  const auto add = [&](unsigned unit) {
    for (int i = 0; i < bytes; ++i) {
      encoded += static_cast<char>(unit >> 8 * (big_endian ? bytes - 1 - i : i) & 0xFF);
    }
  };
  if (mark) add(0xFEFF);
  for (const char c : text) add(static_cast<unsigned char>(c));
  return encoded;
}

TEST_F(InputFileTest, OtherEncodingsAreNamed) {
  const struct {
    int bytes;
    bool big_endian;
    const char* name;
  } cases[] = {
      {2, false, "UTF-16LE"}, {2, true, "UTF-16BE"}, {4, false, "UTF-32LE"}, {4, true, "UTF-32BE"}};
  for (const auto& c : cases) {
    for (const bool mark : {true, false}) {
      const std::string said = std::string("a.json:1: this text is encoded as ") + c.name +
                               ", not as UTF-8; save it as UTF-8, or convert it: iconv -f " +
                               c.name;
      const auto path = [&](const char* text) {
        return WriteText("a.json", Encoded(text, c.bytes, c.big_endian, mark));
      };
      const MaybeError error = FirstLine(path("time,force\n0,1\n"));
      ASSERT_TRUE(error) << c.name << mark;
      EXPECT_TRUE(Contains(error->ToString(), said)) << error->ToString();
      EXPECT_TRUE(Contains(ProblemOf(ReadJsonDocument(path("{\"a\": 1}"))), said))
          << c.name << mark;
    }
  }
}

TEST_F(InputFileTest, EndlessLineIsRefused) {
  const MaybeError error = FirstLine("/dev/zero");
  ASSERT_TRUE(error);
  EXPECT_TRUE(Contains(error->ToString(), "longer than 64 MB"));
}

TEST_F(JsonFileTest, DoublesReadBackTheSame) {
  nlohmann::json content;
  for (double value : {1.0 / 3.0, 1e-300, 123456789.123456789, -2.5e300, 0.1 + 0.2}) {
    content["values"].push_back(value);
  }
  content["text"] = "\xC3\xA4\xFF";  // ä and a byte that is no UTF-8
  ASSERT_FALSE(WriteJson(Path("a.json"), content));
  const std::string text = ReadText(Path("a.json"));
  EXPECT_EQ(text.back(), '\n');
  const nlohmann::json read = Unwrapped(ReadJsonDocument(Path("a.json"))).content;
  EXPECT_EQ(read["values"], content["values"]);
}

TEST_F(JsonFileTest, SyntaxErrorsHaveLineAndColumn) {
  const struct {
    const char* text;
    const char* place;
  } cases[] = {
      {"{\n  \"a\": 1,\n  \"b\" 2\n}\n", ":3:7: this is not valid JSON: "},
      {"{\"a\": 1,}", ":1:9: "},
      {"{\"a\": NaN}", ":1:7: "},
      {"{\"a\": 1}\n{", ":2:1: "},
      {"[1,\n2", ":2:2: "},
      {"[1,\n 1e999]", ":2:6: "},
      {"{\"a\":\n\"\xFF\"}", ":2:2: "},
      {" \n\t", ": the file is empty"},
  };
  for (const auto& c : cases) {
    const std::string path = WriteText("a.json", c.text);
    EXPECT_TRUE(Contains(ProblemOf(ReadJsonDocument(path)), path + c.place)) << c.text;
  }
  EXPECT_TRUE(Contains(ProblemOf(ReadJsonDocument(WriteText("a.json", std::string(1 << 20, '[')))),
                       "a.json:1:201: the JSON nests deeper than 200"));
}

TEST_F(JsonFileTest, ValuesAreFoundInTheText) {
  const std::string path = WriteText(
      "a.json", "{ \"x\": [1, {\"a\\\"]\": \"}\\\"\"},\n  {\"b\" : [[], {}],\n \"c\": -1e3 } ] }");
  const JsonDocument document = Unwrapped(ReadJsonDocument(path));
  const auto place = [&](const char* pointer) {
    return document.ErrorAt(pointer, "m").ToString().substr(path.size());
  };
  EXPECT_EQ(place(""), ":1:1: m");
  EXPECT_EQ(place("/x/0"), ":1:9: m");
  EXPECT_EQ(place("/x/1/a\"]"), ":1:21: m");
  EXPECT_EQ(place("/x/2/c"), ":3:7: m");
  EXPECT_EQ(place("/x/2/missing"), ":2:3: m");
  EXPECT_EQ(place("/x/7"), ":1:8: m");
  EXPECT_EQ(document.ElementLines("/x"), (std::vector<int>{1, 1, 2}));
}

TEST_F(JsonFileTest, ValuesAreFoundBehindAByteOrderMark) {
  const std::string path =
      WriteText("a.json", std::string(kByteOrderMark) + "{\"x\": [1,\n {}], \"y\": 2}");
  const JsonDocument document = Unwrapped(ReadJsonDocument(path));
  EXPECT_EQ(document.ElementLines("/x"), (std::vector<int>{1, 2}));
  EXPECT_EQ(document.ErrorAt("/y", "m").ToString(), path + ":2:12: m");
  EXPECT_EQ(document.ErrorAt("/x/0", "m").ToString(), path + ":1:8: m");
  EXPECT_TRUE(
      Contains(ProblemOf(ReadJsonDocument(WriteText("b.json", kByteOrderMark))), "is empty"));
}

TEST(Axes, TurnToForwardLeftUp) {
  const auto rotation = [](const char* up, const char* forward) {
    return AxesRotation(up, forward).value();
  };
  EXPECT_TRUE(rotation("z", "x").isIdentity(0.0));
  // y up, facing z (as many BVH files have it): x points left.
  EXPECT_EQ(rotation("+y", "Z") * Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(3, 1, 2));
  for (const char* up : {"x", "-y", "+z"}) {
    for (const char* forward : {"x", "-y", "Z", "-x"}) {
      const auto result = AxesRotation(up, forward);
      if (!result.ok()) continue;
      EXPECT_EQ(result.value().determinant(), 1.0);
    }
  }
  EXPECT_TRUE(Contains(AxesRotation("up", "x").error().message, "up is 'up', not an axis"));
  EXPECT_TRUE(Contains(AxesRotation("z", "").error().message, "forward is ''"));
  EXPECT_TRUE(Contains(AxesRotation("x", "-x").error().message, "same axis"));
}

}  // namespace
}  // namespace pushid
