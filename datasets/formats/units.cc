// datasets: units, axes and frame rates.
#include "datasets/formats/units.h"

#include <Eigen/Geometry>
#include <cmath>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

// The unit vector of "z", "+x", "-Y"; zero when the text is no axis.
Eigen::Vector3d AxisVector(const std::string& text) {
  const bool has_sign = !text.empty() && (text[0] == '+' || text[0] == '-');
  const std::string letter = has_sign ? text.substr(1) : text;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    if (EqualsIgnoringCase(letter, std::string(1, "xyz"[i]))) axis[i] = text[0] == '-' ? -1.0 : 1.0;
  }
  return axis;
}

}  // namespace

template <>
std::optional<LengthUnit> FromName<LengthUnit>(std::string_view name) {
  name = Trimmed(name);
  for (const LengthUnitRow& row : kLengthUnits) {
    if (EqualsIgnoringCase(name, row.name)) return row.value;
    for (const char* word : {"meter", "metre", "meters", "metres"}) {
      if (EqualsIgnoringCase(name, StrCat(row.prefix, word))) return row.value;
    }
  }
  return std::nullopt;
}

std::optional<LengthUnit> UnitThatGives(double files_length, double shortest, double longest) {
  for (const LengthUnitRow& row : kLengthUnits) {
    const double length = files_length * MetresPer(row.value);
    if (length >= shortest && length <= longest) return row.value;
  }
  return std::nullopt;
}

std::string LengthScaleProblem(double metres) {
  constexpr double kSmallest = 1e-6, kLargest = 1e3;  // m; a micrometre, a kilometre
  if (metres >= kSmallest && metres <= kLargest) return "";
  return "is " + Rounded(metres) + "; it must be the metres of one file unit, from " +
         Rounded(kSmallest) + " to " + Rounded(kLargest);
}

std::optional<double> GivenLength::Metres() const {
  if (length_scale || !length_unit) return length_scale;
  return MetresPer(*length_unit);
}

Result<GivenLength> ChooseLength(const std::string& before, const std::string& unit, double scale) {
  return Caught([&] {
    GivenLength given;
    if (scale != 0.0) {
      if (!unit.empty()) {
        throw Error{before + "length_scale is given together with " + before +
                    "length_unit; give one of them"};
      }
      const std::string problem = LengthScaleProblem(scale);
      if (!problem.empty()) throw Error{before + "length_scale " + problem};
      given.length_scale = scale;
    }
    if (!unit.empty())
      OrThrow(ParseName(before + "length_unit", unit, &given.length_unit.emplace()));
    return given;
  });
}

std::string LengthText(double metres_per_unit) {
  for (const LengthUnitRow& row : kLengthUnits) {
    if (metres_per_unit == MetresPer(row.value)) return row.name;
  }
  return Rounded(metres_per_unit) + " m each";
}

Result<Eigen::Matrix3d> AxesRotation(const std::string& up, const std::string& forward) {
  const Eigen::Vector3d z = AxisVector(up);
  const Eigen::Vector3d x = AxisVector(forward);
  if (z.isZero() || x.isZero()) {
    return Error{(z.isZero() ? "up is " + Quoted(up) : "forward is " + Quoted(forward)) +
                     ", not an axis like z, +x or -y",
                 "", 0};
  }
  if (std::abs(z.dot(x)) > 0.5) {
    return Error{"up (" + up + ") and forward (" + forward +
                     ") lie along the same axis; give both, up and forward",
                 "", 0};
  }
  Eigen::Matrix3d rotation;
  rotation << x.transpose(), z.cross(x).transpose(), z.transpose();
  return rotation;
}

Eigen::Matrix3d AxesGiven(const std::string& up, const std::string& forward) {
  return OrThrow(AxesRotation(up.empty() ? "z" : up, forward.empty() ? "x" : forward));
}

std::string FrameRateProblem(double fps) {
  if (fps >= kMinFramesPerSecond && fps <= kMaxFramesPerSecond) return "";
  return "is " + Rounded(fps) + "; accepted are " + Rounded(kMinFramesPerSecond) + " to " +
         Rounded(kMaxFramesPerSecond) + " frames per second";
}

double WholeFrameRate(double fps) {
  constexpr double kRounding = 1.1e-3;  // a frame time of 0.0333 s is that of 30.03
  constexpr double kVideo = 1.0 / 1.001;
  const double whole = std::round(fps);
  if (!(whole > 0.0) || std::fabs(fps / whole - 1.0) > kRounding) return fps;
  const bool is_video = std::fabs(fps - kVideo * whole) < std::fabs(fps - whole);
  return is_video ? fps : whole;
}

}  // namespace pushid
