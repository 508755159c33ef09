// Trajectories of crowds, and where people stand in one frame.
#include "datasets/formats/trajectories.h"

#include <gtest/gtest.h>

#include <cmath>

#include "datasets/formats/motion_formats.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

class TrajectoriesTest : public TempDirTest {
 protected:
  std::string TextMessage(const std::string& text) {
    return ProblemOf(ReadTrajectoryText(WriteText("crowd.txt", text)));
  }
};

// A file of PeTrack's: centimetres, people who come and go.
TEST_F(TrajectoriesTest, Text) {
  const std::string path = WriteText("crowd.txt",
                                     "# description: corridor\n# framerate: 16.00 fps\n"
                                     "# id frame x/cm y/cm z/cm\n"
                                     "7 100 10 20 170\n7 101 11 20 170 99\n12 101 0 -5 1.6e2\n");
  const PointMotion motion = Unwrapped(ReadTrajectoryText(path));
  EXPECT_EQ(motion.names, (std::vector<std::string>{"7", "12"}));
  EXPECT_EQ(motion.unit, LengthUnit::kCentimetre);
  EXPECT_EQ(motion.rate_hz, 16.0);
  EXPECT_EQ(motion.first_time_s, 6.25);
  EXPECT_EQ(motion.positions[0][1], Eigen::Vector3d(11, 20, 170));
  EXPECT_FALSE(motion.positions[1][0].allFinite());
  EXPECT_EQ(motion.positions[1][1], Eigen::Vector3d(0, -5, 160));
  PointReadOptions options;
  options.choose = [](const PointMotion&) { return std::vector<int>{1}; };
  const Result<PointMotion> one = ReadTrajectoryText(path, options);
  ASSERT_EQ(one.value().positions.size(), 1u);
  EXPECT_EQ(one.value().positions[0].size(), 2u);
}

// Files of spreadsheets and scripts, whatever the order of the columns.
TEST_F(TrajectoriesTest, AsCsv) {
  const std::string path = WriteText("heads.csv",
                                     "time,id,frame,x/cm,y/cm\n4.00,7,100,10,20\n4.04,7,101,11,20\n"
                                     "4.04,12,101,0,-5\n");
  EXPECT_TRUE(IsCrowdCsv(path));
  EXPECT_EQ(MotionFormatInFile(path), MotionFormat::kTrajectoryText);
  const PointMotion motion = Unwrapped(ReadTrajectoryText(path));
  EXPECT_EQ(motion.names, (std::vector<std::string>{"7", "12"}));
  EXPECT_EQ(motion.rate_hz, 25.0);
  EXPECT_EQ(motion.unit, LengthUnit::kCentimetre);
  EXPECT_EQ(motion.positions[0][1], Eigen::Vector3d(11, 20, 0));
  const std::string commented = "# framerate: 16\nid,frame,x,y\n1,0,0,0\n1,1,0.5,0\n";
  EXPECT_EQ(Unwrapped(ReadTrajectoryText(WriteText("a.csv", commented))).rate_hz, 16.0);
  EXPECT_TRUE(Contains(TextMessage("id,frame,x,y\n1,0,0,0\n"), "or a column time (s)"));
  EXPECT_FALSE(IsCrowdCsv(WriteText("b.csv", "time,hip_x,hip_y,hip_z\n0,0,0,0\n")));
}

// Blank lines of vertical tabs and form feeds are skipped too; such a line once ended the program.
TEST_F(TrajectoriesTest, HeadsAsPeopleWriteThem) {
  for (const char* text :
       {"ID,Frame,X,Y\n1,0,1,2\n", "Id;Frame;X;Y\n1;0;1;2\n", "id\tframe\tX\tY\n1\t0\t1\t2\n",
        "\"id\",\"frame\",\"x\",\"y\"\n1,0,1,2\n", "frame,id,y,x\n0,1,2,1\n",
        "id,frame,x/m,y/m\n1,0,1,2\n", "id,frame,x(cm),y(cm)\n1,0,100,200\n",
        "id, frame, x [m], y [m]\n1, 0, 1, 2\n", "id;frame;x/cm;y/cm\n1;0;100;200\n",
        "ID FRAME X Y\n1 0 1 2\n"}) {
    const std::string path = WriteText("a.csv", "# framerate: 10\n" + std::string(text));
    const PointMotion read = Unwrapped(ReadTrajectoryText(path));
    EXPECT_EQ(read.names, std::vector<std::string>{"1"}) << text;
    EXPECT_NEAR(read.positions[0][0].y() * MetresPer(*read.unit), 2.0, 1e-12) << text;
    EXPECT_TRUE(IsCrowdCsv(path)) << text;
  }
}

