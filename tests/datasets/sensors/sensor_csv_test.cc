// Sensor records: both forms, and clear errors with file and line.
#include "datasets/formats/force_csv.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

class SensorCsv : public TempDirTest {
 protected:
  std::string Problem(const std::string& text) {
    return ProblemOf(ReadSensorCsv(WriteText("sensor.csv", text)));
  }
};

TEST_F(SensorCsv, ReadsForcesAlongAnAxis) {
  const auto record = Unwrapped(
      ReadSensorCsv(WriteText("s.csv", "time,force\r\n-0.01,0\r\n0,1.5e2\r\n\r\n0.01,-2\r\n")));
  EXPECT_FALSE(record.is_vector);
  EXPECT_EQ(record.time_s, (std::vector<double>{-0.01, 0.0, 0.01}));
  EXPECT_EQ(record.force[1], Eigen::Vector3d(150.0, 0.0, 0.0));
}

TEST_F(SensorCsv, ReadsVectors) {
  const auto record = Unwrapped(
      ReadSensorCsv(WriteText("s.csv", "time, fx, fy, fz\n0,1,2,3\n0.01,4,5,6\n0.02,7,8,9")));
  EXPECT_TRUE(record.is_vector);
  EXPECT_EQ(record.force[2], Eigen::Vector3d(7.0, 8.0, 9.0));
}

TEST_F(SensorCsv, ErrorsNameFileAndLine) {
  const std::string rows = "time,force\n0,1\n0.01,2\n";
  EXPECT_TRUE(Contains(Problem(rows + "0.02,nan\n"), "sensor.csv:4: force"));
  EXPECT_TRUE(Contains(Problem(rows + "0.02,\n"), "sensor.csv:4: force is missing"));
  EXPECT_TRUE(Contains(Problem(rows + "0.02,2 N\n"), "sensor.csv:4: force"));
  EXPECT_TRUE(Contains(Problem(rows + "0.02\n"), "sensor.csv:4: the row has 1 values, not 2"));
  EXPECT_TRUE(Contains(Problem(rows + "0.02,1,1\n"), "sensor.csv:4: the row has 3 values"));
  EXPECT_TRUE(Contains(Problem(rows + "0.01,2\n"), "sensor.csv:4: time 0.01 s does not come"));
  EXPECT_TRUE(Contains(Problem(rows + "0.005,2\n"), "sensor.csv:4: time"));
  EXPECT_TRUE(Contains(Problem(rows), "ends after 2 samples"));
  EXPECT_TRUE(Contains(Problem("time,force\n"), "ends after 0 samples"));
  EXPECT_TRUE(Contains(Problem("t,f\n0,1\n"), "sensor.csv:1: the header is 't,f'"));
  EXPECT_TRUE(Contains(Problem(""), "is empty"));
  EXPECT_TRUE(Contains(ReadSensorCsv(Path("none.csv")).error().ToString(), "none.csv"));
}

TEST_F(SensorCsv, GapsAreErrorsMissingSingleSamplesAreNot) {
  EXPECT_EQ(Problem("time,force\n0,1\n1,1\n2,1\n4,1\n5,1\n"), "no error");
  const std::string gap = Problem("time,force\n0,1\n1,1\n2,1\n3,1\n9,1\n10,1\n");
  EXPECT_TRUE(Contains(gap, "sensor.csv:6: no samples for 6 s, from 3 s to 9 s"));
}

}  // namespace
}  // namespace pushid
