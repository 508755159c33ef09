// datasets: trajectories of named points, from whatever format.
#include "datasets/formats/point_motion.h"

#include <algorithm>
#include <limits>
#include <map>

#include "datasets/files/number_text.h"
#include "datasets/files/numeric_table.h"
#include "datasets/formats/c3d.h"
#include "datasets/formats/table_points.h"
#include "datasets/formats/trc.h"

namespace pushid {
namespace {

// The file's axis that the screen shows as up: "+Z" -> "+z"; empty when it is none.
std::string UpAxis(const std::string& screen_y) {
  if (screen_y.size() != 2 || (screen_y[0] != '+' && screen_y[0] != '-')) return "";
  const char axis = static_cast<char>(screen_y[1] | 0x20);
  return axis >= 'x' && axis <= 'z' ? std::string{screen_y[0], axis} : "";
}

Result<PointMotion> FromC3d(const std::string& path, const PointReadOptions& options) {
  Result<C3dFile> read = ReadC3d(path, {options.accept_truncated});
  if (!read.ok()) return read.error();
  C3dFile& file = read.value();
  PointMotion motion;
  motion.path = path;
  motion.rate_hz = file.point_rate_hz;
  motion.unit_text = file.point_unit;
  motion.unit = LengthUnitFromName(file.point_unit);
  motion.up = UpAxis(file.screen_y);
  motion.names = std::move(file.point_names);
  motion.content_hash = file.content_hash;
  if (options.choose) {
    Result<std::vector<int>> chosen = options.choose(motion.names);
    if (!chosen.ok()) return chosen.error();
    motion.chosen = std::move(chosen.value());
  } else {
    for (std::size_t i = 0; i < motion.names.size(); ++i) {
      motion.chosen.push_back(static_cast<int>(i));
    }
  }
  for (int index : motion.chosen) motion.positions.push_back(file.points[index]);
  return motion;
}

}  // namespace

std::optional<MotionFormat> MotionFormatOfFile(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  if (dot == std::string_view::npos) return std::nullopt;
  const std::string_view ending = path.substr(dot + 1);
  static const std::pair<const char*, MotionFormat> kEndings[] = {
      {"bvh", MotionFormat::kBvh},     {"c3d", MotionFormat::kC3d},
      {"trc", MotionFormat::kTrc},     {"csv", MotionFormat::kCsv},
      {"sto", MotionFormat::kStorage}, {"mot", MotionFormat::kStorage}};
  for (const auto& [name, format] : kEndings) {
    if (EqualsIgnoringCase(ending, name)) return format;
  }
  return std::nullopt;
}

Result<PointMotion> ReadPointMotion(const std::string& path, MotionFormat format,
                                    const PointReadOptions& options) {
  Result<PointMotion> motion = format == MotionFormat::kC3d ? FromC3d(path, options)
                               : format == MotionFormat::kTrc
                                   ? ReadTrc(path, options)
                                   : ReadTablePoints(path, format, options);
  if (!motion.ok()) return motion;
  if (motion.value().names.empty()) {
    return Error{"the file has no points" +
                     std::string(format == MotionFormat::kC3d
                                     ? ""
                                     : ": no three columns such as hip_x, hip_y, hip_z; name them "
                                       "in a mapping file"),
                 path};
  }
  return motion;
}

Error UnknownPointError(const std::string& path, const std::vector<std::string>& names,
                        const std::string& name) {
  constexpr std::size_t kListed = 8;
  std::string message = "there is no point " + Quoted(name) + "; it has ";
  for (std::size_t i = 0; i < names.size() && i < kListed; ++i) {
    message += (i > 0 ? ", " : "") + names[i];
  }
  if (names.size() > kListed) message += ", ... (" + std::to_string(names.size()) + " points)";
  return {message, path};
}

}  // namespace pushid
