// datasets: the unit of lengths in a file.
#include "datasets/formats/length_unit.h"

#include <utility>

#include "datasets/files/number_text.h"

namespace pushid {
namespace {

// Integers, so that conversions round once: x / 1000 is the double nearest to the true quotient.
double UnitsPerMetre(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::kMillimetre:
      return 1000.0;
    case LengthUnit::kCentimetre:
      return 100.0;
    case LengthUnit::kMetre:
      break;
  }
  return 1.0;
}

}  // namespace

double MetresPer(LengthUnit unit) { return 1.0 / UnitsPerMetre(unit); }

std::string Name(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::kMillimetre:
      return "mm";
    case LengthUnit::kCentimetre:
      return "cm";
    case LengthUnit::kMetre:
      break;
  }
  return "m";
}

std::optional<LengthUnit> LengthUnitFromName(std::string_view name) {
  name = Trimmed(name);
  const std::pair<const char*, LengthUnit> prefixes[] = {{"milli", LengthUnit::kMillimetre},
                                                         {"centi", LengthUnit::kCentimetre},
                                                         {"", LengthUnit::kMetre}};
  for (const auto& [prefix, unit] : prefixes) {
    if (EqualsIgnoringCase(name, Name(unit))) return unit;
    for (const char* metre : {"meter", "metre", "meters", "metres"}) {
      if (EqualsIgnoringCase(name, std::string(prefix) + metre)) return unit;
    }
  }
  return std::nullopt;
}

std::string LengthScaleProblem(double metres) {
  constexpr double kSmallest = 1e-6, kLargest = 1e3;  // m; a micrometre, a kilometre
  if (metres >= kSmallest && metres <= kLargest) return "";
  return "is " + Rounded(metres) + "; it must be the metres of one file unit, from " +
         Rounded(kSmallest) + " to " + Rounded(kLargest);
}

std::string LengthText(double metres_per_unit) {
  for (LengthUnit unit : {LengthUnit::kMillimetre, LengthUnit::kCentimetre, LengthUnit::kMetre}) {
    if (metres_per_unit == MetresPer(unit)) return Name(unit);
  }
  return Rounded(metres_per_unit) + " m each";
}

double ConvertLength(double value, LengthUnit from, LengthUnit to) {
  if (from == to) return value;
  // The ratio is a power of ten: multiply or divide by whichever is a whole number.
  const double ratio = UnitsPerMetre(to) / UnitsPerMetre(from);
  return ratio >= 1.0 ? value * ratio : value / (UnitsPerMetre(from) / UnitsPerMetre(to));
}

}  // namespace pushid
