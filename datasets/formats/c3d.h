// datasets: C3D files (c3d.org's public format): trajectories of markers, analog channels and force
// platforms in one binary file. Events are not read.
//
//   Result<C3dFile> file = ReadC3d("trial.c3d");
//   file.value().points[0][frame]   // of point_names[0], in point_unit
//
// Poses of segments (group ROTATION, as markerless systems write them) become points: each
// segment's origin, under its name.
//
// Three processors wrote them (Intel, DEC with VAX floats, MIPS big-endian), with points and
// samples as scaled 16-bit integers or as floats; all six are read. The reader is
// strict: what points outside the file, contradicts itself or is cut short is an Error with the
// byte it stands at.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/point_motion.h"
#include "models/enum_names.h"

namespace pushid {

// The numbers are those in the file.
enum class C3dProcessor { kIntel = 84, kDec = 85, kMips = 86 };
constexpr EnumNames<C3dProcessor, 3> Names(C3dProcessor) {
  return {{{"Intel", C3dProcessor::kIntel},
           {"DEC", C3dProcessor::kDec},
           {"MIPS", C3dProcessor::kMips}}};
}

// Numbers in the bytes of a C3D file, as the three processors store them.
//
// Intel: little-endian integers and IEEE floats. MIPS: the same, big-endian. DEC: little-endian
// integers, VAX F floats: two little-endian words, the upper one first, value
// (0x800000 | fraction) 2^(exponent - 152), zero when the exponent is zero.

inline constexpr int kVaxBias = 128, kFractionBits = 24;
inline constexpr std::size_t kC3dBlock = 512;  // bytes; the sections of a file begin with one

class C3dBytes {
 public:
  C3dBytes() = default;
  C3dBytes(std::string_view bytes, C3dProcessor processor) : bytes_(bytes), processor_(processor) {}

  std::size_t size() const { return bytes_.size(); }
  bool Has(std::size_t at, std::size_t count) const {
    return at <= bytes_.size() && count <= bytes_.size() - at;
  }
  // The accessors below need Has().
  std::uint8_t Byte(std::size_t at) const { return static_cast<std::uint8_t>(bytes_[at]); }
  std::int8_t Signed(std::size_t at) const { return static_cast<std::int8_t>(bytes_[at]); }
  std::uint16_t Word(std::size_t at) const;
  std::int16_t Integer(std::size_t at) const { return static_cast<std::int16_t>(Word(at)); }
  double Real(std::size_t at) const;
  std::string_view Text(std::size_t at, std::size_t count) const {
    return bytes_.substr(at, count);
  }

 private:
  std::string_view bytes_;
  C3dProcessor processor_ = C3dProcessor::kIntel;
};

enum class C3dType { kText = -1, kByte = 1, kInteger = 2, kReal = 4 };  // as the file has them

// One entry of the parameter section, GROUP:NAME. First dimension fastest.
struct C3dParameter {
  std::string group, name;
  std::vector<int> dimensions;     // empty for a single value
  std::vector<double> numbers;     // bytes (unsigned), integers (signed) and reals
  std::vector<std::string> texts;  // kText: one per string, blanks at the end cut off
};

// All parameters, looked up as GROUP:NAME whatever their case.
struct C3dParameters {
  std::vector<C3dParameter> list;

  const C3dParameter* Find(std::string_view group, std::string_view name) const;  // or null
  // The number at `index`, or `fallback`.
  double Number(std::string_view group, std::string_view name, std::size_t index,
                double fallback) const;
  // Number as a whole one from `lowest` to `highest`; `fallback` for anything else.
  int Whole(std::string_view group, std::string_view name, std::size_t index, int lowest,
            int highest, int fallback) const;
  // Numbers, or texts, and those of NAME2, NAME3, ... which files use beyond 255 entries.
  std::vector<double> Numbers(std::string_view group, const std::string& name) const;
  std::vector<std::string> Texts(std::string_view group, const std::string& name) const;
};

// The place of a force platform and the channels it fills, as the file has them, right or wrong;
// what it does not say is NaN, no channels, or type 0 (evaluated, and judged, by force_sensors.h).
struct C3dPlatform {
  int type = 2;
  std::vector<int> channels;  // indices into the analog channels, from 0
  Eigen::Matrix<double, 3, 4> corners = Eigen::Matrix<double, 3, 4>::Zero();          // point unit
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();                                   // point unit
  Eigen::Matrix<double, 6, 6> calibration = Eigen::Matrix<double, 6, 6>::Identity();  // type 4
};

struct C3dAnalogChannel {
  std::string name, unit;
  std::vector<double> samples;  // in `unit`, scales and offsets applied
};

struct C3dFile {
  std::string path;
  C3dProcessor processor = C3dProcessor::kIntel;
  bool floating = true;        // points and samples are floats in the file
  int first_frame = 1;         // of the recording this was cut from, as the file counts
  int announced_frames = 0;    // more than num_frames() when the file is cut short
  double point_rate_hz = 0.0;  // frames per second
  double analog_rate_hz = 0.0;
  std::string point_unit;          // POINT:UNITS, "mm" as a rule; may be empty
  std::string screen_x, screen_y;  // POINT:X_SCREEN, Y_SCREEN, "+X" and "+Z" as a rule
  std::vector<std::string> point_names;
  std::vector<std::vector<Eigen::Vector3d>> points;  // [point][frame]; NaN where it was not seen
  int frames_without_points = 0;                     // how many there are, where `points` is empty
  std::vector<C3dAnalogChannel> analog;
  std::vector<C3dPlatform> platforms;
  int platform_zero_first = 0, platform_zero_last = 0;  // frames from 1 without load; 0: none
  C3dParameters parameters;                             // everything, as it stands
  std::string content_hash;

  int num_frames() const {
    return points.empty() ? frames_without_points : static_cast<int>(points[0].size());
  }
  int samples_per_frame() const;
};

// accept_truncated: of a file that ends before its last announced frame the whole frames that are
// there are taken, instead of refusing it. For looking at what a file holds.
Result<C3dFile> ReadC3d(const std::string& path, bool accept_truncated = false);

// The points of a C3D file. Errors are those of ReadC3d, and of the choice.
Result<PointMotion> PointsOfC3d(const C3dFile& file, const PointReadOptions& options = {});
Result<PointMotion> ReadC3dPoints(const std::string& path, const PointReadOptions& options = {});

}  // namespace pushid
