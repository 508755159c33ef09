// What a person pushed by others does afterwards: values by hand, derivatives by Jets in three
// regimes, and that it dies out.
#include "models/drive.h"

#include <ceres/jet.h>

#include "tests/models/model_samples.h"

namespace pushid {
namespace {

// By drive_gain, drive_torque and drive_time.
using DriveJet = ceres::Jet<double, 3>;

ParameterSet<DriveJet> Jets(const ParameterSet<double>& p) {
  ParameterSet<DriveJet> jets;
  for (int i = 0; i < kNumParameters; ++i) jets[i] = DriveJet(p[i]);
  jets[kDriveGain].v[0] = jets[kDriveTorque].v[1] = jets[kDriveTime].v[2] = 1.0;
  return jets;
}

TEST(Drive, ForceAndItsDerivatives) {
  Random random(3);
  for (double size : {0.0, 1e-8, 500.0}) {  // N and N m lately received
    for (int trial = 0; trial < 20; ++trial) {
      const ParameterSet<double> p = RandomParameters(&random);
      const Vector4<double> lately = RandomVector(&random, size);
      const Vector4<DriveJet> force = DriveForce<DriveJet>(Jets(p), lately.cast<DriveJet>());
      for (int row = 0; row < 4; ++row) {
        const int own = row < 2 ? 0 : 1;
        EXPECT_EQ(force[row].a, p[row < 2 ? kDriveGain : kDriveTorque] * lately[row]);
        EXPECT_EQ(force[row].v[own], lately[row]);
        EXPECT_EQ(force[row].v[1 - own], 0.0);
        EXPECT_EQ(force[row].v[2], 0.0);
      }
      const Vector4<double> plain = DriveForce<double>(p, lately);
      for (int row = 0; row < 4; ++row) EXPECT_EQ(plain[row], force[row].a);
    }
  }
}

// d w'/d tau = m dt / tau^2 (w - F), m = exp(-dt / tau): what the fit's sensitivities use.
TEST(Drive, MemoryAndItsDerivativeByTheTime) {
  Random random(4);
  for (double size : {0.0, 1e-8, 500.0}) {
    for (int trial = 0; trial < 20; ++trial) {
      const ParameterSet<double> p = RandomParameters(&random);
      const Vector4<double> lately = RandomVector(&random, size), now = RandomVector(&random, size);
      const Vector4<DriveJet> next =
          NextReceived<DriveJet>(Jets(p), lately.cast<DriveJet>(), now.cast<DriveJet>(), kSampleDt);
      const double memory = std::exp(-kSampleDt / p[kDriveTime]);
      const double slope = memory * kSampleDt / (p[kDriveTime] * p[kDriveTime]);
      for (int row = 0; row < 4; ++row) {
        EXPECT_NEAR(next[row].a, now[row] + memory * (lately[row] - now[row]), 1e-12 * size);
        EXPECT_NEAR(next[row].v[2], slope * (lately[row] - now[row]), 1e-12 * size);
      }
    }
  }
}

TEST(Drive, DiesOutOnceContactEnds) {
  ParameterSet<double> p{};
  p[kDriveGain] = 0.5, p[kDriveTorque] = 0.2, p[kDriveTime] = 0.3;
  Vector4<double> lately(100.0, -20.0, 50.0, 10.0);
  const double before = DriveForce(p, lately).norm();
  for (int frame = 0; frame < 60; ++frame) {
    lately = NextReceived<double>(p, lately, Vector4<double>::Zero(), kSampleDt);
  }
  EXPECT_NEAR(DriveForce(p, lately).norm(), before * std::exp(-1.0 / 0.3), 1e-9);
}

}  // namespace
}  // namespace pushid
