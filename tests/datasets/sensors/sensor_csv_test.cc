// Sensor records: both forms, and clear errors with file and line.
#include <algorithm>
#include <cmath>

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

// Sensor files of other programs.
TEST_F(SensorCsv, ReadsWhatIsPlain) {
  for (const char* text :
       {"Time,Force\n0,1\n0.01,2\n0.02,3\n", "TIME,FORCE\n0,1\n0.01,2\n0.02,3\n",
        "time;force\n0;1\n0.01;2\n0.02;3\n", "time\tforce\n0\t1\n0.01\t2\n0.02\t3\n",
        "\"time\",\"force\"\n\"0\",\"1\"\n\"0.01\",\"2\"\n\"0.02\",\"3\"\n",
        "Time (s),Force (N)\n0,1\n0.01,2\n0.02,3\n", "t[s];force[N]\n0;1\n0.01;2\n0.02;3\n",
        "time_ms,force\n0,1\n10,2\n20,3\n", "Time (ms),Force (N)\n0,1\n10,2\n20,3\n",
        "# logged\ntime_s,force_N\n0,1\n0.01,2\n0.02,3\n",
        "time,force,\n0,1,\n0.01,2,\n0.02,3,\n"}) {
    const auto record = Unwrapped(ReadSensorCsv(WriteText("s.csv", text)));
    EXPECT_EQ(record.time_s, (std::vector<double>{0.0, 0.01, 0.02})) << text;
    EXPECT_EQ(record.force[1], Eigen::Vector3d(2.0, 0.0, 0.0)) << text;
  }
  EXPECT_TRUE(Unwrapped(ReadSensorCsv(WriteText(
                            "s.csv", "T;FX (N);FY (N);FZ (N)\n0;1;2;3\n1;4;5;6\n2;7;8;9\n")))
                  .is_vector);
}

// A table of other columns is asked for by its column.
TEST_F(SensorCsv, AsksForTheColumn) {
  for (const char* head : {"time,force (kN)", "time,Force (lbf)", "time,load", "time,force (V)",
                           "time,fx,fy", "time,fx,fy,fz,mx", "force,time", "time,force,force_2",
                           "sample,force", "time,Fz", "time"}) {
    EXPECT_TRUE(Contains(Problem(std::string(head) + "\n0,1,2,3,4\n"), "--sensor_column")) << head;
  }
}

// Noise of 1 N on a push of 0.5 s at 1000 per second.
SensorRecord Pushed(double peak, double limit, double noise, double resolution = 1e-3) {
  SensorRecord record;
  record.file = "s.csv";
  for (int i = 0; i < 2000; ++i) {
    const double t = i / 1000.0,
                 pulse = t > 1.0 && t < 1.5 ? std::sin(2.0 * M_PI * (t - 1.0)) : 0.0;
    const double read = peak * pulse + noise * std::sin(1e4 * t * t);
    record.time_s.push_back(t);
    record.force.emplace_back(std::clamp(resolution * std::round(read / resolution), -limit, limit),
                              0.0, 0.0);
  }
  return record;
}

TEST_F(SensorCsv, ARangeThatIsExceeded) {
  EXPECT_TRUE(Contains(ClippedText(Pushed(100.0, 70.0, 1.0)),
                       "samples on end read exactly the largest force, 70 N: the sensor's range"));
  const struct {
    double peak, limit, noise, resolution;
    bool clipped;
  } cases[] = {
      {100.0, 95.0, 1.0, 1e-3, true},  {100.0, 40.0, 1.0, 1e-3, true},
      {-100.0, 70.0, 1.0, 1e-3, true}, {100.0, 70.0, 1.0, 0.2, true},
      {500.0, 200.0, 0.3, 0.01, true}, {100.0, 1e3, 1.0, 1e-3, false},
      {100.0, 1e3, 1.0, 1.0, false},   {100.0, 1e3, 0.0, 1e-3, false},
      {100.0, 1e3, 0.0, 1.0, false},   {0.0, 1e3, 1.0, 1e-3, false},
      {100.0, 70.0, 0.0, 1e-3, false},  // without noise it may be a force that was held
  };
  for (const auto& one : cases) {
    EXPECT_EQ(!ClippedText(Pushed(one.peak, one.limit, one.noise, one.resolution)).empty(),
              one.clipped)
        << one.peak << " " << one.limit << " " << one.noise << " " << one.resolution;
  }
}

TEST_F(SensorCsv, ErrorsNameFileAndLine) {
  const std::string rows = "time,force\n0,1\n0.01,2\n";
  EXPECT_TRUE(Contains(Problem(rows + "0.02,nan\n"), "sensor.csv:4: force"));
  EXPECT_TRUE(Contains(Problem(rows + "0.02,\n"), "sensor.csv:4: force is missing"));
  EXPECT_TRUE(Contains(Problem(rows + "0.02,2 N\n"), "sensor.csv:4: force"));
  EXPECT_TRUE(Contains(Problem(rows + "0.02\n"), "sensor.csv:4: the row has 1 values, not 2"));
  EXPECT_TRUE(Contains(Problem(rows + "0.02,1,1\n"), "sensor.csv:4: the row has more than the 2"));
  EXPECT_TRUE(Contains(Problem(rows + "0.01,2\n"), "sensor.csv:4: time 0.01 s does not come"));
  EXPECT_TRUE(Contains(Problem(rows + "0.005,2\n"), "sensor.csv:4: time"));
  EXPECT_TRUE(Contains(Problem(rows), "ends after 2 samples"));
  EXPECT_TRUE(Contains(Problem("time,force\n"), "no rows"));
  EXPECT_TRUE(Contains(Problem("t,f\n0,1\n"), "sensor.csv:1: the header is 't, f'"));
  EXPECT_TRUE(Contains(Problem(""), "is empty"));
  EXPECT_TRUE(Contains(ReadSensorCsv(Path("none.csv")).error().ToString(), "none.csv"));
}

TEST_F(SensorCsv, GapsAreErrorsMissingSingleSamplesAreNot) {
  EXPECT_EQ(Problem("time_s,force\n0,1\n1,1\n2,1\n4,1\n5,1\n"), "no error");
  const std::string gap = Problem("time_s,force\n0,1\n1,1\n2,1\n3,1\n9,1\n10,1\n");
  EXPECT_TRUE(Contains(gap, "sensor.csv:6: no samples for 6 s, from 3 s to 9 s"));
}

}  // namespace
}  // namespace pushid
