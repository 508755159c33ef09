// Tests: C3D files written, of all three processors, with points and samples as integers or floats.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "datasets/files/atomic_file.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/c3d.h"

namespace pushid {

inline std::uint32_t ToVax(double value) {
  int exponent = 0;
  const double half = std::frexp(std::fabs(value), &exponent);  // in [0.5, 1)
  auto fraction = static_cast<std::uint32_t>(std::lround(std::ldexp(half, kFractionBits)));
  if (fraction >> kFractionBits != 0) {  // rounded up to 1
    fraction >>= 1;
    ++exponent;
  }
  if (value == 0.0 || exponent + kVaxBias < 1) return 0;
  return (std::signbit(value) ? 0x80000000u : 0u) |
         static_cast<std::uint32_t>(exponent + kVaxBias) << 23 | (fraction & 0x7fffff);
}

inline void AppendByte(std::uint32_t value, std::string* out) {
  out->push_back(static_cast<char>(value & 0xff));
}

inline void AppendC3dWord(std::uint16_t value, C3dProcessor processor, std::string* out) {
  const bool big = processor == C3dProcessor::kMips;
  AppendByte(big ? value >> 8 : value, out);
  AppendByte(big ? value : value >> 8, out);
}

// Rounded to the 24 bits that every processor keeps; DEC has no infinity and no NaN, so the caller
// writes none.
inline void AppendC3dReal(double value, C3dProcessor processor, std::string* out) {
  std::uint32_t bits = 0;
  if (processor == C3dProcessor::kDec) {
    bits = ToVax(value);
  } else {
    const float rounded = static_cast<float>(value);
    std::memcpy(&bits, &rounded, sizeof bits);
  }
  const bool upper_first = processor != C3dProcessor::kIntel;
  const auto upper = static_cast<std::uint16_t>(bits >> 16),
             lower = static_cast<std::uint16_t>(bits & 0xffff);
  AppendC3dWord(upper_first ? upper : lower, processor, out);
  AppendC3dWord(upper_first ? lower : upper, processor, out);
}

inline constexpr double kLargestInteger = 32000.0;
inline constexpr std::size_t kLongestName = 127;
inline constexpr std::size_t kMostEntries = 255;  // of one dimension

inline std::string WritingProblem(const C3dFile& file) {
  const std::size_t frames = file.num_frames();
  if (frames < 1 || frames > 65535) return "it has " + std::to_string(frames) + " frames";
  if (file.point_names.size() != file.points.size()) return "not every point has a name";
  if (file.points.size() > 2 * kMostEntries || file.analog.size() > 2 * kMostEntries ||
      file.platforms.size() > kMostEntries) {
    return "it has too many points, channels or platforms";
  }
  if (!(file.point_rate_hz > 0.0)) return "its frame rate is not above 0";
  for (std::size_t i = 0; i < file.points.size(); ++i) {
    if (file.points[i].size() != frames) return "its tracks differ in length";
    if (file.point_names[i].size() > kLongestName) return "the name of a point is too long";
  }
  for (const C3dAnalogChannel& channel : file.analog) {
    if (channel.samples.size() != file.analog[0].samples.size() ||
        channel.samples.size() % frames != 0 || channel.samples.empty()) {
      return "channel " + Quoted(channel.name) + " has " + std::to_string(channel.samples.size()) +
             " samples for " + std::to_string(frames) + " frames";
    }
    if (channel.name.size() > kLongestName) return "the name of a channel is too long";
    for (double sample : channel.samples) {
      if (!std::isfinite(sample)) return "a sample of " + Quoted(channel.name) + " is not finite";
    }
  }
  return "";
}

// Rounded up to a whole number of 512-byte blocks.
inline void FillBlock(std::string* bytes) {
  bytes->resize((bytes->size() + kC3dBlock - 1) / kC3dBlock * kC3dBlock, '\0');
}

class C3dWriter {
 public:
  explicit C3dWriter(const C3dFile& file) : file_(file) {}

  std::string Write() {
    double largest = 1e-6;
    for (const auto& track : file_.points) {
      for (const Eigen::Vector3d& p : track) {
        if (p.allFinite()) largest = std::max(largest, p.cwiseAbs().maxCoeff());
      }
    }
    // The scale is the stored one: the reader multiplies by the rounded number.
    scale_ = static_cast<float>(largest / kLargestInteger);
    for (const C3dAnalogChannel& channel : file_.analog) {
      double peak = 1e-6;
      for (double sample : channel.samples) peak = std::max(peak, std::fabs(sample));
      analog_scale_.push_back(file_.floating ? 1.0f : static_cast<float>(peak / kLargestInteger));
    }
    Parameters();
    Header();
    Data();
    return header_ + parameters_ + data_;
  }

