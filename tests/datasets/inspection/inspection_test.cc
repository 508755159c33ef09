// The text of pushid-inspect: each warning once provoked, none on a good file.
#include "datasets/inspection/inspection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>

#include "datasets/formats/point_motion.h"
#include "tests/datasets/c3d_samples.h"
#include "tests/datasets/c3d_writer.h"
#include "tests/datasets/recording_folder.h"
#include "tests/simulators/table_files.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr std::size_t kNone = std::string::npos;
const Eigen::Vector3d kHidden = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());

class InspectionTest : public RecordingFolderTest {
 protected:
  // A person who stands for 40 frames and is then pushed along x; mm.
  void SetUp() override {
    RecordingFolderTest::SetUp();
    motion_.rate_hz = 100.0;
    motion_.unit = LengthUnit::kMillimetre;
    motion_.names = {"Hips", "LANK", "RANK"};
    motion_.positions.resize(3);
    for (int t = 0; t < 100; ++t) {
      motion_.positions[0].push_back({t < 40 ? 0.0 : 8.0 * (t - 40), 0.0, 950.0});
      motion_.positions[1].push_back({0.0, 100.0, 80.0});
      motion_.positions[2].push_back({0.0, -100.0, 80.0});
    }
  }

  // Facts and warnings of the motion as TRC.
  std::string Said() {
    EXPECT_FALSE(WriteTrc(Path("a.trc"), motion_));
    return Of("a.trc");
  }
  std::string Of(const std::string& file) {
    const Result<Inspection> found = Inspect(Path(file));
    return found.ok() ? InspectionText(found.value()) : found.error().ToString();
  }

  PointMotion motion_;
};

TEST_F(InspectionTest, AGoodFileHasNoWarnings) {
  const std::string said = Said();
  for (const char* part :
       {"a.trc: TRC", "points          Hips, LANK, RANK", "100 at 100 per second, 1 s",
        "unit            mm, as given in the file", "hip 0.87 m above the ankles",
        "z is up, the person faces x (by the ankles)", "static (hip 0 m/s)",
        "the hip has moved 2 cm at frame 43 (0.43 s); at most it moves 0.472 m, mostly along x"}) {
    EXPECT_TRUE(Contains(said, part));
  }
  EXPECT_FALSE(Contains(said, "warning")) << said;
}

TEST_F(InspectionTest, Axes) {
  for (auto& track : motion_.positions) {
    for (Eigen::Vector3d& p : track) p = Eigen::Vector3d(p.y(), p.z(), p.x());
  }
  const std::string said = Said();
  EXPECT_TRUE(Contains(said, "y is up, the person faces z"));
  EXPECT_TRUE(Contains(said, "warning: y is up in the file: set \"up\": \"y\", \"forward\": "));
}

// In mid-stride the line between the ankles says little; the pelvis does.
TEST_F(InspectionTest, FacingInMidStride) {
  for (int t = 0; t < 100; ++t) {
    const double ahead = 300.0 * std::cos(2.0 * M_PI * t / 100.0);
    motion_.positions[0][t].x() = 10.0 * t;
    motion_.positions[1][t].x() = 10.0 * t + ahead;
    motion_.positions[2][t].x() = 10.0 * t - ahead;
  }
  const std::string said = Said();
  EXPECT_TRUE(Contains(said, "the person faces x (by the ankles, unsure)"));
  EXPECT_TRUE(Contains(said, "warning: the facing direction is uncertain: one foot is ahead"));
  for (const auto& [name, x, y] : {std::tuple("LASI", 100.0, 120.0), {"RASI", 100.0, -120.0}}) {
    motion_.names.push_back(name);
    motion_.positions.emplace_back();
    for (int t = 0; t < 100; ++t) motion_.positions.back().push_back({10.0 * t + x, y, 1000.0});
  }
  const std::string by_pelvis = Said();
  EXPECT_TRUE(Contains(by_pelvis, "the person faces x (by the pelvis)"));
  EXPECT_FALSE(Contains(by_pelvis, "unsure"));
}

