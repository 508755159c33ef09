// datasets: C3D files read: the parameter section, force platforms, segments, frames.
#include "datasets/formats/c3d.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <utility>

#include "datasets/files/input_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

// "at byte 1234: ..." of the file at `path`.
Error C3dError(const std::string& path, std::size_t at, const std::string& message) {
  return {StrCat("at byte ", at, ": ", message), path};
}

// Fixed-length strings, filled up with blanks or zeros.
std::string WithoutPadding(std::string_view text) {
  text = text.substr(0, text.find('\0'));
  return std::string(Trimmed(text));
}

// A parameter's record: length of the name (negative when locked), id of the group (negative: this
// is the group itself), the name, the distance to the next record counted from where the distance
// stands, and then for a parameter type, number of dimensions, dimensions and data; a description
// follows. The last record has distance 0, or a name of length 0 stands behind it. Errors: a record
// that leaves the section, a parameter of a group that never appears, an unknown type.
class ParameterReader {
 public:
  ParameterReader(const std::string& path, const C3dBytes& bytes) : path_(path), bytes_(bytes) {}

  C3dParameters Read(std::size_t at) {
    while (true) {
      Need(at, 2);
      const int name_length = std::abs(static_cast<int>(bytes_.Signed(at)));
      const int group = bytes_.Signed(at + 1);
      if (name_length == 0) break;
      const std::size_t distance_at = at + 2 + name_length;
      Need(distance_at, 2);
      const std::string name = WithoutPadding(bytes_.Text(at + 2, name_length));
      if (group < 0) {
        group_names_[-group] = name;
      } else {
        ReadParameter(name, group, distance_at + 2);
      }
      const std::size_t distance = bytes_.Word(distance_at);
      if (distance == 0) break;
      if (distance < 2) {
        throw C3dError(
            path_, distance_at,
            "the next parameter begins inside this one (" + name + "): the file is damaged");
      }
      at = distance_at + distance;
    }
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      const auto found = group_names_.find(groups_[i]);
      if (found == group_names_.end()) {
        throw Error{StrCat("parameter ", Quoted(parameters_[i].name), " belongs to group ",
                           groups_[i], ", which the file does not have"),
                    path_};
      }
      parameters_[i].group = found->second;
    }
    return C3dParameters{std::move(parameters_)};
  }

 private:
  void Need(std::size_t at, std::size_t count) const {
    if (bytes_.Has(at, count)) return;
    throw C3dError(path_, at, "the file ends inside its parameters: it is truncated or damaged");
  }

  void ReadParameter(const std::string& name, int group, std::size_t at) {
    Need(at, 2);
    C3dParameter parameter;
    parameter.name = name;
    const int type = bytes_.Signed(at);
    if (type != -1 && type != 1 && type != 2 && type != 4) {
      throw C3dError(
          path_, at,
          StrCat("parameter ", Quoted(name), " has the type ", type, "; -1, 1, 2 and 4 are known"));
    }
    const int num_dimensions = bytes_.Byte(at + 1);
    at += 2;
    Need(at, num_dimensions);
    std::size_t count = 1;
    for (int i = 0; i < num_dimensions; ++i) {
      parameter.dimensions.push_back(bytes_.Byte(at + i));
      count *= bytes_.Byte(at + i);
      if (!bytes_.Has(0, count)) Need(at, count);
    }
    at += num_dimensions;
    Need(at, count * std::abs(type));
    const std::size_t length = parameter.dimensions.empty() ? 1 : parameter.dimensions[0];
    for (std::size_t i = 0; type == -1 && length > 0 && i < count / length; ++i) {
      parameter.texts.push_back(WithoutPadding(bytes_.Text(at + i * length, length)));
    }
    for (std::size_t i = 0; type != -1 && i < count; ++i) {
      parameter.numbers.push_back(type == 1   ? bytes_.Byte(at + i)
                                  : type == 2 ? bytes_.Integer(at + 2 * i)
                                              : bytes_.Real(at + 4 * i));
    }
    parameters_.push_back(std::move(parameter));
    groups_.push_back(group);
  }

  const std::string& path_;
  const C3dBytes& bytes_;
  std::map<int, std::string> group_names_;
  std::vector<int> groups_;  // of each parameter; a group may be named after its parameters
  std::vector<C3dParameter> parameters_;
};