 private:
  void Word(double value, std::string* out) const {
    AppendC3dWord(static_cast<std::uint16_t>(static_cast<int>(std::lround(value)) & 0xffff),
                  file_.processor, out);
  }
  void Real(double value, std::string* out) const { AppendC3dReal(value, file_.processor, out); }

  void Header() {
    header_ += '\2';
    header_ += '\x50';
    Word(static_cast<double>(file_.points.size()), &header_);
    Word(static_cast<double>(file_.analog.size()) * file_.samples_per_frame(), &header_);
    Word(file_.first_frame, &header_);
    Word(file_.first_frame + file_.num_frames() - 1.0, &header_);
    Word(0, &header_);
    Real(file_.floating ? -scale_ : scale_, &header_);
    Word(1.0 + static_cast<double>((kC3dBlock + parameters_.size()) / kC3dBlock), &header_);
    Word(file_.samples_per_frame(), &header_);
    Real(file_.point_rate_hz, &header_);
    FillBlock(&header_);
  }

  void Group(int id, const std::string& name) {
    parameters_ += static_cast<char>(name.size());
    parameters_ += static_cast<char>(-id);
    parameters_ += name;
    Word(3, &parameters_);  // itself and an empty description
    parameters_ += '\0';
    group_ = id;
  }

  void Parameter(const std::string& name, C3dType type, const std::vector<std::size_t>& dimensions,
                 const std::string& data) {
    parameters_ += static_cast<char>(name.size());
    parameters_ += static_cast<char>(group_);
    parameters_ += name;
    Word(static_cast<double>(2 + 2 + dimensions.size() + data.size() + 1), &parameters_);
    parameters_ += static_cast<char>(type);
    parameters_ += static_cast<char>(dimensions.size());
    for (std::size_t dimension : dimensions) parameters_ += static_cast<char>(dimension);
    parameters_ += data;
    parameters_ += '\0';
  }

  // A list of more entries than a dimension goes on in NAME2, NAME3, ...
  template <typename Entry, typename Write>
  static void InParts(const std::string& name, const std::vector<Entry>& entries, Write write) {
    std::string part = name;
    for (std::size_t begin = 0; begin == 0 || begin < entries.size(); begin += kMostEntries) {
      const std::size_t end = std::min(entries.size(), begin + kMostEntries);
      write(part, std::vector<Entry>(entries.begin() + begin, entries.begin() + end));
      part = name + std::to_string(end / kMostEntries + 1);
    }
  }

  void Texts(const std::string& name, const std::vector<std::string>& texts) {
    std::size_t length = 1;
    for (const std::string& text : texts) length = std::max(length, text.size());
    length = std::min(length, kMostEntries);
    InParts(name, texts, [&](const std::string& part, const std::vector<std::string>& some) {
      std::string data;
      for (std::string padded : some) {
        padded.resize(length, ' ');
        data += padded;
      }
      Parameter(part, C3dType::kText, {length, some.size()}, data);
    });
  }

  void Text(const std::string& name, const std::string& text) {
    Parameter(name, C3dType::kText, {text.size()}, text);
  }

  void Integers(const std::string& name, const std::vector<std::size_t>& dimensions,
                const std::vector<double>& values) {
    std::string data;
    for (double value : values) Word(value, &data);
    Parameter(name, C3dType::kInteger, dimensions, data);
  }

  void Reals(const std::string& name, const std::vector<std::size_t>& dimensions,
             const std::vector<double>& values) {
    std::string data;
    for (double value : values) Real(value, &data);
    Parameter(name, C3dType::kReal, dimensions, data);
  }

  void Parameters() {
    parameters_ = std::string("\1\x50\0", 3) + static_cast<char>(file_.processor);
    Group(1, "POINT");
    Integers("USED", {}, {static_cast<double>(file_.points.size())});
    Integers("FRAMES", {}, {static_cast<double>(file_.num_frames())});
    Reals("SCALE", {}, {file_.floating ? -scale_ : scale_});
    Reals("RATE", {}, {file_.point_rate_hz});
    Text("UNITS", file_.point_unit);
    if (!file_.screen_x.empty()) Text("X_SCREEN", file_.screen_x);
    if (!file_.screen_y.empty()) Text("Y_SCREEN", file_.screen_y);
    Texts("LABELS", file_.point_names);
    Group(2, "ANALOG");
    AnalogParameters();
    Group(3, "FORCE_PLATFORM");
    PlatformParameters();
    parameters_.append(2, '\0');  // a name of length 0 ends the list
    FillBlock(&parameters_);
    parameters_[2] = static_cast<char>(parameters_.size() / kC3dBlock);
  }