TEST_F(InspectionTest, WalkingToTheSideIsDoubted) {
  for (int t = 0; t < 100; ++t) {
    for (auto& track : motion_.positions) track[t].y() += 10.0 * t;
  }
  EXPECT_TRUE(Contains(Said(), "uncertain: the hip goes 65 degrees off it"));
}

// The left foot goes 0.3 m to the side that the person faces, whatever that axis is called.
TEST_F(InspectionTest, Steps) {
  EXPECT_TRUE(Contains(Said(), "steps           none"));
  for (int t = 50; t < 100; ++t) {
    const double way = std::min(1.0, (t - 50) / 30.0);
    motion_.positions[1][t].x() = 300.0 * way;
  }
  EXPECT_TRUE(Contains(Said(), "steps           left 0.51-0.8 s 0.3 m forwards"));
  for (auto& track : motion_.positions) {
    for (Eigen::Vector3d& p : track) p = Eigen::Vector3d(p.y(), p.z(), p.x());
  }
  EXPECT_TRUE(Contains(Said(), "steps           left 0.51-0.8 s 0.3 m forwards"));
}

TEST_F(InspectionTest, Units) {
  for (auto& track : motion_.positions) {
    for (Eigen::Vector3d& p : track) p *= 0.1;
  }
  EXPECT_TRUE(Contains(Said(), "the file gives mm, but the person looks like cm: set length_unit"));
  for (auto& track : motion_.positions) {
    for (Eigen::Vector3d& p : track) p *= 1e-4;
  }
  EXPECT_TRUE(Contains(Said(), "no unit gives a standing person"));
}

TEST_F(InspectionTest, GapsAndJumps) {
  for (int t = 50; t < 65; ++t) motion_.positions[1][t] = kHidden;
  motion_.positions[2][0] = kHidden;
  motion_.positions[0][70].y() += 300.0;
  const std::string said = Said();
  EXPECT_TRUE(Contains(said, "gaps in 2 of 3 points; frames not seen: LANK 15, RANK 1"));
  EXPECT_TRUE(Contains(said, "LANK is hidden for up to 15 frames (0.15 s)"));
  EXPECT_TRUE(Contains(said, "first seen together at frame 1: set first_frame to 1"));
  EXPECT_TRUE(Contains(said, "jumps in 1 points: Hips 0.3 m at frame 7"));
}

TEST_F(InspectionTest, StartAndOnset) {
  for (int t = 0; t < 100; ++t) motion_.positions[0][t].x() = 2.0 * t;
  EXPECT_TRUE(Contains(Said(), "the person moves at the start: skip the motion by first_frame"));
  for (int t = 0; t < 100; ++t) motion_.positions[0][t].x() = 0.1 * t;
  EXPECT_TRUE(Contains(Said(), "the hip moves 9.9 mm at most, and an onset is seen from 20 mm on"));
  // From rest, pushed from the first frame on: cutting the start would cut the push.
  for (int t = 0; t < 100; ++t) motion_.positions[0][t].x() = 0.2 * t * t;
  const std::string pushed = Said();
  EXPECT_TRUE(Contains(pushed, "start           at rest, and pushed within the first 0.1 s"));
  EXPECT_FALSE(Contains(pushed, "moves at the start")) << pushed;
}

// People at rest who are pushed at 0 to 0.9 s do not move at the start; who walks in or sways does.
TEST_F(InspectionTest, RestBeforeThePush) {
  const auto moves = [this](const std::function<double(double s)>& way) {
    for (int t = 0; t < 100; ++t) motion_.positions[0][t].x() = 1000.0 * way(t / 100.0);
    return static_cast<bool>(Contains(Said(), "moves at the start"));
  };
  for (double rest : {0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.5, 0.9}) {
    const bool walks = moves([rest](double s) { return 0.3 * std::max(0.0, s - rest); });
    EXPECT_EQ(walks, rest == 0.0) << rest;
    EXPECT_FALSE(moves([rest](double s) { return std::pow(std::max(0.0, s - rest), 2); })) << rest;
  }
  for (double speed : {0.06, 0.1, 0.3, 1.0}) {
    EXPECT_TRUE(moves([speed](double s) { return speed * s; })) << speed;
  }
}

