// Force sensors in C3D, storage and CSV files, and lists of them.
#include <gtest/gtest.h>

#include "datasets/files/numeric_table.h"
#include "datasets/sensors/force_sensors.h"
#include "tests/datasets/c3d_samples.h"
#include "tests/datasets/c3d_writer.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

class SensorChoiceTest : public TempDirTest {
 protected:
  void SetUp() override {
    TempDirTest::SetUp();
    ASSERT_FALSE(WriteC3d(Path("a.c3d"), SampleC3d()));
    WriteText("a.mot",
              "f\nnRows=3\nnColumns=5\nendheader\n"
              "time ground_force_vx ground_force_vy ground_force_vz load\n"
              "0 1 2 3 10\n0.5 4 5 6 20\n1.0 7 8 9 nan\n");
    WriteText("a.csv", "time,force\n0,0\n0.1,5\n0.2,0\n");
  }

  SensorChoice Choice(const std::string& file, const std::string& column) {
    SensorChoice choice;
    choice.file = Path(file);
    choice.column = column;
    return choice;
  }
  std::string Message(const SensorChoice& choice) { return ProblemOf(ReadSensor(choice)); }
};

TEST_F(SensorChoiceTest, AnalogChannel) {
  SensorChoice choice = Choice("a.c3d", "rod");
  choice.gain = -2.0;
  const SensorRecord record = Unwrapped(ReadSensor(choice));
  EXPECT_FALSE(record.is_vector);
  EXPECT_EQ(record.num_samples(), 100);
  EXPECT_NEAR(record.time_s[10], 0.01, 1e-12);
  EXPECT_NEAR(record.force[10].x(), -2.0 * 40.0 * std::sin(0.5), 1e-4);
  EXPECT_TRUE(
      Contains(Message(Choice("a.c3d", "Rod")), "there is no analog channel 'Rod'; it has Fx1"));
  EXPECT_TRUE(Contains(Message(Choice("a.c3d", "")), "by --sensor_column"));
  EXPECT_TRUE(Contains(Message(Choice("a.c3d", "")), "rod"));
  EXPECT_TRUE(Contains(Message(Choice("a.c3d", "")), "platform:1"));
}

// A gain counts, whatever the unit of the channel is; without one, the unit does.
TEST_F(SensorChoiceTest, ChannelsInOtherUnits) {
  C3dFile file = SampleC3d();
  for (const auto& [unit, newtons] :
       {std::pair("kN", 1e3), std::pair("lbf", 4.44822), std::pair("Newton", 1.0),
        std::pair("", 1.0), std::pair("V", 0.0), std::pair("mN", 0.0)}) {
    file.analog[6].unit = unit;
    ASSERT_FALSE(WriteC3d(Path("u.c3d"), file));
    SensorChoice choice = Choice("u.c3d", "rod");
    choice.zero_n = 0.0;
    const Result<SensorRecord> read = ReadSensor(choice);
    choice.gain = 2.0;
    const double sample = 40.0 * std::sin(0.5);
    EXPECT_NEAR(Unwrapped(ReadSensor(choice)).force[10].x(), 2.0 * sample, 1e-4) << unit;
    if (newtons == 0.0) {
      EXPECT_TRUE(
          Contains(ProblemOf(read), std::string("rod is in '") + unit + "' (ANALOG:UNITS)"));
      EXPECT_TRUE(Contains(ProblemOf(read), "\"gain\""));
    } else {
      EXPECT_NEAR(Unwrapped(read).force[10].x(), newtons * sample, 1e-4 * newtons) << unit;
    }
  }
}

TEST_F(SensorChoiceTest, Platform) {
  SensorChoice choice = Choice("a.c3d", "platform:1");
  const SensorRecord record = Unwrapped(ReadSensor(choice));
  EXPECT_TRUE(record.is_vector);
  EXPECT_NEAR(record.force[0].z(), 700.0, 1e-3);
  ASSERT_TRUE(record.height_m);
  EXPECT_NEAR(*record.height_m, 0.0, 1e-6);  // it lies on the floor
  C3dFile file = SampleC3d();
  for (int c = 3; c < 6; ++c) file.analog[c].unit = "V";
  ASSERT_FALSE(WriteC3d(Path("v.c3d"), file));
  std::vector<std::string> warnings;
  ASSERT_TRUE(ReadSensor(Choice("v.c3d", "platform:1"), &warnings).ok());
  EXPECT_EQ(warnings.size(), 1u);
  // In a file whose y is up, the same numbers point elsewhere.
  choice.up = "y";
  choice.forward = "z";
  EXPECT_NEAR(ReadSensor(choice).value().force[0].x(), 700.0, 1e-3);
  EXPECT_TRUE(
      Contains(Message(Choice("a.c3d", "platform:2")), "no force platform 2; the file has 1"));
  EXPECT_TRUE(Contains(Message(Choice("a.c3d", "platform:x")), "'platform:x' is not a platform"));
}

