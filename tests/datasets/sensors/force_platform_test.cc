// Force platforms: the same known load through the channels of all four types.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "datasets/sensors/force_sensors.h"
#include "models/decompositions.h"
#include "tests/datasets/c3d_samples.h"
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
  // On the platform +2 N m about z, which points down: on the person the opposite about down, that
  // is the same about up.
  EXPECT_NEAR(record.free_moment[7], load.free_moment, 1e-9);
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

TEST(ForcePlatformTest, Errors) {
  C3dFile file = SampleC3d();
  EXPECT_TRUE(Contains(EvaluatePlatform(file, 1, LengthUnit::kMillimetre).error().ToString(),
                       "there is no force platform 2; the file has 1"));
  file.platforms[0].corners.setZero();
  EXPECT_TRUE(Contains(EvaluatePlatform(file, 0, LengthUnit::kMillimetre).error().ToString(),
                       "span no surface"));
}

}  // namespace
}  // namespace pushid