TEST_F(InspectionTest, TwoPointsOfOneNameHaveTheirIndices) {
  motion_.names = {"Hips", "LANK", "LANK"};
  EXPECT_TRUE(Contains(Said(), "could be 'LANK' or 'LANK'; give its index, 1 or 2, by"));
}

TEST_F(InspectionTest, PlatformsOfATableAreNoPoints) {
  WriteText("f.mot",
            "f\nendheader\ntime\tleft_vx\tleft_vy\tleft_vz\tleft_px\tleft_py\tleft_pz\n"
            "0\t1\t700\t2\t0.1\t0\t0.1\n0.01\t1\t700\t2\t0.1\t0\t0.1\n");
  const std::string said = Of("f.mot");
  EXPECT_TRUE(Contains(said, "which \"force_plates\" of a manifest reads"));
  EXPECT_FALSE(Contains(said, "recognised as hip")) << said;
}

TEST_F(InspectionTest, GapsOfACrowd) {
  WriteText("c.txt", "# framerate: 10\n1 0 0 0\n1 1 0 0\n1 4 0 0\n1 5 0 0\n2 2 1 0\n2 3 1 0\n");
  EXPECT_TRUE(Contains(Of("c.txt"), "frames not seen between a person's first and last: 1 2\n"));
}

TEST_F(InspectionTest, SensorsAndPushesByTheirNames) {
  WriteText("f.csv", "\"Time (ms)\";\"Force (N)\"\n0;0\n10;50\n20;0\n");
  EXPECT_TRUE(Contains(Of("f.csv"), "peak 50 N, impulse 0.5 N s, above 20 N from 0.01 s"));
  WriteText("p.csv", "Frame;FX (N);FY (N)\n0;3;4\n");
  EXPECT_TRUE(Contains(Of("p.csv"), "push CSV"));
}

TEST_F(InspectionTest, ForcesDoNotHideTheMotion) {
  std::string table =
      "time,hip_x,hip_y,hip_z,left_ankle_x,left_ankle_y,left_ankle_z,right_ankle_x,"
      "right_ankle_y,right_ankle_z,ground_force_vx,ground_force_vy,"
      "ground_force_vz,ground_force_px,ground_force_py,ground_force_pz\n";
  for (int t = 0; t < 100; ++t) {
    table += std::to_string(t / 100.0) + "," + std::to_string(t < 40 ? 0 : 8 * (t - 40)) +
             ",0,950,0,100,80,0,-100,80,90,0,700,33,0,0\n";
  }
  WriteText("both.csv", table);
  const std::string said = Of("both.csv");
  EXPECT_TRUE(Contains(said, "points          hip, left_ankle, right_ankle\n"));
  EXPECT_TRUE(Contains(said, "the hip has moved 2 cm"));
  EXPECT_TRUE(Contains(said, "ground_force_vz peak 700 N"));
  EXPECT_FALSE(Contains(said, "ground_force_px peak")) << said;
}

