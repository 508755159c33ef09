// datasets: what a force platform of a C3D file measured: force, centre of pressure, free moment.
//
// The four types of the C3D manual differ in what the channels are:
//   1  Fx Fy Fz Px Py Tz          centre of pressure measured
//   2  Fx Fy Fz Mx My Mz          force and moment
//   3  Fx12 Fx34 Fy14 Fy23 Fz1 Fz2 Fz3 Fz4    four sensors at (+-a, +-b), [a, b, az0] = ORIGIN:
//        Mx = b (Fz1 + Fz2 - Fz3 - Fz4), My = a (-Fz1 + Fz2 + Fz3 - Fz4),
//        Mz = b (-Fx12 + Fx34) + a (Fy14 - Fy23)
//   4  as 2 after [F, M] = CAL_MATRIX channels
// In the platform's axes, at the centre of its surface: M_s = M + F x ORIGIN (ORIGIN: from the
// sensors' origin to the surface; type 3: [0, 0, az0]; z points into the platform, so ORIGIN_z is
// negative, and a positive one is taken as negative). Centre of pressure (-My/Fz, Mx/Fz), free
// moment Tz = Mz - x Fy + y Fx. Axes from the corners 1 (+x, +y), 2 (-x, +y), 3 (-x, -y), 4 (+x,
// -y).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/c3d.h"
#include "datasets/formats/units.h"

namespace pushid {

struct PlatformRecord {
  double rate_hz = 0.0;
  // Per sample, in the file's axes. The force on the person: programs store either it or its
  // reaction, but a platform can only be pressed, never pulled, so the sign is the one that makes
  // the impulse point out of the surface.
  std::vector<Eigen::Vector3d> force;  // N
  // Points on the surface; NaN where the platform is pressed with less than kPressed.
  std::vector<Eigen::Vector3d> centre;                // m
  std::vector<double> free_moment;                    // N m on the person, about the outward normal
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // out of the surface
};

// Less than this many newtons say nothing about where the platform is pressed.
inline constexpr double kPressed = 10.0;

// platform: from 0. unit: of the file's lengths; moments count in N mm where the channel's unit
// does not say (Nm, Nmm) and the lengths are mm. Errors: no such platform, corners that span no
// surface.
Result<PlatformRecord> EvaluatePlatform(const C3dFile& file, int platform, LengthUnit unit);

}  // namespace pushid
