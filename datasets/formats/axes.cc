// datasets: axes of a file turned to the project's.
#include "datasets/formats/axes.h"

#include <Eigen/Geometry>
#include <cmath>

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
  rotation.row(0) = x;
  rotation.row(1) = z.cross(x);
  rotation.row(2) = z;
  return rotation;
}

}  // namespace pushid
