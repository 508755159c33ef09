// datasets: force sensors in any file: CSV of the two forms in force_csv.h, a column or three of
// another CSV or an OpenSim storage file, an analog channel or a force platform of a C3D file.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/c3d.h"
#include "datasets/formats/force_csv.h"
#include "datasets/formats/units.h"
#include "datasets/manifest/recording.h"

namespace pushid {

// One sensor, and how it pushes.
struct SensorChoice {
  std::string file;
  // The part of the file: empty for a CSV time,force or time,fx,fy,fz; a column's name, or the
  // common part of three (ground_force_v for ground_force_vx, ..._vy, ..._vz); an analog channel;
  // or platform:1, counted from 1.
  std::string column;
  // N per unit of the column; negative where it counts the other way. Unset: 1, or the N in the
  // unit that a C3D file gives its channel, or the name of a column ends with ("Force (kN)").
  std::optional<double> gain;
  // Reading of a sensor of one number at rest, N; unset: what it reads before the pull.
  std::optional<double> zero_n;
  // Axes of the file that point up and forward, for forces that are vectors; empty: z and x.
  std::string up, forward;
  // The rest is what PushFromSensor needs.
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  double height_fraction = 1.0;
  std::optional<double> height_m;
  std::optional<double> start_s;  // its clock at frame 0; unset: 0
  double idle_force = 0.0;        // N
};

// Newtons, or newton metres, in one of a file's unit ("kN", "N.mm"); nullopt: it is no such unit.
std::optional<double> NewtonsIn(std::string_view unit, bool moment = false);
// Newtons in the unit of a column by its name, "Force (kN)"; 1 where it names none.
double NewtonsInColumn(const std::string& name);

// Sets what the choice lacks, clock at frame 0 and axes, where the sensor was recorded in the file
// of the person's motion.
void FillFromMotion(const RecordedPerson& person, SensorChoice* choice);

// Errors besides those of the files' readers: no such column, channel or platform (some that exist
// are listed), missing values, uneven times, a channel of a C3D file whose unit is no force.
// warnings: those of a platform are appended.
Result<SensorRecord> ReadSensor(const SensorChoice& choice,
                                std::vector<std::string>* warnings = nullptr);

// Subtracts what a sensor reads before the pull: the median of its samples there. Sets `subtracted`
// (zero where the reading is as likely noise about zero) and `noise`. Nothing where the record
// begins with the pull (within 0.1 s) or reads 0.3 of its peak before: that is a load, and no zero.
void SubtractRest(SensorRecord* record);

// Several sensors that push together:
//   [{"file": "left.csv", "height": 0.8}, {"file": "trial.c3d", "column": "rod", "gain": -250,
//     "direction": [1, 0, 0], "height_m": 1.1, "start": 0.2, "idle_force": 3}]
// Files are relative to the list. Also up and forward.
Result<std::vector<SensorChoice>> ReadSensorList(const std::string& path);

// Measurements of a force platform of a C3D file: force and centre of pressure.
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
// negative; ORIGIN with a positive one is from the surface to the sensors, and negated as a whole).
// Centre of pressure (-My/Fz, Mx/Fz). Axes from the corners 1 (+x, +y), 2 (-x, +y), 3 (-x, -y), 4
// (+x, -y). Of type 3, a and b are taken without their sign.
struct PlatformRecord {
  double rate_hz = 0.0;
  // The force on the person at each sample, in the file's axes: programs store either it or its
  // reaction, but a platform can only be pressed, never pulled, so the sign is the one that makes
  // the impulse point out of the surface.
  std::vector<Eigen::Vector3d> force;  // N
  // Points on the surface; NaN where the platform is pressed with less than kPressed.
  std::vector<Eigen::Vector3d> centre;                // m
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // out of the surface
  std::string outside;  // a sentence where most centres lie beyond the corners by kOffPlate
  std::vector<std::string> warnings;  // "platform:1 has no ORIGIN; ..."
};

// Less than this many newtons say nothing about where the platform is pressed.
inline constexpr double kPressed = 10.0;

inline constexpr double kOffPlate = 0.02;  // m beyond the edge, of most frames: a wrong one

// platform: from 0. unit: of the file's lengths. Forces and moments are in the units of their
// channels (N, kN, lbf, kgf; times mm, cm, m); moments without a unit in N times the file's unit of
// length, or in N mm or N m where only that puts the centre on the platform (a warning). Errors: no
// such platform; one whose TYPE, CHANNEL, CORNERS, CAL_MATRIX (type 4) or ORIGIN (type 3) is
// missing or none; corners that span no surface; samples that are not finite.
Result<PlatformRecord> EvaluatePlatform(const C3dFile& file, int platform, LengthUnit unit);

}  // namespace pushid