// The entries of NAME, NAME2, ... up to the first that is not there.
template <typename Entry>
std::vector<Entry> Joined(const C3dParameters& parameters, std::string_view group,
                          const std::string& name, std::vector<Entry> C3dParameter::*entries) {
  std::vector<Entry> joined;
  for (int number = 1;; ++number) {
    const C3dParameter* parameter =
        parameters.Find(group, number == 1 ? name : StrCat(name, number));
    if (parameter == nullptr) return joined;
    const std::vector<Entry>& part = parameter->*entries;
    joined.insert(joined.end(), part.begin(), part.end());
  }
}

double FromVax(std::uint32_t bits) {
  const int exponent = static_cast<int>(bits >> 23 & 0xff);
  if (exponent == 0) return 0.0;
  const double fraction = static_cast<double>((bits & 0x7fffff) | 0x800000);
  const double size = std::ldexp(fraction, exponent - kVaxBias - kFractionBits);
  return (bits >> 31) != 0 ? -size : size;
}

constexpr int kMostPlatforms = 255;
constexpr char kPlatforms[] = "FORCE_PLATFORM";

// Counts stored in a signed integer although they reach 65535.
double Unsigned(double value) { return value < 0 ? value + 65536.0 : value; }

// One platform as the file has it; NaN, no channels or type 0 stand for what it does not say.
C3dPlatform ReadPlatform(const C3dParameters& parameters, int index, int stride) {
  const auto number = [&parameters](const char* name, int at) {
    return parameters.Number(kPlatforms, name, at, std::numeric_limits<double>::quiet_NaN());
  };
  C3dPlatform platform;
  platform.type = parameters.Whole(kPlatforms, "TYPE", index, -1000, 1000, 0);
  for (int c = 0; c < std::min(stride, platform.type == 3 ? 8 : 6); ++c) {
    platform.channels.push_back(
        parameters.Whole(kPlatforms, "CHANNEL", index * stride + c, -32768, 32767, 0) - 1);
  }
  for (int k = 0; k < 12; ++k) platform.corners(k % 3, k / 3) = number("CORNERS", 12 * index + k);
  for (int k = 0; k < 3; ++k) platform.origin[k] = number("ORIGIN", 3 * index + k);
  for (int k = 0; platform.type == 4 && k < 36; ++k) {
    platform.calibration(k % 6, k / 6) = number("CAL_MATRIX", 36 * index + k);
  }
  return platform;
}

// Without USED, there are as many platforms as have a TYPE or channels.
void ReadC3dPlatforms(C3dFile* file) {
  const C3dParameters& parameters = file->parameters;
  const C3dParameter* channels = parameters.Find(kPlatforms, "CHANNEL");
  const std::vector<double> types = parameters.Numbers(kPlatforms, "TYPE");
  const int stride =
      channels == nullptr || channels->dimensions.empty() ? 0 : channels->dimensions[0];
  const std::size_t listed =
      std::max(types.size(), stride == 0 ? 0 : channels->numbers.size() / stride);
  const int used = parameters.Whole(kPlatforms, "USED", 0, 0, kMostPlatforms,
                                    std::min<int>(kMostPlatforms, static_cast<int>(listed)));
  file->platform_zero_first = parameters.Whole(kPlatforms, "ZERO", 0, 0, 1 << 30, 0);
  file->platform_zero_last = parameters.Whole(kPlatforms, "ZERO", 1, 0, 1 << 30, 0);
  for (int i = 0; i < used; ++i) {
    file->platforms.push_back(ReadPlatform(parameters, i, stride));
  }
}

// The file's axis that the screen shows as up: "+Z" -> "+z"; empty when it is none.
std::string UpOfScreen(const std::string& screen_y) {
  if (screen_y.size() != 2 || (screen_y[0] != '+' && screen_y[0] != '-')) return "";
  const char axis = static_cast<char>(screen_y[1] | 0x20);
  return axis >= 'x' && axis <= 'z' ? std::string{screen_y[0], axis} : "";
}

constexpr char kGroup[] = "ROTATION";
constexpr std::size_t kReal = 4, kRealsOfPose = 17, kPoseColumns = 4;
constexpr int kMostSegments = 32767;
constexpr double kNoRotation = 0.1;  // of a determinant from 1

