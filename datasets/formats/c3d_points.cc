// datasets: the points of a C3D file.
#include "datasets/formats/c3d_points.h"

#include <utility>

#include "datasets/formats/c3d.h"

namespace pushid {
namespace {

// The file's axis that the screen shows as up: "+Z" -> "+z"; empty when it is none.
std::string UpOfScreen(const std::string& screen_y) {
  if (screen_y.size() != 2 || (screen_y[0] != '+' && screen_y[0] != '-')) return "";
  const char axis = static_cast<char>(screen_y[1] | 0x20);
  return axis >= 'x' && axis <= 'z' ? std::string{screen_y[0], axis} : "";
}

}  // namespace

Result<PointMotion> ReadC3dPoints(const std::string& path, const PointReadOptions& options) {
  Result<C3dFile> read = ReadC3d(path, {options.accept_truncated});
  if (!read.ok()) return read.error();
  C3dFile& file = read.value();
  PointMotion motion;
  motion.path = path;
  motion.rate_hz = file.point_rate_hz;
  motion.unit_text = file.point_unit;
  motion.unit = LengthUnitFromName(file.point_unit);
  motion.up = UpOfScreen(file.screen_y);
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

}  // namespace pushid
