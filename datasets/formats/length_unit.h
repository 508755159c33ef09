// datasets: the unit of lengths in a file. Inside the program lengths are metres; other units live
// only in readers and writers.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace pushid {

// In a metre. A float is exact here, and scales floats as floats, doubles as doubles.
inline constexpr float kMillimetres = 1e3f;

enum class LengthUnit { kMillimetre, kCentimetre, kMetre };

// Metres in one unit: 0.001, 0.01 or 1.
double MetresPer(LengthUnit unit);

// "mm", "cm" or "m", as manifests and --length_unit spell them.
std::string Name(LengthUnit unit);

// The inverse of Name; also of longer and capital spellings ("Metres"). nullopt for other texts.
std::optional<LengthUnit> LengthUnitFromName(std::string_view name);

// What is wrong with a length_scale, the metres that a file's 1 stands for, where that is no unit:
// "is 0; it must ..."; empty where it is fine.
std::string LengthScaleProblem(double metres);

// "mm", or "0.0564 m each" where it is no unit.
std::string LengthText(double metres_per_unit);

// `value` given in `from`, expressed in `to`; exact (no rounding at all) when the two are the same.
double ConvertLength(double value, LengthUnit from, LengthUnit to);

}  // namespace pushid