// The origin of the pose that stands at byte `at`; NaN where it was not seen.
Eigen::Vector3d Origin(const C3dBytes& bytes, std::size_t at) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  Eigen::Matrix4d pose;
  for (std::size_t i = 0; i < kPoseColumns * kPoseColumns; ++i) {
    pose(static_cast<int>(i % kPoseColumns), static_cast<int>(i / kPoseColumns)) =
        bytes.Real(at + kReal * i);
  }
  const bool seen = bytes.Real(at + kReal * kPoseColumns * kPoseColumns) >= 0.0 &&
                    pose.allFinite() &&
                    std::abs(pose.topLeftCorner<3, 3>().determinant() - 1.0) < kNoRotation;
  return seen ? Eigen::Vector3d(pose.topRightCorner<3, 1>()) : Eigen::Vector3d(kNaN, kNaN, kNaN);
}

int SegmentsOf(const C3dFile& file) {
  return file.parameters.Whole(kGroup, "USED", 0, 0, kMostSegments, 0);
}

// The poses of segments in a C3D file (group ROTATION, as Theia3D and Visual3D write them).
//
// The block ROTATION:DATA_START begins the poses, for every frame ROTATION:RATIO times (once, where
// it is not said) ROTATION:USED of 17 floats each: a 4 x 4 matrix by columns, segment to
// world, whose last column is the segment's origin in POINT:UNITS, and its reliability, negative
// where the segment was not seen.
//
// Adds the origins as points, by the names of ROTATION:LABELS without Theia3D's ending _4X4; of
// several poses in a frame the first. A matrix that is no rotation was not seen. Errors: poses that
// the file ends before.
void AddC3dRotations(const C3dBytes& bytes, C3dFile* file) {
  constexpr std::string_view kEnding = "_4X4";
  const std::size_t segments = SegmentsOf(*file);
  if (segments == 0) return;
  const double block = file->parameters.Number(kGroup, "DATA_START", 0, 0.0);
  if (block == 0.0) throw C3dError(file->path, 0, "ROTATION:DATA_START is missing");
  const std::size_t begin = (static_cast<std::size_t>(Unsigned(block)) - 1) * kC3dBlock;
  const std::size_t frame_size = kReal * kRealsOfPose * segments *
                                 file->parameters.Whole(kGroup, "RATIO", 0, 1, kMostSegments, 1);
  const std::size_t frames = file->num_frames();
  if (!bytes.Has(begin, frames * frame_size)) {
    throw C3dError(file->path, bytes.size(),
                   StrCat("the file ends before the last pose of ", frames,
                          " frames (group ROTATION): it is truncated; export it again"));
  }
  std::vector<std::string> names = file->parameters.Texts(kGroup, "LABELS");
  names.resize(segments);
  for (std::size_t s = 0; s < segments; ++s) {
    std::string name = names[s].empty() ? StrCat("segment_", s + 1) : names[s];
    if (name.size() > kEnding.size() && EndsWith(name, kEnding)) {
      name.resize(name.size() - kEnding.size());
    }
    file->point_names.push_back(std::move(name));
    std::vector<Eigen::Vector3d> track;
    for (std::size_t t = 0; t < frames; ++t) {
      track.push_back(Origin(bytes, begin + t * frame_size + s * kReal * kRealsOfPose));
    }
    file->points.push_back(std::move(track));
  }
}

constexpr int kMagic = 0x50;
constexpr int kMostWords = 65535;  // of a 16-bit count
constexpr int kMaxPoints = 32767;

class Reader {
 public:
  Reader(const std::string& path, std::string_view text, bool accept_truncated)
      : path_(path), text_(text), accept_truncated_(accept_truncated) {
    file_.path = path;
  }

  C3dFile Read() {
    ReadSections();
    ReadHeader();
    ReadNames();
    ReadFrames();
    AddC3dRotations(bytes_, &file_);
    ReadC3dPlatforms(&file_);
    return std::move(file_);
  }

 private:
  [[noreturn]] void Fail(std::size_t at, const std::string& message) const {
    throw C3dError(path_, at, message);
  }
  double Number(const char* group, const char* name, std::size_t index, double fallback) const {
    return file_.parameters.Number(group, name, index, fallback);
  }