// A table of columns that cannot be guessed, with the file that explains them to a fit.
TEST_F(InspectionTest, ThroughAMapping) {
  std::string text = "clock,wx,wy,wz,lx,ly,lz,rx,ry,rz\n";
  for (int t = 0; t < 60; ++t) {
    text += std::to_string(0.01 * t);
    for (const auto& track : motion_.positions) {
      for (int axis = 0; axis < 3; ++axis) text += "," + std::to_string(track[t][axis]);
    }
    text += "\n";
  }
  WriteText("a.csv", text);
  EXPECT_TRUE(Contains(Of("a.csv"), "no point could be recognised as hip"));
  const ColumnMapping mapping = Unwrapped(ReadColumnMapping(WriteText(
      "map.json",
      "{\"columns\": {\"waist\": [\"wx\", \"wy\", \"wz\"], \"l\": [\"lx\", \"ly\", \"lz\"], "
      "\"r\": [\"rx\", \"ry\", \"rz\"]}, \"time\": \"clock\", "
      "\"joints\": {\"hip\": \"waist\", \"left_ankle\": \"l\", \"right_ankle\": \"r\"}}")));
  const Inspection found = Unwrapped(Inspect(Path("a.csv"), mapping));
  const std::string said = InspectionText(found);
  EXPECT_TRUE(Contains(said, "hip             waist"));
  EXPECT_TRUE(Contains(said, "60 at 100 per second"));
  EXPECT_TRUE(Contains(said, "hip 0.87 m above the ankles"));
}

// A robot's base of support has no left and no right, and its unit is the mapping's.
TEST_F(InspectionTest, ABaseOfSupport) {
  std::string text = "t,cx,cy,cz,bx,by,bz\n";
  for (int t = 0; t < 100; ++t) text += std::to_string(0.01 * t) + ",0.31,0,0.8,0.3,0,0\n";
  WriteText("log.csv", text);
  const ColumnMapping mapping = Unwrapped(ReadColumnMapping(WriteText(
      "map.json",
      "{\"columns\": {\"com\": [\"cx\", \"cy\", \"cz\"], \"base\": [\"bx\", \"by\", \"bz\"]}, "
      "\"time\": \"t\", \"length_unit\": \"m\", \"joints\": {\"hip\": \"com\", \"base\": "
      "\"base\"}}")));
  const std::string said = InspectionText(Unwrapped(Inspect(Path("log.csv"), mapping)));
  EXPECT_TRUE(Contains(said, "unit            m, as given in the file or its mapping")) << said;
  EXPECT_FALSE(Contains(said, "mm is assumed")) << said;
  EXPECT_FALSE(Contains(said, "facing")) << said;
}

TEST_F(InspectionTest, RateAndNames) {
  motion_.rate_hz = 25.0;
  motion_.names[1] = "foo";
  const std::string said = Said();
  EXPECT_TRUE(Contains(said, "a push lasts only a few frames at 25 frames per second"));
  EXPECT_TRUE(Contains(said, "no point could be recognised as left_ankle"));
}

TEST_F(InspectionTest, C3d) {
  ASSERT_FALSE(WriteC3d(Path("a.c3d"), SampleC3d()));
  const std::string said = Of("a.c3d");
  for (const char* part : {"a.c3d: C3D, Intel, floats", "Anna:HIP", "rod", "at 1000 per second",
                           "platform:1 type", "peak 700 N"}) {
    EXPECT_TRUE(Contains(said, part));
  }
  C3dFile odd = SampleC3d();
  odd.platforms.resize(3, odd.platforms[0]);
  odd.platforms[0].type = 6;
  odd.platforms[1].corners.rowwise().reverseInPlace();
  odd.platforms[2].origin.z() = 40.0;
  ASSERT_FALSE(WriteC3d(Path("odd.c3d"), odd));
  for (const char* part : {"warning: platform:1 has the TYPE 6", "warning: platform:2 faces down",
                           "warning: platform:3 has its sensors above its surface"}) {
    EXPECT_TRUE(Contains(Of("odd.c3d"), part));
  }
  const std::string text = ReadText(Path("a.c3d"));
  WriteText("cut.c3d", text.substr(0, text.size() - 1024));
  EXPECT_TRUE(Contains(Of("cut.c3d"), "of 10 frames: it is truncated"));
  C3dFile cell = SampleC3d();
  cell.platforms.clear();
  cell.analog[6].unit = "kN";
  ASSERT_FALSE(WriteC3d(Path("cell.c3d"), cell));
  EXPECT_TRUE(Contains(Of("cell.c3d"), "peak -40000 N"));
}

