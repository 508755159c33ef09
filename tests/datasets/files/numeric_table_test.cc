// Tables as text: round trips, separators, files as other programs write them, bad input.
#include "datasets/files/numeric_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/simulators/table_files.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

using NumericTableTest = TempDirTest;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST_F(NumericTableTest, TableRoundTrip) {
  NumericTable table;
  table.names = {"time", "a", "b"};
  table.chosen = {0, 1, 2};
  table.data = {{0.0, 0.01, 0.02}, {0.1, kNaN, -1e-30}, {1e300, 2.0 / 3.0, 0.0}};
  for (TableFormat format : {TableFormat::kCsv, TableFormat::kStorage}) {
    ASSERT_FALSE(WriteNumericTable(Path("t"), format, table));
    const NumericTable read = Unwrapped(ReadNumericTable(Path("t"), format));
    EXPECT_EQ(read.names, table.names);
    for (int i = 0; i < 3; ++i) {
      for (int row = 0; row < 3; ++row) {
        if (std::isnan(table.data[i][row])) {
          EXPECT_TRUE(std::isnan(read.data[i][row]));
        } else {
          EXPECT_EQ(read.data[i][row], table.data[i][row]);
        }
      }
    }
  }
}

TEST_F(NumericTableTest, TablesOfOtherPrograms) {
  const char* semicolons = "\xEF\xBB\xBF# made by hand\n\"t\";\"x\";\n0;1;\n0.5;;\n";
  Result<NumericTable> read = ReadNumericTable(WriteText("a.csv", semicolons), TableFormat::kCsv);
  ASSERT_TRUE(read.ok()) << read.error().ToString();
  EXPECT_EQ(read.value().names, (std::vector<std::string>{"t", "x"}));
  EXPECT_TRUE(std::isnan(read.value().data[1][1]));
  // An old motion file.
  const char* mot =
      "forces\ndatacolumns 3\ndatarows 2\nrange 0 1\nendheader\n"
      "time ground_force_vx\tground_force_vy\n 0.0  1 2 \n 1.0\tnan\t4\n";
  read = ReadNumericTable(WriteText("a.mot", mot), TableFormat::kStorage);
  ASSERT_TRUE(read.ok()) << read.error().ToString();
  EXPECT_TRUE(std::isnan(read.value().data[1][1]));
  EXPECT_EQ(read.value().data[2][1], 4.0);
}

TEST_F(NumericTableTest, SeparatorsAsTheLineOfNamesHasThem) {
  const struct {
    std::string text;
    std::vector<std::string> names;
  } cases[] = {
      {"time\tforce (N, up)\n1\t2\n", {"time", "force (N, up)"}},
      {"time\tforce, up\n1\t2\n", {"time", "force, up"}},  // as many of each: the rarer in names
      {"time\tx [m; up]\ty [m; left]\n1\t2\t3\n", {"time", "x [m; up]", "y [m; left]"}},
      {"time;force (N, up, left)\n1;2\n", {"time", "force (N, up, left)"}},
      {"time;\"x, up, left, far\"\n1;2\n", {"time", "x, up, left, far"}},
      {"time,\"force; N; up\",\"a, b\"\n1,\"2\",3\n", {"time", "force; N; up", "a, b"}},
      {"time,\tx,\ty\n1,\t2,\t3\n", {"time", "x", "y"}},
      {"time,pipe 5\",b (\n1,2,3\n", {"time", "pipe 5\"", "b ("}},  // nothing closes
      {"time\n1\n", {"time"}},
  };
  for (const auto& one : cases) {
    const Result<NumericTable> read =
        ReadNumericTable(WriteText("a.csv", one.text), TableFormat::kCsv);
    ASSERT_TRUE(read.ok()) << one.text << read.error().ToString();
    EXPECT_EQ(read.value().names, one.names);
    EXPECT_EQ(read.value().data.back()[0], static_cast<double>(one.names.size()));
  }
}

// In s, whatever the file counts in; what says s stays.
TEST_F(NumericTableTest, TimesInMilliseconds) {
  const struct {
    const char *name, *step;
    double seconds;
  } cases[] = {
      {"time_ms", "10", 0.01},    {"Time (ms)", "10", 0.01}, {"t [ms]", "0.2", 2e-4},
      {"T_MS", "1", 0.001},       {"time/ms", "4", 0.004},   {"time", "10", 0.01},
      {"Time", "1", 0.001},       {"t", "0.5", 5e-4},        {"time", "0.02", 0.02},
      {"time_s", "10", 10.0},     {"Time (s)", "1", 1.0},    {"seconds", "2", 2.0},
      {"\"Time [s]\"", "2", 2.0}, {"time(s)", "0.1", 0.1},   {"TIME (sec)", "0.1", 0.1},
  };
  for (const auto& one : cases) {
    std::string text = std::string(one.name) + ",a\n";
    for (int i = 0; i < 60; ++i) text += std::to_string(i * std::stod(one.step)) + ",1\n";
    const NumericTable read =
        Unwrapped(ReadNumericTable(WriteText("a.csv", text), TableFormat::kCsv));
    EXPECT_EQ(FindTimeColumn(read.names, ""), 0) << one.name;
    EXPECT_NEAR(Unwrapped(EvenTimeStep(read, 0)), one.seconds, 1e-9) << one.name;
  }
  for (const char* name : {"timing", "ms", "frame", "times_walked", "Time (\xC2\xB5s)"}) {
    EXPECT_EQ(FindTimeColumn({name}, ""), -1) << name;
  }
}