  void ReadSections() {
    if (text_.size() < kC3dBlock) {
      throw Error{
          StrCat(
              "the file has ", text_.size(),
              " bytes; a C3D file starts with a header of 512: it is truncated or not a C3D file"),
          path_};
    }
    const C3dBytes head(text_, C3dProcessor::kIntel);
    if (head.Byte(1) != kMagic || head.Byte(0) == 0) {
      Fail(1, StrCat("this is not a C3D file: its second byte is ", head.Byte(1), ", not 80"));
    }
    const std::size_t begin = (head.Byte(0) - std::size_t{1}) * kC3dBlock;
    if (!head.Has(begin, 4)) Fail(begin, "the parameters should be here, but the file ends before");
    const int processor = head.Byte(begin + 3);
    if (processor < 84 || processor > 86) {
      Fail(begin + 3, StrCat("the processor is ", processor,
                             "; 84 (Intel), 85 (DEC) and 86 (MIPS) are known"));
    }
    file_.processor = static_cast<C3dProcessor>(processor);
    bytes_ = C3dBytes(text_, file_.processor);
    file_.parameters = ParameterReader(path_, bytes_).Read(begin + 4);
  }

  void ReadHeader() {
    num_points_ = bytes_.Word(2);
    const int samples = bytes_.Word(4);
    file_.first_frame = bytes_.Word(6);
    scale_ = bytes_.Real(12);
    file_.floating = scale_ < 0.0;
    data_ = bytes_.Word(16);
    samples_per_frame_ = bytes_.Word(18);
    file_.point_rate_hz = bytes_.Real(20);
    if (num_points_ > kMaxPoints) Fail(2, StrCat(num_points_, " points are too many"));
    if (samples_per_frame_ == 0 && samples > 0) {
      Fail(18, "there are analog samples, but none per frame");
    }
    if (samples_per_frame_ > 0 && samples % samples_per_frame_ != 0) {
      Fail(4,
           StrCat(samples, " analog samples per frame are not a multiple of ", samples_per_frame_));
    }
    num_channels_ = samples_per_frame_ > 0 ? samples / samples_per_frame_ : 0;
    if (!std::isfinite(scale_) || (scale_ == 0.0 && num_points_ > 0)) {
      Fail(12, "the scale of the points is " + Rounded(scale_));
    }
    if (!(file_.point_rate_hz > 0.0 && file_.point_rate_hz <= 1e5)) {
      Fail(20, "the frame rate is " + Rounded(file_.point_rate_hz) +
                   " per second; it must be above 0 and at most 100000");
    }
    file_.analog_rate_hz = file_.point_rate_hz * std::max(1, samples_per_frame_);
    if (data_ == 0) Fail(16, "the header does not give the start of the data");
    data_ = (data_ - 1) * kC3dBlock;
    CountFrames();
  }

  // The header counts with 16 bits; longer recordings say it in TRIAL:ACTUAL_..._FIELD (two words
  // each) or POINT:LONG_FRAMES.
  void CountFrames() {
    const int last = bytes_.Word(8);
    double frames = last - file_.first_frame + 1.0;
    const double announced = Unsigned(Number("POINT", "FRAMES", 0, frames));
    if (file_.parameters.Find("TRIAL", "ACTUAL_END_FIELD") != nullptr) {
      const auto field = [this](const char* name, double fallback) {
        return Unsigned(Number("TRIAL", name, 0, fallback)) +
               65536.0 * Unsigned(Number("TRIAL", name, 1, 0.0));
      };
      frames = field("ACTUAL_END_FIELD", last) - field("ACTUAL_START_FIELD", 1.0) + 1.0;
    } else if (last == kMostWords || announced >= kMostWords) {
      frames = Number("POINT", "LONG_FRAMES", 0, frames);
    }
    if (!(frames >= 1.0 && frames < 2147483647.0 && std::floor(frames) == frames)) {
      Fail(6, StrCat("the first frame is ", file_.first_frame, ", the last ", last,
                     ": the file has no frames"));
    }
    file_.announced_frames = static_cast<int>(frames);
  }

  void ReadNames() {
    file_.point_names = file_.parameters.Texts("POINT", "LABELS");
    file_.point_names.resize(num_points_);
    for (int i = 0; i < num_points_; ++i) {
      if (file_.point_names[i].empty()) file_.point_names[i] = StrCat("point_", i + 1);
    }
    const auto text = [this](const char* name) {
      const C3dParameter* parameter = file_.parameters.Find("POINT", name);
      return parameter == nullptr || parameter->texts.empty() ? "" : parameter->texts[0];
    };
    file_.point_unit = text("UNITS");
    file_.screen_x = text("X_SCREEN");
    file_.screen_y = text("Y_SCREEN");
    std::vector<std::string> names = file_.parameters.Texts("ANALOG", "LABELS");
    std::vector<std::string> units = file_.parameters.Texts("ANALOG", "UNITS");
    names.resize(num_channels_);
    units.resize(num_channels_);
    for (int i = 0; i < num_channels_; ++i) {
      if (names[i].empty()) names[i] = StrCat("channel_", i + 1);
      file_.analog.push_back({names[i], units[i], {}});
    }
  }