TEST_F(TrajectoriesTest, BlankLines) {
  const PointMotion read = Unwrapped(ReadTrajectoryText(
      WriteText("crowd.txt", "# framerate: 8\n\v\v\n1 0 1 2\n\f\n \t\r\n1 1 1 3\n\v")));
  EXPECT_EQ(read.num_frames(), 2);
}

TEST_F(TrajectoriesTest, UnitsAsPeopleWriteThem) {
  for (const char* unit : {"x/cm", "x[cm]", "x(cm)", "in cm"}) {
    const std::string text = std::string("# framerate: 8\n# id frame ") + unit + "\n1 0 50 0\n";
    EXPECT_EQ(ReadTrajectoryText(WriteText("a.txt", text)).value().unit, LengthUnit::kCentimetre)
        << unit;
  }
}

// A unit is a word, and not the beginning of one; of two units nobody knows which is meant.
TEST_F(TrajectoriesTest, UnitsAreWholeWords) {
  const auto unit = [this](const std::string& comments) {
    return ReadTrajectoryText(WriteText("a.txt", "# framerate: 8\n" + comments + "1 0 50 0\n"))
        .value()
        .unit;
  };
  for (const char* words :
       {"filmed in munich", "in march", "in m\xC3\xBCnchen", "made in mm2 lab", "within cm_tools",
        "speeds in m/s", "max/mm2", "in mechelen, in cmu's hall", "in 2 rows", "in"}) {
    EXPECT_EQ(unit(std::string("# ") + words + "\n"), LengthUnit::kMetre) << words;
    EXPECT_EQ(unit(std::string("# id frame x/cm y/cm\n# ") + words + "\n"), LengthUnit::kCentimetre)
        << words;
  }
  EXPECT_EQ(unit("# in munich, in mm\n"), LengthUnit::kMillimetre);
  EXPECT_EQ(unit("# in mm.\n# id frame x/mm y/mm\n"), LengthUnit::kMillimetre);
  EXPECT_TRUE(Contains(TextMessage("# framerate: 8\n# id frame x/cm\n# lengths in m\n1 0 0 0\n"),
                       ":3: lengths are in m, but in cm by a line before"));
}

// Somebody may stand at the origin, and planes have no height.
TEST_F(TrajectoriesTest, Planes) {
  const PointMotion read =
      Unwrapped(ReadTrajectoryText(WriteText("plane.txt", "#framerate: 8\n1 0 0 0\n1 1 2 3\n")));
  EXPECT_EQ(read.unit, LengthUnit::kMetre);
  EXPECT_EQ(read.positions[0][0], Eigen::Vector3d::Zero());
  EXPECT_EQ(read.positions[0][1], Eigen::Vector3d(2, 3, 0));
}

TEST_F(TrajectoriesTest, BadText) {
  const std::string head = "# framerate: 10\n";
  EXPECT_TRUE(Contains(TextMessage("1 0 0 0 0\n"), "a line such as '# framerate: 16'"));
  EXPECT_TRUE(Contains(TextMessage("# framerate: fast\n1 0 0 0 0\n"), "as a number"));
  EXPECT_TRUE(Contains(TextMessage(head), "contains no positions"));
  EXPECT_TRUE(Contains(TextMessage(head + "1 0 0 0\n1 0 1 1\n"), ":3: person 1 was in frame 0"));
  EXPECT_TRUE(Contains(TextMessage(head + "1 0.5 0 0\n"), ":2: the frame must be a whole number"));
  EXPECT_TRUE(Contains(TextMessage(head + "a 0 0 0\n"), ":2: the id must be a whole number"));
  EXPECT_TRUE(Contains(TextMessage(head + "1 0 0\n"), ":2: the row is cut"));
  EXPECT_TRUE(Contains(TextMessage(head + "1 0 0 nan\n"), ":2: y: 'nan' is not a finite"));
  EXPECT_TRUE(Contains(TextMessage(head + "1 0 0 0\n1 999999999 0 0\n"), "too many for 2 rows"));
}