TEST_F(InspectionTest, OtherFiles) {
  const std::string bvh = Of("a.bvh");  // of the folder: in mm, moving from the first frame
  EXPECT_TRUE(Contains(bvh, "20 at 59.9988 per second, 0.333 s; taken as 60 (\"fps\""));
  EXPECT_TRUE(Contains(bvh, "unit            mm, inferred from the rod length"));
  EXPECT_TRUE(Contains(bvh, "the person moves at the start"));
  EXPECT_TRUE(Contains(Of("a.csv"), "a.csv: push CSV\n  rows            5"));
  WriteText("f.csv", "time,force\n0,0\n0.01,50\n0.02,0\n");
  EXPECT_TRUE(Contains(Of("f.csv"), "peak 50 N, impulse 0.5 N s, above 20 N from 0.01 s"));
  WriteText("g.mot",
            "g\nnRows=2\nendheader\ntime ground_force_vx ground_force_vy\n0 1 2\n0.01 3 700\n");
  EXPECT_TRUE(Contains(Of("g.mot"), "ground_force_vy peak 700 N"));
  ASSERT_FALSE(WriteManifest(Path("manifest.json"), manifest_));
  EXPECT_TRUE(Contains(Of("manifest.json"), "1, 1 can be read, 1 have a push"));
  WriteText("marked.json", "\xEF\xBB\xBF" + ReadText(Path("manifest.json")));
  EXPECT_TRUE(Contains(Of("marked.json"), "1, 1 can be read, 1 have a push"));
  WriteText("utf16.json", std::string("{\0}\0", 4));
  EXPECT_TRUE(Contains(Of("utf16.json"), "encoded as UTF-16LE, not as UTF-8"));
  manifest_.recordings[0].id = "b";
  ASSERT_FALSE(WriteManifest(Path("other.json"), manifest_));
  const Inspection both = Unwrapped(Inspect(Path("manifest.json") + "," + Path("other.json")));
  EXPECT_TRUE(Contains(InspectionText(both), "other.json: manifests\n"));
  EXPECT_TRUE(Contains(InspectionText(both), "2, 2 can be read, 2 have a push"));
  EXPECT_TRUE(Contains(Of("none.bvh"), "there is no such file"));
  EXPECT_TRUE(Contains(Of(""), "this is a folder"));
  manifest_.recordings[0].subjects[0].mass_kg = 62.7;
  manifest_.recordings.push_back(manifest_.recordings[0]);
  manifest_.recordings[1].id = "a";
  for (const auto& [mass, told] : {std::pair(65.0, false), {70.0, true}}) {
    manifest_.recordings[1].subjects[0].mass_kg = mass;
    ASSERT_FALSE(WriteManifest(Path("two.json"), manifest_));
    EXPECT_EQ(Of("two.json").find("s1 weighs 62.7 to 70 kg: one id is one person") != kNone, told);
  }
  WriteText("x.dat", "hello");
  EXPECT_TRUE(Contains(Of("x.dat"), "unknown kind of file"));
}

// Commands that are printed can be pasted.
TEST_F(InspectionTest, NamesInCommandsAreQuoted) {
  const std::pair<const char*, const char*> cases[] = {
      {"a/b-c_1.txt", "a/b-c_1.txt"}, {"a b", "'a b'"},
      {"it's", "'it'\\''s'"},         {"", "''"},
      {"$HOME", "'$HOME'"},           {"a;b", "'a;b'"},
      {"\"q\"", "'\"q\"'"},           {"a&b", "'a&b'"},
      {"*.c3d", "'*.c3d'"},           {"~x", "'~x'"},
      {"M\xC3\xBC", "'M\xC3\xBC'"},
  };
  for (const auto& [value, quoted] : cases) EXPECT_EQ(ShellQuoted(value), quoted);
  WriteText("the crowd.txt", "# framerate: 8\n1 0 0 0\n2 0 1 0\n");
  EXPECT_TRUE(Contains(Of("the crowd.txt"), "--formation='" + Path("the crowd.txt") + "' --form"));
}

}  // namespace
}  // namespace pushid