  void AnalogParameters() {
    std::vector<std::string> names, units;
    std::vector<double> scales(analog_scale_.begin(), analog_scale_.end());
    for (const C3dAnalogChannel& channel : file_.analog) {
      names.push_back(channel.name);
      units.push_back(channel.unit);
    }
    Integers("USED", {}, {static_cast<double>(names.size())});
    Reals("RATE", {}, {file_.point_rate_hz * std::max(1, file_.samples_per_frame())});
    Reals("GEN_SCALE", {}, {1.0});
    Texts("LABELS", names);
    Texts("UNITS", units);
    using Numbers = std::vector<double>;
    InParts("SCALE", scales, [this](const std::string& part, const Numbers& some) {
      Reals(part, {some.size()}, some);
    });
    InParts("OFFSET", Numbers(scales.size(), 0.0),
            [this](const std::string& part, const Numbers& some) {
              Integers(part, {some.size()}, some);
            });
  }

  void PlatformParameters() {
    const std::size_t count = file_.platforms.size();
    std::size_t stride = 6;
    bool calibrated = false;
    for (const C3dPlatform& platform : file_.platforms) {
      stride = std::max(stride, platform.channels.size());
      calibrated = calibrated || platform.type == 4;
    }
    std::vector<double> types, channels, corners, origins, calibration;
    for (const C3dPlatform& platform : file_.platforms) {
      types.push_back(platform.type);
      for (std::size_t i = 0; i < stride; ++i) {
        channels.push_back(i < platform.channels.size() ? platform.channels[i] + 1.0 : 0.0);
      }
      corners.insert(corners.end(), platform.corners.data(), platform.corners.data() + 12);
      origins.insert(origins.end(), platform.origin.data(), platform.origin.data() + 3);
      calibration.insert(calibration.end(), platform.calibration.data(),
                         platform.calibration.data() + 36);
    }
    Integers("USED", {}, {static_cast<double>(count)});
    Integers("TYPE", {count}, types);
    Integers("CHANNEL", {stride, count}, channels);
    Reals("CORNERS", {3, 4, count}, corners);
    Reals("ORIGIN", {3, count}, origins);
    if (calibrated) Reals("CAL_MATRIX", {6, 6, count}, calibration);
    Integers("ZERO", {2},
             {static_cast<double>(file_.platform_zero_first),
              static_cast<double>(file_.platform_zero_last)});
  }

  void Data() {
    const int per_frame = file_.samples_per_frame();
    for (int frame = 0; frame < file_.num_frames(); ++frame) {
      for (const auto& track : file_.points) Point(track[frame]);
      for (int sample = 0; sample < per_frame; ++sample) {
        for (std::size_t i = 0; i < file_.analog.size(); ++i) {
          const double value = file_.analog[i].samples[frame * per_frame + sample];
          if (file_.floating) {
            Real(value, &data_);
          } else {
            Word(value / analog_scale_[i], &data_);
          }
        }
      }
    }
    FillBlock(&data_);
  }

  void Point(const Eigen::Vector3d& position) {
    const bool seen = position.allFinite();
    for (int i = 0; i < 3; ++i) {
      const double value = seen ? position[i] : 0.0;
      if (file_.floating) {
        Real(value, &data_);
      } else {
        Word(value / scale_, &data_);
      }
    }
    if (file_.floating) {
      Real(seen ? 0.0 : -1.0, &data_);
    } else {
      Word(seen ? 0.0 : -1.0, &data_);
    }
  }

  const C3dFile& file_;
  float scale_ = 1.0f;
  std::vector<float> analog_scale_;
  int group_ = 0;
  std::string header_, parameters_, data_;
};

// Writes points, analog channels and platforms (not `parameters`), atomically. Integers are
// scaled to the largest value of the points and of each channel. Names longer than 127 bytes,
// tracks of unequal length, samples that are not finite and more than 65535 frames are Errors.
inline MaybeError WriteC3d(const std::string& path, const C3dFile& file) {
  const std::string problem = WritingProblem(file);
  if (!problem.empty()) return Error{"the C3D file cannot be written: " + problem, path};
  return WriteFileAtomically(path, C3dWriter(file).Write());
}

}  // namespace pushid