PointMotion Crowd(const std::vector<std::string>& names) {
  PointMotion motion;
  motion.rate_hz = 59.94;
  motion.names = names;
  for (std::size_t i = 0; i < names.size(); ++i) {
    motion.positions.emplace_back();
    for (int frame = 0; frame < 5; ++frame) {
      motion.positions[i].emplace_back(i + 0.1 * frame, 1.0 / 3.0, 0.9);
    }
  }
  motion.positions[0][3].setConstant(std::nan(""));
  return motion;
}

TEST_F(TrajectoriesTest, ThereAndBack) {
  const PointMotion motion = Crowd({"3", "17"});
  ASSERT_FALSE(WriteTrajectoryText(Path("a.txt"), motion));
  const PointMotion read = Unwrapped(ReadTrajectoryText(Path("a.txt")));
  EXPECT_EQ(read.rate_hz, motion.rate_hz);
  EXPECT_EQ(read.names, motion.names);
  for (std::size_t i = 0; i < motion.names.size(); ++i) {
    for (int frame = 0; frame < motion.num_frames(); ++frame) {
      const Eigen::Vector3d &is = read.positions[i][frame], &was = motion.positions[i][frame];
      ASSERT_EQ(is.allFinite(), was.allFinite());
      if (is.allFinite()) {
        EXPECT_EQ(is, was);
      }
    }
  }
}

TEST_F(TrajectoriesTest, PeopleWithNamesGetNumbers) {
  const auto ids = [this](const std::vector<std::string>& names) {
    EXPECT_FALSE(WriteTrajectoryText(Path("a.txt"), Crowd(names)));
    return Unwrapped(ReadTrajectoryText(Path("a.txt"))).names;
  };
  EXPECT_EQ(ids({"5", "5"}), (std::vector<std::string>{"0", "1"}));
  EXPECT_EQ(ids({"-2", "5"}), (std::vector<std::string>{"-2", "5"}));
  EXPECT_EQ(ids({"anna", "2"}), (std::vector<std::string>{"0", "1"}));
  EXPECT_TRUE(Contains(ReadText(Path("a.txt")),
                       "# person 0: anna\n# person 1: 2\n# id\tframe\tx/m\ty/m\tz/m\n"));
}

class CrowdPlacesTest : public TempDirTest {
 protected:
  PointMotion Crowd() {
    return Unwrapped(ReadTrajectoryText(
        WriteText("crowd.txt",
                  "# framerate: 10\n# id frame x/cm y/cm\n1 5 100 0\n2 5 50 30\n3 5 50 -30\n1 6 "
                  "110 0\n4 7 0 0\n")));
  }
};

TEST_F(CrowdPlacesTest, FromTheBackForwardsInMetres) {
  const auto places = Unwrapped(PlacesAt(Crowd(), std::nullopt));
  ASSERT_EQ(places.size(), 3u);
  EXPECT_EQ(places[0].name, "3");
  EXPECT_EQ(places[1].name, "2");
  EXPECT_EQ(places[2].name, "1");
  EXPECT_EQ(places[0].position, Eigen::Vector2d(0.5, -0.3));
  EXPECT_EQ(PlacesAt(Crowd(), 6).value().size(), 1u);
}

TEST_F(CrowdPlacesTest, Errors) {
  EXPECT_TRUE(Contains(ProblemOf(PlacesAt(Crowd(), 3)),
                       "there is no frame 3; the file has those from 5 to 7"));
  EXPECT_TRUE(Contains(ProblemOf(PlacesAt(Crowd(), -1)), "there is no frame -1"));
}

TEST_F(CrowdPlacesTest, OddSpacing) {
  EXPECT_EQ(OddSpacing({{"1", {0, 0}}, {"2", {0.5, 0}}}), "");
  EXPECT_EQ(OddSpacing({{"1", {0, 0}}}), "");
  EXPECT_TRUE(Contains(OddSpacing({{"7", {0, 0}}, {"9", {0.05, 0}}}), "people 7 and 9"));
  EXPECT_TRUE(Contains(OddSpacing({{"1", {0, 0}}, {"2", {45, 0}}}), "45 m away"));
}

}  // namespace
}  // namespace pushid
