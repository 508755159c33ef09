// Trajectories of crowds: text, and SQLite as JuPedSim writes it.
#include "datasets/formats/trajectories.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cmath>

#include "tests/test_support.h"

namespace pushid {
namespace {

class TrajectoriesTest : public TempDirTest {
 protected:
  std::string TextMessage(const std::string& text) {
    return ProblemOf(ReadTrajectoryText(WriteText("crowd.txt", text)));
  }
  std::string Sqlite(const std::string& name, const std::string& sql) {
    sqlite3* database = nullptr;
    EXPECT_EQ(sqlite3_open(Path(name).c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
        << sqlite3_errmsg(database);
    sqlite3_close(database);
    return Path(name);
  }
};

// As PeTrack writes it: centimetres, people who come and go.
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
  options.choose = [](const std::vector<std::string>&) { return std::vector<int>{1}; };
  const Result<PointMotion> one = ReadTrajectoryText(path, options);
  ASSERT_EQ(one.value().positions.size(), 1u);
  EXPECT_EQ(one.value().positions[0].size(), 2u);
}

// Of vertical tabs and form feeds too; such a line once ended the program.
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

void ExpectSameMotion(const Result<PointMotion>& read, const PointMotion& motion, bool heights) {
  ASSERT_TRUE(read.ok()) << read.error().ToString();
  EXPECT_EQ(read.value().rate_hz, motion.rate_hz);
  for (std::size_t i = 0; i < motion.names.size(); ++i) {
    for (int frame = 0; frame < motion.num_frames(); ++frame) {
      Eigen::Vector3d expected = motion.positions[i][frame];
      if (!heights) expected.z() = 0.0;
      const Eigen::Vector3d& is = read.value().positions[i][frame];
      ASSERT_EQ(is.allFinite(), expected.allFinite());
      if (!is.allFinite()) continue;
      EXPECT_EQ(is, expected);
    }
  }
}

TEST_F(TrajectoriesTest, ThereAndBack) {
  const PointMotion motion = Crowd({"3", "17"});
  ASSERT_FALSE(WriteTrajectoryText(Path("a.txt"), motion));
  ExpectSameMotion(ReadTrajectoryText(Path("a.txt")), motion, true);
  ASSERT_FALSE(WriteTrajectorySqlite(Path("a.sqlite"), motion));
  ExpectSameMotion(ReadTrajectorySqlite(Path("a.sqlite")), motion, false);
  EXPECT_EQ(ReadTrajectorySqlite(Path("a.sqlite")).value().names, motion.names);
}

TEST_F(TrajectoriesTest, PeopleWithNamesGetNumbers) {
  const PointMotion motion = Crowd({"anna", "2"});
  EXPECT_EQ(TrajectoryIds(motion.names), (std::vector<std::int64_t>{1, 2}));
  EXPECT_EQ(TrajectoryIds({"5", "5"}), (std::vector<std::int64_t>{1, 2}));
  EXPECT_EQ(TrajectoryIds({"5", "-2"}), (std::vector<std::int64_t>{5, -2}));
  ASSERT_FALSE(WriteTrajectoryText(Path("a.txt"), motion));
  EXPECT_TRUE(Contains(ReadText(Path("a.txt")), "# person 1: anna\n# id\tframe\tx/m\ty/m\tz/m\n"));
}

// Version 1 has no table of frames.
TEST_F(TrajectoriesTest, SqliteOfJuPedSim) {
  const std::string path = Sqlite(
      "one.sqlite",
      "CREATE TABLE trajectory_data (frame INTEGER, id INTEGER, pos_x REAL, pos_y REAL, ori_x "
      "REAL, "
      "ori_y REAL); CREATE TABLE metadata (key TEXT, value TEXT); CREATE TABLE geometry (wkt TEXT);"
      "INSERT INTO metadata VALUES ('version', '1'), ('fps', '10.0');"
      "INSERT INTO trajectory_data VALUES (0, 4, 1.5, 2, 1, 0), (1, 4, 1.6, 2, 1, 0);");
  const PointMotion read = Unwrapped(ReadTrajectorySqlite(path));
  EXPECT_EQ(read.rate_hz, 10.0);
  EXPECT_EQ(read.names, std::vector<std::string>{"4"});
  EXPECT_EQ(read.positions[0][1], Eigen::Vector3d(1.6, 2, 0));
}

TEST_F(TrajectoriesTest, BadSqlite) {
  const auto message = [](const std::string& path) {
    return ProblemOf(ReadTrajectorySqlite(path));
  };
  EXPECT_TRUE(Contains(message(Path("none.sqlite")), "none.sqlite: "));
  EXPECT_TRUE(Contains(message(WriteText("text.sqlite", "id,frame\n1,2\n, and more of it")),
                       "is not a SQLite file of JuPedSim: file is not a database"));
  EXPECT_TRUE(Contains(message(Sqlite("b.sqlite", "CREATE TABLE metadata (key TEXT, value TEXT);")),
                       "fps in the table metadata is 0"));
  EXPECT_TRUE(Contains(message(Sqlite("c.sqlite",
                                      "CREATE TABLE metadata (key TEXT, value TEXT);"
                                      "INSERT INTO metadata VALUES ('fps', '10');")),
                       "no such table: trajectory_data"));
}

}  // namespace
}  // namespace pushid
