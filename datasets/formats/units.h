// datasets: units of length, axes and frame rates of files. Inside the program lengths are metres,
// z is up and x forward; other units live only in readers and writers.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

#include "datasets/files/error.h"
#include "models/enum_names.h"

namespace pushid {

// Units in a metre. A float is exact here, and scales floats as floats, doubles as doubles.
inline constexpr float kMillimetres = 1e3f;

enum class LengthUnit { kMillimetre, kCentimetre, kMetre };

// Everything that programs, messages and files know of a unit: a new one is a value and a row.
struct LengthUnitRow {
  const char* name;  // as manifests and --length_unit spell it
  LengthUnit value;
  double per_metre;    // so many in a metre: whole, so that conversions round once
  const char* prefix;  // before "metre", "meters", ..., whatever the case
};
inline constexpr LengthUnitRow kLengthUnits[] = {{"mm", LengthUnit::kMillimetre, 1e3, "milli"},
                                                 {"cm", LengthUnit::kCentimetre, 1e2, "centi"},
                                                 {"m", LengthUnit::kMetre, 1.0, ""}};
constexpr const auto& Names(LengthUnit) { return kLengthUnits; }
static_assert(RowsAreInOrder(kLengthUnits), "RowOf finds a row by its value");

// Metres in one unit: 0.001, 0.01 or 1.
inline double MetresPer(LengthUnit unit) { return 1.0 / RowOf(unit).per_metre; }

// Reads longer and capital spellings too ("Metres").
template <>
std::optional<LengthUnit> FromName<LengthUnit>(std::string_view name);

// The first unit in which a file's length lies between two others, m; nullopt: in none.
std::optional<LengthUnit> UnitThatGives(double files_length, double shortest, double longest);

// The end of a message about a length_scale (metres in the file's unit of length) that is none: "is
// 0; it must ..."; empty where it is fine.
std::string LengthScaleProblem(double metres);

// The lengths of files, by somebody who need not believe them: a unit, or instead of one the metres
// in one of the files' lengths. Neither: not said.
struct GivenLength {
  std::optional<LengthUnit> length_unit;
  std::optional<double> length_scale;

  // In one of the files' lengths; nullopt: not said.
  std::optional<double> Metres() const;
};

// By a unit's name and a scale, of which one is "" or 0. Errors: both; an invalid one. before: "--"
// where they are flags.
Result<GivenLength> ChooseLength(const std::string& before, const std::string& unit, double scale);

// "mm", or "0.0564 m each" where it is no unit.
std::string LengthText(double metres_per_unit);

// Axes of a file turned to the project's: x forward, y left, z up.

// The rotation that takes a file's coordinates to the project's, from the file's axes that point up
// and forward ("z", "+x", "-y", upper or lower case). Its rows are forward, up x forward and up.
// Error (without a place): not an axis, or both along the same line.
Result<Eigen::Matrix3d> AxesRotation(const std::string& up, const std::string& forward);
// The rotation of axes that may be left out, which are z and x then; throws the Error.
Eigen::Matrix3d AxesGiven(const std::string& up, const std::string& forward);

// Frame rates that files and manifests may give.

constexpr double kMinFramesPerSecond = 1.0;
constexpr double kMaxFramesPerSecond = 10000.0;

// "is 0; accepted are 1 to 10000 frames per second", or "" where the rate is accepted.
std::string FrameRateProblem(double fps);

// The rate that a file most likely means: the next whole number within 0.1 %, because files round
// their frame time (0.016667 s for 1/60 s). Rates of video, which lie 0.1 % below a whole number
// (60/1.001), and all others stay as they are.
double WholeFrameRate(double fps);

}  // namespace pushid
