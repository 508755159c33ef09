// datasets: force, centre of pressure and free moment of a force platform.
#include "datasets/sensors/force_platform.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "datasets/files/number_text.h"

namespace pushid {
namespace {

using Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// Metres in the length of a moment's unit ("Nmm", "N.m", "N*cm"), else in `unit`.
double MomentLength(const std::string& text, LengthUnit unit) {
  std::string letters;
  for (char c : text) {
    if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')) letters += c;
  }
  for (const LengthUnitRow& row : kLengthUnits) {
    if (EqualsIgnoringCase(letters, std::string("N") + row.name)) return MetresPer(row.value);
  }
  return MetresPer(unit);
}

class Platform {
 public:
  Platform(const C3dFile& file, const C3dPlatform& platform, LengthUnit unit)
      : file_(file), platform_(platform), metres_(MetresPer(unit)) {
    origin_ = metres_ * platform.origin;
    if (origin_.z() > 0.0) origin_.z() = -origin_.z();
    moment_metres_ = MomentLength(file.analog[platform.channels[5]].unit, unit);
    Baseline();
  }

  // Axes and centre; false when the corners span nothing.
  bool Place() {
    const auto corner = [this](int i) -> Vector3d { return metres_ * platform_.corners.col(i); };
    centre_ = 0.25 * (corner(0) + corner(1) + corner(2) + corner(3));
    const Vector3d x = corner(0) - corner(1), y = corner(0) - corner(3);
    const Vector3d z = x.cross(y);
    if (!(x.norm() > 1e-6 && y.norm() > 1e-6 && z.norm() > 1e-3 * x.norm() * y.norm())) {
      return false;
    }
    axes_.col(0) = x.normalized();
    axes_.col(2) = z.normalized();
    axes_.col(1) = axes_.col(2).cross(axes_.col(0));
    return true;
  }

  PlatformRecord Record() const {
    PlatformRecord record;
    record.rate_hz = file_.analog_rate_hz;
    record.normal = -axes_.col(2);
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    const std::size_t samples = file_.analog[platform_.channels[0]].samples.size();
    Vector3d impulse = Vector3d::Zero();
    for (std::size_t i = 0; i < samples; ++i) {
      Vector3d force, centre;  // in the platform's axes; the centre on its surface
      double free_moment = 0.0;
      Sample(i, &force, &centre, &free_moment);
      const bool pressed = std::fabs(force.z()) >= kPressed && centre.allFinite();
      record.force.push_back(axes_ * force);
      record.centre.push_back(pressed ? Vector3d(centre_ + axes_ * centre)
                                      : Vector3d::Constant(kNaN));
      // About z, which points inwards.
      record.free_moment.push_back(pressed ? -free_moment : 0.0);
      impulse += record.force.back();
    }
    if (impulse.dot(record.normal) < 0.0) {
      for (Vector3d& force : record.force) force = -force;
      for (double& moment : record.free_moment) moment = -moment;
    }
    return record;
  }

 private:
  double Raw(int channel, std::size_t sample) const {
    return file_.analog[platform_.channels[channel]].samples[sample] - baseline_[channel];
  }

  // The mean of the frames without load, where the file names some.
  void Baseline() {
    baseline_.assign(platform_.channels.size(), 0.0);
    const int first = file_.platform_zero_first, last = file_.platform_zero_last;
    if (first < 1 || last < first || last > file_.num_frames()) return;
    const int per_frame = file_.samples_per_frame();
    for (std::size_t c = 0; c < baseline_.size(); ++c) {
      const std::vector<double>& samples = file_.analog[platform_.channels[c]].samples;
      double sum = 0.0;
      for (int i = (first - 1) * per_frame; i < last * per_frame; ++i) sum += samples[i];
      baseline_[c] = sum / ((last - first + 1) * per_frame);
    }
  }

  // Force and moment at the centre of the surface, platform axes (types 2 to 4).
  void Wrench(std::size_t i, Vector3d* force, Vector3d* moment) const {
    if (platform_.type == 3) {
      const double fx12 = Raw(0, i), fx34 = Raw(1, i), fy14 = Raw(2, i), fy23 = Raw(3, i);
      const double fz1 = Raw(4, i), fz2 = Raw(5, i), fz3 = Raw(6, i), fz4 = Raw(7, i);
      const double a = metres_ * platform_.origin.x(), b = metres_ * platform_.origin.y();
      *force = {fx12 + fx34, fy14 + fy23, fz1 + fz2 + fz3 + fz4};
      const Vector3d at_sensors = {b * (fz1 + fz2 - fz3 - fz4), a * (-fz1 + fz2 + fz3 - fz4),
                                   b * (-fx12 + fx34) + a * (fy14 - fy23)};
      *moment = at_sensors + force->cross(Vector3d(0.0, 0.0, origin_.z()));
      return;
    }
    Vector6 wrench;
    for (int c = 0; c < 6; ++c) wrench[c] = Raw(c, i);
    if (platform_.type == 4) wrench = platform_.calibration * wrench;
    *force = wrench.head<3>();
    *moment = moment_metres_ * wrench.tail<3>() + force->cross(origin_);
  }

  void Sample(std::size_t i, Vector3d* force, Vector3d* centre, double* free_moment) const {
    if (platform_.type == 1) {
      *force = {Raw(0, i), Raw(1, i), Raw(2, i)};
      *centre = {metres_ * Raw(3, i), metres_ * Raw(4, i), 0.0};
      *free_moment = moment_metres_ * Raw(5, i);
      return;
    }
    Vector3d moment;
    Wrench(i, force, &moment);
    const double x = -moment.y() / force->z(), y = moment.x() / force->z();
    *centre = {x, y, 0.0};
    *free_moment = moment.z() - x * force->y() + y * force->x();
  }

  const C3dFile& file_;
  const C3dPlatform& platform_;
  double metres_, moment_metres_ = 1.0;
  Vector3d origin_, centre_;
  Eigen::Matrix3d axes_;
  std::vector<double> baseline_;  // per channel
};

}  // namespace

Result<PlatformRecord> EvaluatePlatform(const C3dFile& file, int platform, LengthUnit unit) {
  const int count = static_cast<int>(file.platforms.size());
  if (platform < 0 || platform >= count) {
    return Error{"there is no force platform " + std::to_string(platform + 1) + "; the file has " +
                     std::to_string(count),
                 file.path};
  }
  Platform evaluated(file, file.platforms[platform], unit);
  if (!evaluated.Place()) {
    return Error{
        "the corners of force platform " + std::to_string(platform + 1) + " span no surface",
        file.path};
  }
  return evaluated.Record();
}

}  // namespace pushid