// A push that was drawn by hand, and a storage file, whose times are in s by definition.
TEST_F(NumericTableTest, FewTimesAndThoseOfStorageFilesStayInSeconds) {
  const NumericTable drawn = Unwrapped(
      ReadNumericTable(WriteText("a.csv", "time,force\n0,0\n0.5,90\n1,0\n"), TableFormat::kCsv));
  EXPECT_EQ(drawn.data[0][2], 1.0);
  std::string text = "f\nendheader\ntime\ta\n";
  for (int i = 0; i < 60; ++i) text += std::to_string(i) + "\t1\n";
  const NumericTable stored =
      Unwrapped(ReadNumericTable(WriteText("a.mot", text), TableFormat::kStorage));
  EXPECT_EQ(stored.data[0][59], 59.0);
  EXPECT_EQ(PlainName("-Fx"), "-fx") << "a force of the other sign is another column";
}

// Where it jumps, not at the first row.
TEST_F(NumericTableTest, TimesThatJump) {
  std::string text = "time,a\n";
  for (int i = 0; i < 20; ++i) text += std::to_string(0.01 * (i + (i > 9 ? 4 : 0))) + ",1\n";
  const NumericTable read =
      Unwrapped(ReadNumericTable(WriteText("a.csv", text), TableFormat::kCsv));
  EXPECT_TRUE(Contains(ProblemOf(EvenTimeStep(read, 0)),
                       ":12: the times do not ascend in even "
                       "steps: 0.05 s where 0.01 s is usual"));
}

TEST_F(NumericTableTest, TimesThatDescend) {
  const NumericTable read = Unwrapped(
      ReadNumericTable(WriteText("a.csv", "time,a\n0.2,1\n0.1,1\n0.0,2\n"), TableFormat::kCsv));
  EXPECT_TRUE(Contains(ProblemOf(EvenTimeStep(read, 0)),
                       "the times do not ascend: 0.1 s comes after 0.2 s"));
}

// Cells are empty between tabs; a row that is cut behind one is not.
TEST_F(NumericTableTest, EmptyCellsOfStorageFiles) {
  const std::string head = "f\nendheader\ntime\ta\tb\n0\t\t2\n";
  const NumericTable read =
      Unwrapped(ReadNumericTable(WriteText("a.mot", head + "1\t3\t\n"), TableFormat::kStorage));
  EXPECT_TRUE(std::isnan(read.data[1][0]));
  EXPECT_TRUE(std::isnan(read.data[2][1]));
  EXPECT_EQ(read.data[2][0], 2.0);
  EXPECT_TRUE(Contains(
      ProblemOf(ReadNumericTable(WriteText("a.mot", head + "1\t3\t"), TableFormat::kStorage)),
      ":5: the row has 2 values, not 3"));
}

TEST_F(NumericTableTest, BadTables) {
  struct Case {
    TableFormat format;
    std::string text, says;
  };
  const TableFormat csv = TableFormat::kCsv, storage = TableFormat::kStorage;
  const std::vector<Case> cases = {
      {csv, "", "truncated"},
      {csv, "a,b\n", "no rows"},
      {csv, "1,2\n3,4\n", ":1: a column is called '1'"},
      {csv, "a,a\n3,4\n", ":1: two columns are called 'a'"},
      {csv, "a,b\n1,2\n3\n", ":3: the row has 1 values, not 2, separated by commas as"},
      {csv, "a,b\n1,2,3\n",
       ":2: the row has more than the 2 values of the columns, separated by commas"},
      {csv, "a,b,c\n1;2;3\n", ":2: the row has 1 values, not 3, separated by commas"},
      {csv, "a,b,c\nx,2,3\n", ":2: a: 'x' is not a number"},
      {csv, "a\tb (N, up)\n1,2\n", ":2: the row has 1 values, not 2, separated by tabs"},
      {csv, "a;b\n1,5\n", ":2: the row has 1 values, not 2, separated by semicolons"},
      {csv, "a,f, up\n1,2\n", "or a name with a separator in it is not in quotes"},
      {storage, "f\nendheader\na b\n1\n", ":4: the row has 1 values, not 2, separated by blanks"},
      {csv, "a,b\n1,x\n", ":2: b: 'x' is not a number"},
      {csv, "a,b\n1,NA\n", "'NA' is not a number; a value that is missing is an empty cell or nan"},
      {csv, "a,b\n1,inf\n", ":2: b: 'inf' is not a finite number"},
      {storage, "f\nnRows=1\n", "endheader"},
      {storage, "f\nDataType=Vec3\nendheader\ntime\ta\n0\t1,2,3\n", ":2: DataType is 'Vec3'"},
      {storage, "f\nnRows=x\nendheader\na\n1\n", ":2: nRows must be a whole number"},
      {storage, "f\nnRows=3\nendheader\na\n1\n", "declares 3 rows, the file has 1"},
      {storage, "f\nnColumns=3\nendheader\na\n1\n", ":4: the header declares 3 columns"},
  };
  for (const Case& one : cases) {
    EXPECT_TRUE(
        Contains(ProblemOf(ReadNumericTable(WriteText("bad", one.text), one.format)), one.says));
  }
}

}  // namespace
}  // namespace pushid
