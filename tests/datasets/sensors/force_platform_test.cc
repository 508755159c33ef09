// Force platforms: the same known load through the channels of all four types.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "datasets/sensors/force_sensors.h"
#include "models/decompositions.h"
#include "tests/datasets/c3d_samples.h"
#include "tests/datasets/handmade_c3d.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

using Eigen::Vector3d;

// Presses the platform, platform axes, SI: the force on it at (x, y) of its surface and a free
// moment about z.
struct Load {
  Vector3d force{30.0, -20.0, 700.0};  // z points into the platform: 700 N are the person's weight
  double x = 0.05, y = -0.08, free_moment = 2.0;
};

// M about the sensors' origin, `depth` under the surface: r = (x, y, -depth), z down.
Vector3d MomentAtSensors(const Load& load, double depth) {
  return Vector3d(load.x, load.y, -depth).cross(load.force) + Vector3d(0.0, 0.0, load.free_moment);
}

C3dFile WithChannels(const C3dPlatform& platform, const std::vector<double>& values) {
  C3dFile file = SampleC3d();
  file.analog.clear();
  for (std::size_t i = 0; i < values.size(); ++i) {
    file.analog.push_back({"c" + std::to_string(i), "", std::vector<double>(100, values[i])});
  }
  file.platforms = {platform};
  file.platforms[0].channels.clear();
  for (std::size_t i = 0; i < values.size(); ++i) {
    file.platforms[0].channels.push_back(static_cast<int>(i));
  }
  return file;
}