  void ReadFrames() {
    const std::size_t word = file_.floating ? 4 : 2;
    const std::size_t frame_size =
        word * (4 * static_cast<std::size_t>(num_points_) +
                static_cast<std::size_t>(num_channels_) * samples_per_frame_);
    if (frame_size == 0 && SegmentsOf(file_) > 0) {
      file_.frames_without_points = file_.announced_frames;
      return;
    }
    if (frame_size == 0) Fail(2, "the file has neither points nor analog channels");
    const std::size_t available = data_ < bytes_.size() ? (bytes_.size() - data_) / frame_size : 0;
    std::size_t frames = file_.announced_frames;
    if (available < frames && (available == 0 || !accept_truncated_)) {
      Fail(bytes_.size(), StrCat("the file ends after ", available, " of ", frames,
                                 " frames: it is truncated; export it again"));
    }
    frames = std::min(frames, available);
    file_.frames_without_points = static_cast<int>(frames);
    file_.points.resize(num_points_);
    for (auto& track : file_.points) track.reserve(frames);
    for (C3dAnalogChannel& channel : file_.analog) {
      channel.samples.reserve(frames * samples_per_frame_);
    }
    PrepareAnalog();
    for (std::size_t frame = 0; frame < frames; ++frame) {
      std::size_t at = data_ + frame * frame_size;
      for (auto& track : file_.points) {
        track.push_back(Point(at));
        at += 4 * word;
      }
      for (int sample = 0; sample < samples_per_frame_; ++sample) {
        for (int channel = 0; channel < num_channels_; ++channel, at += word) {
          file_.analog[channel].samples.push_back(Sample(at, channel));
        }
      }
    }
  }

  // The fourth word holds a negative number where the point was not seen; some programs leave zeros
  // instead. Positions no lens can see (NaN, 1e30) count as not seen.
  Eigen::Vector3d Point(std::size_t at) const {
    Eigen::Vector3d position;
    double seen = 0.0;
    if (file_.floating) {
      for (int i = 0; i < 3; ++i) position[i] = bytes_.Real(at + 4 * i);
      seen = bytes_.Real(at + 12);
    } else {
      for (int i = 0; i < 3; ++i) position[i] = scale_ * bytes_.Integer(at + 2 * i);
      seen = bytes_.Integer(at + 6);
    }
    return SeenPosition(seen >= 0.0 ? position : Eigen::Vector3d(Eigen::Vector3d::Zero()));
  }

  // ANALOG:NAME, NAME2, ...: one number for each channel. None at all leaves `neutral`, and a value
  // without dimensions holds for all; a list that is too short does not say what it left out.
  std::vector<double> PerChannel(const std::string& name, double neutral) const {
    std::vector<double> numbers = file_.parameters.Numbers("ANALOG", name);
    const C3dParameter* parameter = file_.parameters.Find("ANALOG", name);
    const std::size_t channels = file_.analog.size();
    if (numbers.empty()) {
      numbers.assign(channels, neutral);
    } else if (numbers.size() == 1 && parameter->dimensions.empty()) {
      numbers.assign(channels, numbers[0]);
    } else if (numbers.size() < channels) {
      throw Error{StrCat("ANALOG:", name, " ends after ", numbers.size(), " of ", channels,
                         " analog channels, before ", Quoted(file_.analog[numbers.size()].name),
                         "; export the file again, with one number for every channel (from the ",
                         "256th on in ANALOG:", name, "2)"),
                  path_};
    }
    return numbers;
  }

  void PrepareAnalog() {
    const double general = Number("ANALOG", "GEN_SCALE", 0, 1.0);
    analog_scale_ = PerChannel("SCALE", 1.0);
    analog_offset_ = PerChannel("OFFSET", 0.0);
    // A file without ANALOG:FORMAT has unsigned samples if an offset is the middle of their range,
    // which is the end of the signed one.
    const C3dParameter* format = file_.parameters.Find("ANALOG", "FORMAT");
    unsigned_ = format != nullptr && !format->texts.empty()
                    ? EqualsIgnoringCase(format->texts[0], "UNSIGNED")
                    : std::any_of(analog_offset_.begin(), analog_offset_.end(),
                                  [](double offset) { return offset < -16384.0; });
    for (double& scale : analog_scale_) scale *= general;
    for (double& offset : analog_offset_) offset = unsigned_ ? Unsigned(offset) : offset;
  }