TEST_F(SensorChoiceTest, ColumnsOfTables) {
  const SensorRecord vectors = Unwrapped(ReadSensor(Choice("a.mot", "ground_force_v")));
  EXPECT_TRUE(vectors.is_vector);
  EXPECT_EQ(vectors.force[1], Eigen::Vector3d(4, 5, 6));
  EXPECT_TRUE(Contains(Message(Choice("a.mot", "load")), "a.mot:8: load is missing"));
  EXPECT_TRUE(Contains(Message(Choice("a.mot", "")), "--sensor_column"));
  EXPECT_TRUE(Contains(Message(Choice("a.mot", "")), "it has time, ground_force_vx"));
  EXPECT_TRUE(Contains(Message(Choice("a.mot", "lode")), "there is no column 'lode'; it has time"));
  const SensorRecord csv = Unwrapped(ReadSensor(Choice("a.csv", "force")));
  EXPECT_EQ(csv.force[1].x(), 5.0);
  EXPECT_EQ(ReadSensor(Choice("a.csv", "")).value().force[1].x(), 5.0);
  // 30 N at rest come off after the gain; of a vector nothing can.
  SensorChoice resting = Choice("a.csv", "");
  resting.gain = 2.0;
  resting.zero_n = 30.0;
  EXPECT_EQ(ReadSensor(resting).value().force[1].x(), 2.0 * 5.0 - 30.0);
  resting = Choice("a.mot", "ground_force_v");
  resting.zero_n = 30.0;
  EXPECT_TRUE(Contains(Message(resting), "a sensor with a single axis"));
  SensorChoice zero = Choice("a.csv", "");
  zero.gain = 0.0;
  EXPECT_TRUE(Contains(Message(zero), "gain"));
  SensorChoice axes = Choice("a.csv", "");
  axes.up = "x";
  EXPECT_TRUE(Contains(Message(axes), "lie along the same axis"));
}

// A column's unit counts like a channel's; a gain counts, whatever the unit is.
TEST_F(SensorChoiceTest, ColumnsInOtherUnits) {
  for (const auto& [name, newtons] :
       {std::pair("Force (kN)", 1e3), std::pair("Force [lbf]", 4.44822),
        std::pair("Force (N, up)", 1.0), std::pair("Force (raw)", 1.0), std::pair("load", 1.0)}) {
    WriteText("u.csv", std::string("time,\"") + name + "\"\n0,0\n0.1,5\n0.2,0\n");
    SensorChoice choice = Choice("u.csv", name);
    EXPECT_NEAR(Unwrapped(ReadSensor(choice)).force[1].x(), 5.0 * newtons, 1e-9) << name;
    choice.gain = 2.0;
    EXPECT_EQ(Unwrapped(ReadSensor(choice)).force[1].x(), 10.0) << name;
  }
}

// The place of the pressure tells that units or corners are wrong, in a push as under a foot.
TEST_F(SensorChoiceTest, PressureOutsideOfThePlatformIsTold) {
  C3dFile file = SampleC3d();
  for (int c = 3; c < 6; ++c) file.analog[c].unit = "Nm";
  ASSERT_FALSE(WriteC3d(Path("far.c3d"), file));
  std::vector<std::string> warnings;
  ASSERT_TRUE(ReadSensor(Choice("far.c3d", "platform:1"), &warnings).ok());
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(Contains(warnings[0], "outside of its corners"));
}

// A sensor recorded in the file of the motion has its clock and axes; those that are given win.
TEST_F(SensorChoiceTest, FilledFromTheMotion) {
  RecordedPerson person;
  person.file = Path("a.c3d");
  person.file_clock_s = 0.4;
  person.file_up = "y";
  person.file_forward = "z";
  SensorChoice same = Choice("./a.c3d", "rod"), other = Choice("a.csv", ""), said = same;
  said.start_s = 0.1;
  said.up = "z";
  for (SensorChoice* choice : {&same, &other, &said}) FillFromMotion(person, choice);
  EXPECT_EQ(same.start_s, 0.4);
  EXPECT_EQ(same.up + same.forward, "yz");
  EXPECT_FALSE(other.start_s);
  EXPECT_EQ(other.up, "");
  EXPECT_EQ(said.start_s, 0.1);
  EXPECT_EQ(said.up + said.forward, "z");
}

TEST_F(SensorChoiceTest, Lists) {
  const std::vector<SensorChoice> list = Unwrapped(ReadSensorList(WriteText(
      "s.json",
      "[{\"file\": \"a.csv\", \"height\": 0.8, \"start\": -0.5},\n"
      " {\"file\": \"/b.c3d\", \"column\": \"rod\", \"gain\": -2, \"direction\": [0, 1, 0], "
      "\"height_m\": 1.1, \"idle_force\": 3, \"up\": \"y\", \"forward\": \"z\"}]")));
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0].file, Path("a.csv"));
  EXPECT_EQ(list[0].height_fraction, 0.8);
  EXPECT_EQ(list[0].start_s, -0.5);
  EXPECT_EQ(list[1].file, "/b.c3d");
  EXPECT_EQ(list[1].direction, Eigen::Vector3d::UnitY());
  EXPECT_EQ(list[1].height_m, 1.1);
  EXPECT_EQ(list[1].idle_force, 3.0);
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"{}", "a list of sensors is expected"},
      {"[]", "a list of sensors is expected"},
      {"[{}]", "sensor 0: file is missing"},
      {"[{\"file\": \"a\", \"direction\": [1, 2]}]", "direction must be [x, y, z]"},
      {"[{\"file\": \"a\", \"height\": 1, \"height_m\": 1}]",
       "height is given together with height_m"},
      {"[{\"file\": \"a\", \"gain\": \"2\"}]", "gain must be the N per unit"},
      {"[{\"file\": \"a\", \"hieght\": 1}]", "hieght is not known; there may be file, column"},
      {"[{\"file\": \"a\", \"idle_force\": -1}]", "at least 0 N"},
  };
  for (const auto& [text, says] : bad) {
    EXPECT_TRUE(Contains(ProblemOf(ReadSensorList(WriteText("s.json", text))), says));
  }
}

}  // namespace
}  // namespace pushid