// The sample's platform lies at x 0 to 0.6, y -0.2 to 0.2 with its +x along the world's and its +y
// against it: centre (0.3, 0, 0). The force on the person is the reaction.
void ExpectLoad(const C3dFile& file, const Load& load) {
  const PlatformRecord record = Unwrapped(EvaluatePlatform(file, 0, LengthUnit::kMillimetre));
  ASSERT_EQ(record.force.size(), 100u);
  const Vector3d reaction(-load.force.x(), load.force.y(), load.force.z());
  EXPECT_LT((record.force[7] - reaction).norm(), 1e-9) << record.force[7].transpose();
  const Vector3d centre(0.3 + load.x, -load.y, 0.0);
  EXPECT_LT((record.centre[7] - centre).norm(), 1e-9) << record.centre[7].transpose();
  EXPECT_LT((record.normal - Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(ForcePlatformTest, Type1) {
  const Load load;
  C3dPlatform platform = SampleC3d().platforms[0];
  platform.type = 1;
  ExpectLoad(WithChannels(platform, {load.force.x(), load.force.y(), load.force.z(), 1e3 * load.x,
                                     1e3 * load.y, 1e3 * load.free_moment}),
             load);
}

TEST(ForcePlatformTest, Type2) {
  const Load load;
  const Vector3d m = 1e3 * MomentAtSensors(load, 0.04);
  const C3dPlatform platform = SampleC3d().platforms[0];
  C3dFile file =
      WithChannels(platform, {load.force.x(), load.force.y(), load.force.z(), m.x(), m.y(), m.z()});
  ExpectLoad(file, load);
  // The other sign of the channels is the reaction already, and the other sign of the depth a
  // common mistake.
  for (C3dAnalogChannel& channel : file.analog) {
    for (double& sample : channel.samples) sample = -sample;
  }
  file.platforms[0].origin.z() = 40.0;
  ExpectLoad(file, load);
  // Moments in N m.
  for (int i = 3; i < 6; ++i) {
    file.analog[i].unit = "N.m";
    for (double& sample : file.analog[i].samples) sample /= 1e3;
  }
  ExpectLoad(file, load);
}

// Four sensors at (+-a, +-b): their vertical forces solved from force and moment.
TEST(ForcePlatformTest, Type3) {
  const Load load;
  const double a = 0.12, b = 0.2, depth = 0.054;
  C3dPlatform platform = SampleC3d().platforms[0];
  platform.type = 3;
  platform.origin = {1e3 * a, 1e3 * b, -1e3 * depth};
  const Vector3d m = MomentAtSensors(load, depth);
  Eigen::Matrix4d sums;
  sums << 1, 1, 1, 1, b, b, -b, -b, -a, a, a, -a, 1, -1, 1, -1;
  const Eigen::Vector4d fz = sums.inverse() * Eigen::Vector4d(load.force.z(), m.x(), m.y(), 0.0);
  // Mz = b (-fx12 + fx34) + a (fy14 - fy23), the y forces shared evenly.
  const double difference = m.z() / b;
  ExpectLoad(WithChannels(platform,
                          {0.5 * (load.force.x() - difference), 0.5 * (load.force.x() + difference),
                           0.5 * load.force.y(), 0.5 * load.force.y(), fz[0], fz[1], fz[2], fz[3]}),
             load);
}

TEST(ForcePlatformTest, Type4) {
  const Load load;
  Eigen::Matrix<double, 6, 1> wrench;
  wrench << load.force, 1e3 * MomentAtSensors(load, 0.04);
  C3dPlatform platform = SampleC3d().platforms[0];
  platform.type = 4;
  platform.calibration.setIdentity();
  for (int i = 0; i < 6; ++i) platform.calibration(i, (i + 1) % 6) = 0.1 * (i + 1);
  platform.calibration *= 50.0;
  const Eigen::Matrix<double, 6, 1> volts = Inverse(platform.calibration) * wrench;
  ExpectLoad(WithChannels(platform, {volts.data(), volts.data() + 6}), load);
}

TEST(ForcePlatformTest, BaselineIsTakenOff) {
  const Load load;
  const Vector3d m = 1e3 * MomentAtSensors(load, 0.04);
  C3dFile file = WithChannels(SampleC3d().platforms[0], {load.force.x(), load.force.y(),
                                                         load.force.z(), m.x(), m.y(), m.z()});
  for (C3dAnalogChannel& channel : file.analog) {
    for (std::size_t i = 0; i < channel.samples.size(); ++i) {
      channel.samples[i] = 3.0 + (i < 90 ? channel.samples[i] : 0.0);
    }
  }
  file.platform_zero_first = file.platform_zero_last = 10;  // the last frame, from 1
  ExpectLoad(file, load);
}

// A platform on a wall, pressed backwards: the person is pushed out of its surface.
TEST(ForcePlatformTest, OnAWall) {
  C3dFile file = SampleC3d();
  C3dPlatform& wall = file.platforms[0];
  wall.corners << 0.0, 0.0, 0.0, 0.0,  // in the plane x = 0
      200.0, -200.0, -200.0, 200.0,    // +x of the platform is the world's y
      1300.0, 1300.0, 700.0, 700.0;    // +y of it is the world's z: its z is the world's x
  const PlatformRecord record = Unwrapped(EvaluatePlatform(file, 0, LengthUnit::kMillimetre));
  EXPECT_LT((record.normal + Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_LT((record.force[0] - Vector3d(-700.0, 20.0, -10.0)).norm(), 1e-9)
      << record.force[0].transpose();
}

TEST(ForcePlatformTest, ThereMustBeOne) {
  EXPECT_TRUE(Contains(EvaluatePlatform(SampleC3d(), 1, LengthUnit::kMillimetre).error().ToString(),
                       "there is no force platform 2; the file has 1"));
}

// Whoever stands on a platform in its ZERO frames stays or leaves; an offset stays. Forces in N of
// the ten frames, upwards, and what is left of the last one.
TEST(ForcePlatformTest, LoadedZerosAreNotTakenOff) {
  const auto evaluated = [](double at_first, double from_third) {
    C3dFile file = SampleC3d();
    for (int c = 0; c < 6; ++c) {
      for (int i = 0; i < 100; ++i) {
        file.analog[c].samples[i] = c == 2 ? -(i < 20 ? at_first : from_third) : 0.0;
      }
    }
    file.platform_zero_first = 1;
    file.platform_zero_last = 2;
    const PlatformRecord record = Unwrapped(EvaluatePlatform(file, 0, LengthUnit::kMillimetre));
    EXPECT_LE(record.warnings.size(), 1u);
    const bool told =
        !record.warnings.empty() && Contains(record.warnings[0], "in which it is loaded with");
    return std::pair(told, record.force.back().z());
  };
  EXPECT_EQ(evaluated(700.0, 710.0), std::pair(true, 710.0));
  EXPECT_EQ(evaluated(700.0, 0.0), std::pair(true, 0.0));
  EXPECT_EQ(evaluated(250.0, 950.0), std::pair(false, 700.0));
  EXPECT_EQ(evaluated(-250.0, 450.0), std::pair(false, 700.0));
  EXPECT_EQ(evaluated(40.0, 40.0), std::pair(false, 0.0));
}

TEST(ForcePlatformTest, SamplesAreFinite) {
  C3dFile file = SampleC3d();
  file.analog[1].samples[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(Contains(ProblemOf(EvaluatePlatform(file, 0, LengthUnit::kMillimetre)),
                       "platform:1 is not finite at sample 7"));
}

// The label says N m, the numbers are N mm.
TEST(ForcePlatformTest, CentresBeyondTheCornersNameTheUnits) {
  C3dFile file = SampleC3d();
  EXPECT_EQ(Unwrapped(EvaluatePlatform(file, 0, LengthUnit::kMillimetre)).outside, "");
  for (int c = 3; c < 6; ++c) file.analog[c].unit = "Nm";
  EXPECT_TRUE(Contains(Unwrapped(EvaluatePlatform(file, 0, LengthUnit::kMillimetre)).outside,
                       "m outside of its corners: are the channels' units (N, Nm)"));
}

// A platform as files describe it, pressed with 700 N at (0.05, 0.03) m of the floor.
struct PlateFile {
  std::vector<int> raw = {60, -40, 700, -22600, -37400, -200};
  std::vector<double> scale = std::vector<double>(8, 1.0);
  std::vector<std::string> units = {"N", "N", "N", "Nmm", "Nmm", "Nmm"};
  std::string lengths = "mm", without;  // a parameter that is left out
  int type = 2;
  std::vector<int> channels = {1, 2, 3, 4, 5, 6}, zero = {1, 0};
  std::vector<double> corners = {300, -200, 0, -300, -200, 0, -300, 200, 0, 300, 200, 0};
  std::vector<double> origin = {0, 0, -40}, calibration;
  bool bytes = false, polynomial = false;

  // Four sensors at (+-a, +-b), 700 N without shear.
  void MakeType3() {
    type = 3;
    raw = {0, 0, 0, 0, 455, 105, 245, 595};
    scale.assign(8, 0.5);
    units.assign(8, "N");
    channels = {1, 2, 3, 4, 5, 6, 7, 8};
    origin = {100, 150, -54};
  }
  void MakeType1() {
    type = 1;
    raw = {60, -40, 700, 50, -30, -200};
    units = {"N", "N", "N", "mm", "mm", "Nmm"};
  }
  void Scale(int first, int end, double by) {
    for (int c = first; c < end; ++c) scale[c] *= by;
  }

  std::string Content() const {
    HandmadeC3d file;
    const auto add = [this](const std::string& name, const auto& how) {
      if (name != without) how(name.c_str());
    };
    const int count = static_cast<int>(channels.size());
    file.raw = raw;
    file.floating = true;
    file.Text("UNITS", lengths);
    file.Group("ANALOG");
    file.Reals("SCALE", scale, {static_cast<int>(scale.size())});
    if (!units.empty()) file.Texts("UNITS", units, 6);
    file.Group("FORCE_PLATFORM");
    add("USED", [&](const char* name) { file.Integers(name, {1}, {}); });
    add("TYPE", [&](const char* name) { file.Integers(name, {type}, {1}); });
    add("ZERO", [&](const char* name) { file.Integers(name, zero, {2}); });
    add("CORNERS", [&](const char* name) { file.Reals(name, corners, {3, 4, 1}); });
    add("ORIGIN", [&](const char* name) { file.Reals(name, origin, {3, 1}); });
    if (bytes) file.Counts("CHANNEL", channels);
    if (!bytes)
      add("CHANNEL", [&](const char* name) { file.Integers(name, channels, {count, 1}); });
    if (!calibration.empty()) file.Reals("CAL_MATRIX", calibration, {6, 6, 1});
    if (polynomial) file.Reals("FPCOPPOLY", {1, 2}, {2});
    return file.Bytes();
  }
};

// With `says` alone it is an error; with a centre a warning, or nothing at all.
struct PlateCase {
  const char* name;
  void (*change)(PlateFile*);
  std::string says;
  double x_mm = std::numeric_limits<double>::quiet_NaN(), y_mm = 30.0;
};

class PlateFiles : public TempDirTest, public ::testing::WithParamInterface<PlateCase> {};

TEST_P(PlateFiles, AreReadOrNamed) {
  PlateFile described;
  GetParam().change(&described);
  // Its markers are read whatever the platform is.
  const C3dFile file = Unwrapped(ReadC3d(WriteText("a.c3d", described.Content())));
  EXPECT_EQ(file.num_frames(), 3);
  const LengthUnit unit = FromName<LengthUnit>(file.point_unit).value();
  const Result<PlatformRecord> read = EvaluatePlatform(file, 0, unit);
  if (std::isnan(GetParam().x_mm)) {
    EXPECT_TRUE(Contains(ProblemOf(read), "a.c3d: platform:1 " + GetParam().says));
    return;
  }
  const PlatformRecord record = Unwrapped(read);
  EXPECT_NEAR(record.force[2].z(), 700.0, 1e-3);
  EXPECT_NEAR(1e3 * record.centre[2].x(), GetParam().x_mm, 1e-2);
  EXPECT_NEAR(1e3 * record.centre[2].y(), GetParam().y_mm, 1e-2);
  if (GetParam().says.empty()) {
    EXPECT_TRUE(record.warnings.empty()) << record.warnings[0];
  } else {
    ASSERT_EQ(record.warnings.size(), 1u);
    EXPECT_TRUE(Contains(record.warnings[0], "platform:1 " + GetParam().says));
  }
}

const PlateCase kPlateCases[] = {
    {"as_it_is", [](PlateFile*) {}, "", 50},
    // Parameters that are missing or none.
    {"no_used", [](PlateFile* p) { p->without = "USED"; }, "is counted by TYPE: USED is missing",
     50},
    {"no_type", [](PlateFile* p) { p->without = "TYPE"; }, "has no TYPE; types 1 to 4 are known"},
    {"type_5", [](PlateFile* p) { p->type = 5; }, "has the TYPE 5; types 1 to 4 are known"},
    {"no_channel", [](PlateFile* p) { p->without = "CHANNEL"; }, "has 0 of 6 channels (CHANNEL)"},
    {"short_channel",
     [](PlateFile* p) {
       p->channels = {1, 2, 3};
     },
     "has 3 of 6 channels (CHANNEL)"},
    {"channel_0", [](PlateFile* p) { p->channels[0] = 0; },
     "names channel 0 (CHANNEL); the file has 1 to"},
    {"channel_7", [](PlateFile* p) { p->channels[5] = 7; },
     "names channel 7 (CHANNEL); the file has 1 to"},
    {"no_analog", [](PlateFile* p) { p->raw.clear(); },
     "names channel 1 (CHANNEL); the file has no ana"},
    {"no_corners", [](PlateFile* p) { p->without = "CORNERS"; }, "has no CORNERS"},
    {"flat", [](PlateFile* p) { p->corners.assign(12, 5.0); }, "has CORNERS that span no surface"},
    {"no_origin", [](PlateFile* p) { p->without = "ORIGIN"; }, "has no ORIGIN: centres are",
     53.4286, 32.2857},
    {"no_zero", [](PlateFile* p) { p->without = "ZERO"; }, "", 50},
    {"no_calibration", [](PlateFile* p) { p->type = 4; }, "has no CAL_MATRIX"},
    {"no_places",
     [](PlateFile* p) {
       p->MakeType3();
       p->without = "ORIGIN";
     },
     "has no distances of its sensors, a and b (ORIGIN)"},
    {"places_0",
     [](PlateFile* p) {
       p->MakeType3();
       p->origin = {0, 0, -54};
     },
     "has no distances of its sensors, a and b (ORIGIN)"},
    {"polynomial", [](PlateFile* p) { p->polynomial = true; }, "has FPCOPPOLY, a correction", 50},
    // Zeros.
    {"zero_beyond",
     [](PlateFile* p) {
       p->zero = {1, 2000};
     },
     "has the ZERO frames 1 to 2000, which", 50},
    {"zero_reversed",
     [](PlateFile* p) {
       p->zero = {3, 2};
     },
     "has the ZERO frames 3 to 2, which", 50},
    {"zero_loaded",
     [](PlateFile* p) {
       p->zero = {1, 2};
     },
     "has the ZERO frames 1 to 2, in which", 50},
    // Signs and numbers.
    {"byte_channels",
     [](PlateFile* p) {
       p->bytes = true;
       p->channels = {131, 132, 133, 134, 135, 136};
       p->raw.insert(p->raw.begin(), 130, 0);
       p->units.insert(p->units.begin(), 130, "");
       p->scale.assign(136, 1.0);
     },
     "", 50},
    {"origin_above",
     [](PlateFile* p) {
       p->origin = {0, 0, 40};
     },
     "", 50},
    {"origin_all_other",
     [](PlateFile* p) {
       p->origin = {-5, 3, 40};
     },
     "", 45, 27},
    {"type_3", [](PlateFile* p) { p->MakeType3(); }, "", 50},
    {"places_negative",
     [](PlateFile* p) {
       p->MakeType3();
       p->origin = {-100, -150, 54};
     },
     "", 50},
    // Units.
    {"kN",
     [](PlateFile* p) {
       p->units = {"kN", "kN", "kN", "kNm", "kNm", "kNm"};
       p->Scale(0, 3, 1e-3);
       p->Scale(3, 6, 1e-6);
     },
     "", 50},
    {"lbf",
     [](PlateFile* p) {
       p->units = {"lbf", "lbf", "lbf", "N.m", "N.m", "N.m"};
       p->Scale(0, 3, 1.0 / 4.44822);
       p->Scale(3, 6, 1e-3);
     },
     "", 50},
    {"newton_metres",
     [](PlateFile* p) {
       p->units = {"", "", "", "", "", ""};
       p->Scale(3, 6, 1e-3);
     },
     "has channels without a unit (ANALOG:UNITS), which are read as N and N m: N mm gives no", 50},
    {"newton_millimetres_in_m",
     [](PlateFile* p) {
       p->lengths = "m";
       p->units.clear();
       for (double& corner : p->corners) corner *= 1e-3;
       p->origin = {0, 0, -0.04};
     },
     "has channels without a unit (ANALOG:UNITS), which are read as N and N mm: N m gives no", 50},
    {"volts", [](PlateFile* p) { p->units.assign(6, "V"); },
     "has channels in V (ANALOG:UNITS), which", 50},
    {"all_in_N", [](PlateFile* p) { p->units.assign(6, "N"); }, "has channels in N (ANALOG:UNITS)",
     50},
    {"type_1", [](PlateFile* p) { p->MakeType1(); }, "", 50},
    {"centre_in_m",
     [](PlateFile* p) {
       p->MakeType1();
       p->units = {"N", "N", "N", "m", "m", "Nm"};
       p->Scale(3, 6, 1e-3);
     },
     "", 50},
    {"centre_in_m_unsaid",
     [](PlateFile* p) {
       p->MakeType1();
       p->units = {"N", "N", "N", "", "", ""};
       p->Scale(3, 6, 1e-3);
     },
     "has channels without a unit (ANALOG:UNITS), which are read as N and N m: N mm gives no", 50},
    {"volts_calibrated_to_Nm",
     [](PlateFile* p) {
       p->type = 4;
       p->units.assign(6, "V");
       p->calibration.assign(36, 0.0);
       for (int i = 0; i < 6; ++i) p->calibration[7 * i] = i < 3 ? 1.0 : 1e-3;
     },
     "has channels whose CAL_MATRIX names no unit (ANALOG:UNITS), which are read as N and N m: N "
     "mm gives no",
     50},
    {"corners_in_m",
     [](PlateFile* p) {
       for (double& corner : p->corners) corner *= 1e-3;
     },
     "has CORNERS of 0.0006 by 0.0004 m: are they in POINT:UNITS, 'mm'?"},
    {"origin_in_m",
     [](PlateFile* p) {
       p->origin = {0, 0, -0.04};
     },
     "has an ORIGIN of 4e-05 m: is it in", 53.4251, 32.2834},
};

INSTANTIATE_TEST_SUITE_P(Table, PlateFiles, ::testing::ValuesIn(kPlateCases),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace pushid