  double Sample(std::size_t at, int channel) const {
    const double raw = file_.floating ? bytes_.Real(at)
                       : unsigned_    ? static_cast<double>(bytes_.Word(at))
                                      : static_cast<double>(bytes_.Integer(at));
    return (raw - analog_offset_[channel]) * analog_scale_[channel];
  }

  const std::string& path_;
  const std::string_view text_;
  const bool accept_truncated_;
  C3dBytes bytes_;
  C3dFile file_;
  int num_points_ = 0, num_channels_ = 0, samples_per_frame_ = 0;
  double scale_ = 0.0;
  std::size_t data_ = 0;  // the first byte of the data
  bool unsigned_ = false;
  std::vector<double> analog_scale_, analog_offset_;
};

}  // namespace

const C3dParameter* C3dParameters::Find(std::string_view group, std::string_view name) const {
  for (const C3dParameter& parameter : list) {
    if (EqualsIgnoringCase(parameter.group, group) && EqualsIgnoringCase(parameter.name, name)) {
      return &parameter;
    }
  }
  return nullptr;
}

double C3dParameters::Number(std::string_view group, std::string_view name, std::size_t index,
                             double fallback) const {
  const C3dParameter* parameter = Find(group, name);
  if (parameter == nullptr || index >= parameter->numbers.size()) return fallback;
  return parameter->numbers[index];
}

int C3dParameters::Whole(std::string_view group, std::string_view name, std::size_t index,
                         int lowest, int highest, int fallback) const {
  const double value = Number(group, name, index, fallback);
  // Written so that NaN fails.
  return value >= lowest && value <= highest ? static_cast<int>(value) : fallback;
}

std::vector<double> C3dParameters::Numbers(std::string_view group, const std::string& name) const {
  return Joined(*this, group, name, &C3dParameter::numbers);
}

std::vector<std::string> C3dParameters::Texts(std::string_view group,
                                              const std::string& name) const {
  return Joined(*this, group, name, &C3dParameter::texts);
}

std::uint16_t C3dBytes::Word(std::size_t at) const {
  const std::uint16_t first = Byte(at), second = Byte(at + 1);
  return static_cast<std::uint16_t>(processor_ == C3dProcessor::kMips ? first << 8 | second
                                                                      : second << 8 | first);
}

double C3dBytes::Real(std::size_t at) const {
  const std::uint32_t first = Word(at), second = Word(at + 2);
  if (processor_ == C3dProcessor::kDec) return FromVax(first << 16 | second);
  const bool mips = processor_ == C3dProcessor::kMips;
  const std::uint32_t bits = mips ? first << 16 | second : second << 16 | first;
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

int C3dFile::samples_per_frame() const {
  const int frames = num_frames();
  return analog.empty() || frames == 0 ? 0 : static_cast<int>(analog[0].samples.size()) / frames;
}

Result<PointMotion> PointsOfC3d(const C3dFile& file, const PointReadOptions& options) {
  return Caught([&] {
    PointMotion motion;
    motion.path = file.path;
    motion.rate_hz = file.point_rate_hz;
    motion.unit_text = file.point_unit;
    motion.unit = FromName<LengthUnit>(file.point_unit);
    motion.up = UpOfScreen(file.screen_y);
    motion.names = file.point_names;
    motion.content_hash = file.content_hash;
    ChoosePoints(options, &motion);
    for (int index : motion.chosen) motion.positions.push_back(file.points[index]);
    return motion;
  });
}

Result<PointMotion> ReadC3dPoints(const std::string& path, const PointReadOptions& options) {
  return Caught([&] { return OrThrow(PointsOfC3d(OrThrow(ReadC3d(path)), options)); });
}

Result<C3dFile> ReadC3d(const std::string& path, bool accept_truncated) {
  return Caught([&] {
    const std::string bytes = OrThrow(ReadWholeFile(path));
    C3dFile file = Reader(path, bytes, accept_truncated).Read();
    ContentHash hash;
    hash.Add(bytes);
    file.content_hash = hash.Hex();
    return file;
  });
}

}  // namespace pushid
