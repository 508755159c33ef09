// datasets: BVH motions as data, read and written, and their forward kinematics.
#include "datasets/formats/bvh.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <unordered_set>

#include "datasets/files/atomic_file.h"
#include "datasets/files/input_file.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

// The part of a file before its rows of numbers: HIERARCHY, Frames:, Frame Time:.
struct BvhHeader {
  BvhSkeleton skeleton;
  std::int64_t num_frames = 0;  // as announced by `Frames:`, at least 1
  double frame_time_s = 0.0;    // within the accepted range
};

bool IsBrace(char c) { return c == '{' || c == '}'; }

// Reads tokens across lines, with a stack of open braces, which no depth of nesting overflows.
class HierarchyParser {
 public:
  explicit HierarchyParser(LineReader* reader) : reader_(*reader) {}

  BvhSkeleton Parse() {
    if (!EqualsIgnoringCase(Next(), "HIERARCHY")) {
      Fail("this is not a BVH file: it does not start with HIERARCHY");
    }
    while (true) {
      const std::string_view token = Next();
      if (token.empty()) Fail("the file ends inside the hierarchy, before MOTION: it is truncated");
      if (EqualsIgnoringCase(token, "MOTION")) break;
      Take(token);
    }
    if (!open_.empty()) {
      Fail(StrCat("MOTION is inside the hierarchy: ", open_.size(), " closing } missing"));
    }
    if (skeleton_.joints.empty()) Fail("the hierarchy has no ROOT");
    if (skeleton_.num_channels() == 0) Fail("no joint has any channels");
    if (!Trimmed(rest_).empty()) Fail(Quoted(Trimmed(rest_)) + " follows MOTION");
    return std::move(skeleton_);
  }

 private:
  struct OpenBrace {
    int joint;  // or the one that an End Site belongs to
    bool end_site = false, has_offset = false, has_channels = false;
  };

  [[noreturn]] void Fail(const std::string& problem) const { throw reader_.ErrorHere(problem); }

  void Take(std::string_view token) {
    if (EqualsIgnoringCase(token, "ROOT")) return OpenJoint(true);
    if (EqualsIgnoringCase(token, "JOINT")) return OpenJoint(false);
    if (EqualsIgnoringCase(token, "End")) return OpenEndSite();
    if (EqualsIgnoringCase(token, "OFFSET")) return ParseOffset();
    if (EqualsIgnoringCase(token, "CHANNELS")) return ParseChannels();
    if (token == "}") return Close();
    Fail(Quoted(token) +
         " is not expected in the hierarchy (ROOT, JOINT, End Site, OFFSET, CHANNELS, {, }, "
         "MOTION are)");
  }

  // The next token of the file, a brace being one of its own; empty at the end.
  std::string_view Next() {
    while ((rest_ = Trimmed(rest_)).empty()) {
      if (!reader_.Next(&rest_)) return {};
    }
    std::size_t length = 0;
    while (length < rest_.size() && !IsBlank(rest_[length]) && !IsBrace(rest_[length])) ++length;
    const std::string_view token = rest_.substr(0, std::max<std::size_t>(length, 1));
    rest_.remove_prefix(token.size());
    return token;
  }

  void ExpectOpeningBrace(const std::string& what) {
    const std::string_view token = Next();
    if (token == "{") return;
    Fail("a { must follow " + what +
         (token.empty() ? "; the file is truncated" : ", not " + Quoted(token)));
  }

  void OpenJoint(bool root) {
    const std::size_t brace = std::min(rest_.find_first_of("{}"), rest_.size());
    const std::string name(Trimmed(rest_.substr(0, brace)));
    rest_.remove_prefix(brace);
    if (name.empty()) Fail("a joint has no name");
    if (root != open_.empty()) {
      Fail(root ? "ROOT " + name + " is inside another joint; is a } missing?"
                : "JOINT " + name + " is outside of any ROOT");
    }
    if (!root && open_.back().end_site) Fail("JOINT " + name + " is inside an End Site");
    if (!names_.insert(name).second) {
      Fail("two joints are called " + Quoted(name) + "; names must be unique");
    }
    const int parent = root ? -1 : open_.back().joint;
    open_.push_back({static_cast<int>(skeleton_.joints.size())});
    BvhJoint& joint = skeleton_.joints.emplace_back();
    joint.name = name;
    joint.parent = parent;
    ExpectOpeningBrace("the joint's name");
  }

  void OpenEndSite() {
    if (!EqualsIgnoringCase(Next(), "Site")) Fail("Site must follow End");
    if (open_.empty() || open_.back().end_site) Fail("an End Site is outside of any joint");
    open_.push_back({open_.back().joint, true});
    ExpectOpeningBrace("End Site");
  }

  void ParseOffset() {
    if (open_.empty()) Fail("an OFFSET is outside of any joint");
    Eigen::Vector3d offset;
    for (double& length : offset) {
      const std::string_view token = Next();
      if (!ParseDouble(token, &length)) Fail("OFFSET takes three numbers: " + NumberProblem(token));
    }
    OpenBrace& open = open_.back();
    if (open.has_offset) Fail("a second OFFSET for the same joint");
    open.has_offset = true;
    BvhJoint& joint = skeleton_.joints[open.joint];
    (open.end_site ? joint.end_sites.emplace_back() : joint.offset) = offset;
  }

  void ParseChannels() {
    if (open_.empty() || open_.back().end_site) Fail("CHANNELS are outside of any joint");
    BvhJoint& joint = skeleton_.joints[open_.back().joint];
    if (open_.back().has_channels) Fail("a second CHANNELS for the same joint");
    open_.back().has_channels = true;
    const std::string_view count_token = Next();
    std::int64_t count = 0;
    if (!ParseInteger(count_token, &count) || count < 0 || count > 6) {
      Fail("CHANNELS takes a number from 0 to 6 first, not " + Quoted(count_token));
    }
    constexpr auto kNames = Names(BvhChannel{});
    for (std::int64_t i = 0; i < count; ++i) {
      const std::string_view token = Next();
      const auto* const row = std::find_if(kNames.begin(), kNames.end(), [&](const auto& named) {
        return EqualsIgnoringCase(token, named.name);
      });
      if (row == kNames.end()) {
        Fail(StrCat(
            "joint ", Quoted(joint.name), ": ", Quoted(token), " is not a channel; ", count,
            " of Xposition, Yposition, Zposition, Xrotation, Yrotation, Zrotation must follow"));
      }
      if (std::count(joint.channels.begin(), joint.channels.end(), row->value) > 0) {
        Fail("joint " + Quoted(joint.name) + " lists " + row->name + " twice");
      }
      joint.channels.push_back(row->value);
    }
  }

  void Close() {
    if (open_.empty()) Fail("a } has no matching {");
    const OpenBrace closed = open_.back();
    open_.pop_back();
    if (closed.has_offset) return;
    Fail(
        (closed.end_site ? "an End Site" : "joint " + Quoted(skeleton_.joints[closed.joint].name)) +
        " has no OFFSET");
  }

  LineReader& reader_;
  std::string_view rest_;  // of the current line
  BvhSkeleton skeleton_;
  std::vector<OpenBrace> open_;
  std::unordered_set<std::string> names_;
};

// The value of a line "<words>: <value>".
std::string ReadField(LineReader* reader, const std::string& words) {
  std::string_view line;
  if (!reader->NextNonBlank(&line)) {
    throw reader->ErrorHere("the file ends where '" + words + ":' should be: it is truncated");
  }
  const std::size_t colon = line.find(':');
  std::string key;
  for (std::string_view rest = line.substr(0, colon); !(rest = Trimmed(rest)).empty();) {
    if (!key.empty()) key += ' ';
    key += NextToken(&rest);
  }
  if (colon == std::string_view::npos || !EqualsIgnoringCase(key, words)) {
    throw reader->ErrorHere("'" + words + ":' is expected here, not " + Quoted(Trimmed(line)));
  }
  return std::string(Trimmed(line.substr(colon + 1)));
}

// The reason why a frame time is not accepted, or "" when it is.
std::string FrameTimeProblem(double frame_time_s) {
  // A relative hair of slack: 0.0001 s is 10000 Hz whichever way it rounds.
  constexpr double kSlack = 1e-9;
  if (frame_time_s >= (1.0 - kSlack) / kMaxFramesPerSecond &&
      frame_time_s <= (1.0 + kSlack) / kMinFramesPerSecond) {
    return "";
  }
  return "the frame time is " + Rounded(frame_time_s) + " s; accepted are " +
         Rounded(1.0 / kMaxFramesPerSecond) + " s to " + Rounded(1.0 / kMinFramesPerSecond) +
         " s, that is " + Rounded(kMaxFramesPerSecond) + " to " + Rounded(kMinFramesPerSecond) +
         " frames per second";
}

// Leaves `reader` before the first row. Keywords are matched whatever their case; line breaks
// inside the hierarchy are free; a joint's name is the rest of its line and may contain spaces.
BvhHeader ReadBvhHeader(LineReader* reader) {
  BvhHeader header{HierarchyParser(reader).Parse()};
  const std::string frames = ReadField(reader, "Frames");
  if (!ParseInteger(frames, &header.num_frames) || header.num_frames < 1 ||
      header.num_frames > std::numeric_limits<int>::max()) {
    throw reader->ErrorHere("Frames: must be a whole number of 1 or more, not " + Quoted(frames));
  }
  const std::string frame_time = ReadField(reader, "Frame Time");
  if (!ParseDouble(frame_time, &header.frame_time_s)) {
    throw reader->ErrorHere("Frame Time: " + NumberProblem(frame_time));
  }
  const std::string problem = FrameTimeProblem(header.frame_time_s);
  if (!problem.empty()) throw reader->ErrorHere(problem);
  return header;
}

constexpr double kRadiansPerDegree = 3.14159265358979323846 / 180.0;
constexpr double kUpright = 1e-9;  // the cosine below which the second angle is 90 degrees

// R <- R * R_axis(angle): only two columns change, e.g. for x: y' = c y + s z, z' = c z - s y.
void RotateAbout(int axis, double radians, Eigen::Matrix3d* rotation) {
  const double c = std::cos(radians), s = std::sin(radians);
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const Eigen::Vector3d column_i = rotation->col(i), column_j = rotation->col(j);
  rotation->col(i) = c * column_i + s * column_j;
  rotation->col(j) = c * column_j - s * column_i;
}

// Why a motion is not written; empty: it is.
std::string MotionProblem(const BvhMotion& motion) {
  const std::size_t channels = motion.skeleton.num_channels(), values = motion.values.size();
  if (channels == 0) return "no joint has any channels";
  if (values == 0 || values % channels != 0) {
    return StrCat("there are ", values, " values for ", channels, " channels per frame");
  }
  const auto bad = std::find_if_not(motion.values.begin(), motion.values.end(),
                                    [](double value) { return std::isfinite(value); });
  if (bad == motion.values.end()) return FrameTimeProblem(motion.frame_time_s);
  const std::size_t frame = static_cast<std::size_t>(bad - motion.values.begin()) / channels;
  return StrCat("a value of frame ", frame, " is not finite");
}

std::string HierarchyText(const BvhSkeleton& skeleton) {
  std::string text = "HIERARCHY\n";
  const auto line = [&text](std::size_t depth, const std::string& content) {
    text += std::string(depth, '\t') + content + "\n";
  };
  const auto offset = [&](std::size_t depth, const Eigen::Vector3d& lengths) {
    std::string numbers = "OFFSET";
    for (double length : lengths) numbers += " " + DoubleText(length);
    line(depth, numbers);
  };
  std::vector<int> path;
  const auto close_up_to = [&](int parent) {
    for (; !path.empty() && path.back() != parent; line(path.size(), "}")) path.pop_back();
  };
  const std::vector<BvhJoint>& joints = skeleton.joints;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const BvhJoint& joint = joints[i];
    close_up_to(joint.parent);
    const std::size_t depth = path.size();
    line(depth, (depth == 0 ? "ROOT " : "JOINT ") + joint.name);
    line(depth, "{");
    offset(depth + 1, joint.offset);
    std::string channels = StrCat("CHANNELS ", joint.channels.size());
    for (BvhChannel channel : joint.channels) channels += " " + NameOf(channel);
    line(depth + 1, channels);
    std::vector<Eigen::Vector3d> ends = joint.end_sites;
    const bool leaf = i + 1 == joints.size() || joints[i + 1].parent != static_cast<int>(i);
    if (leaf && ends.empty()) ends.emplace_back(Eigen::Vector3d::Zero());
    for (const Eigen::Vector3d& end : ends) {
      line(depth + 1, "End Site");
      line(depth + 1, "{");
      offset(depth + 2, end);
      line(depth + 1, "}");
    }
    path.push_back(static_cast<int>(i));
  }
  close_up_to(-1);
  return text;
}

// The joint and channel that the value at `index` of a row belongs to, for messages.
std::string ChannelName(const BvhSkeleton& skeleton, int index) {
  for (const BvhJoint& joint : skeleton.joints) {
    const int count = static_cast<int>(joint.channels.size());
    if (index < count) return joint.name + " " + NameOf(joint.channels[index]);
    index -= count;
  }
  return StrCat("value ", index);
}

// The end of a plain decimal number (-digits.digits of at most 32 characters, so finite); null for
// anything else, which std::from_chars then judges.
const char* PastPlainNumber(const char* at, const char* end) {
  constexpr std::ptrdiff_t kLongest = 32;
  const auto past_digits = [end](const char* p) {
    while (p != end && *p >= '0' && *p <= '9') ++p;
    return p;
  };
  const char* const digits = at != end && *at == '-' ? at + 1 : at;
  const char* past = past_digits(digits);
  if (past == digits) return nullptr;
  if (past != end && *past == '.') past = past_digits(past + 1);
  return (past == end || IsBlank(*past)) && past - at <= kLongest ? past : nullptr;
}

// Fills values[0 .. count) from a row of numbers; those that are not used may stay as they were.
void ParseFrame(const LineReader& reader, std::string_view line, const BvhSkeleton& skeleton,
                const std::vector<bool>& used, double* values) {
  const int count = static_cast<int>(used.size());
  const char* at = line.data();
  const char* const end = at + line.size();
  for (int i = 0;; ++i) {
    while (at != end && IsBlank(*at)) ++at;
    if (at == end && i == count) return;
    if (at == end) {
      throw reader.ErrorHere(
          StrCat("the row has ", i, " numbers, not ", count, ": the file is truncated or damaged"));
    }
    if (i == count) {
      throw reader.ErrorHere(StrCat("the row has more than the ", count,
                                    " numbers that the hierarchy's channels ask for"));
    }
    if (const char* past = used[i] ? nullptr : PastPlainNumber(at, end)) {
      at = past;
      continue;
    }
    const auto [parsed_to, error] = std::from_chars(at, end, values[i]);
    if (error == std::errc() && std::isfinite(values[i]) &&
        (parsed_to == end || IsBlank(*parsed_to))) {
      at = parsed_to;
      continue;
    }
    std::string_view rest(at, static_cast<std::size_t>(end - at));
    const std::string_view token = NextToken(&rest);
    if (!ParseDouble(token, &values[i])) {
      throw reader.ErrorHere(StrCat("number ", i + 1, " of the row (", ChannelName(skeleton, i),
                                    "): ", NumberProblem(token)));
    }
    at += token.size();
  }
}

// Calls take_row(values) for every row; checks that there are as many as announced. used: the
// values that take_row needs.
template <typename TakeRow>
void ReadFrames(LineReader* reader, const BvhHeader& header, const std::vector<bool>& used,
                const TakeRow& take_row) {
  std::vector<double> values(used.size());
  std::int64_t rows = 0;
  const std::string wrong = StrCat("wrong frame count: Frames: is ", header.num_frames, ", but ");
  for (std::string_view line; reader->NextNonBlank(&line); ++rows) {
    if (rows == header.num_frames) throw reader->ErrorHere(wrong + "here is one row more");
    ParseFrame(*reader, line, header.skeleton, used, values.data());
    take_row(values);
  }
  if (rows < header.num_frames) {
    throw reader->ErrorHere(
        StrCat(wrong, "the file ends after ", rows, ": it is truncated, or the count is wrong"));
  }
}

// The announced number of frames, but no more than a file of this size can hold: memory is not
// handed out on a claim. Every number takes a digit and a separator.
std::size_t FramesToReserve(const LineReader& reader, const BvhHeader& header) {
  const std::int64_t possible = reader.file_size() / (2 * header.skeleton.num_channels()) + 1;
  return static_cast<std::size_t>(std::min(header.num_frames, possible));
}

}  // namespace

std::vector<BvhChannel> DefaultBvhChannels(bool with_position) {
  std::vector<BvhChannel> channels;
  if (with_position) {
    channels = {BvhChannel::kXposition, BvhChannel::kYposition, BvhChannel::kZposition};
  }
  channels.insert(channels.end(),
                  {BvhChannel::kZrotation, BvhChannel::kYrotation, BvhChannel::kXrotation});
  return channels;
}

int BvhSkeleton::num_channels() const {
  std::size_t count = 0;
  for (const BvhJoint& joint : joints) count += joint.channels.size();
  return static_cast<int>(count);
}

std::vector<std::string> BvhSkeleton::Names() const {
  std::vector<std::string> names;
  for (const BvhJoint& joint : joints) names.push_back(joint.name);
  return names;
}

int BvhSkeleton::Find(const std::string& name) const {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

int BvhMotion::num_frames() const {
  const int channels = skeleton.num_channels();
  return channels > 0 ? static_cast<int>(values.size() / channels) : 0;
}

void RotateByChannels(const BvhJoint& joint, const double* values, Eigen::Matrix3d* rotation) {
  for (std::size_t i = 0; i < joint.channels.size(); ++i) {
    const BvhChannel channel = joint.channels[i];
    if (IsRotation(channel)) {
      RotateAbout(AxisOf(channel), values[i] * kRadiansPerDegree, rotation);
    }
  }
}

// R = R_i(a) R_j(b) R_k(c) with e = 1 where i, j, k are cyclic and -1 otherwise: R_ik = e sin b,
// R_ii = cos b cos c, R_ij = -e cos b sin c, R_jk = -e sin a cos b, R_kk = cos a cos b. At b = +-90
// degrees only one turn is left of a and c, and a takes it.
void SetRotationChannels(const BvhJoint& joint, const Eigen::Matrix3d& rotation, double* values) {
  std::vector<int> places;
  for (std::size_t c = 0; c < joint.channels.size(); ++c) {
    if (IsRotation(joint.channels[c])) places.push_back(static_cast<int>(c));
  }
  const int i = AxisOf(joint.channels[places[0]]), j = AxisOf(joint.channels[places[1]]),
            k = AxisOf(joint.channels[places[2]]);
  const double e = j == (i + 1) % 3 ? 1.0 : -1.0;
  const double cos_b = std::hypot(rotation(i, i), rotation(i, j));
  double a = 0.0, c = 0.0;
  if (cos_b > kUpright) {
    a = std::atan2(-e * rotation(j, k), rotation(k, k));
    c = std::atan2(-e * rotation(i, j), rotation(i, i));
  } else {
    a = std::atan2(e * rotation(k, j), rotation(j, j));
  }
  const double angles[] = {a, std::atan2(e * rotation(i, k), cos_b), c};
  for (int n = 0; n < 3; ++n) values[places[n]] = angles[n] / kRadiansPerDegree;
}

BvhKinematics::BvhKinematics(const BvhSkeleton& skeleton, double metres_per_unit,
                             std::vector<int> joints)
    : skeleton_(skeleton),
      metres_per_unit_(metres_per_unit),
      joints_(std::move(joints)),
      world_position_(skeleton.joints.size()),
      world_rotation_(skeleton.joints.size()) {
  const int count = static_cast<int>(skeleton_.joints.size());
  std::vector<bool> needed(count, false), rotates(count, false);
  for (int joint : joints_) needed[joint] = true;
  for (int joint = count - 1; joint >= 0; --joint) {
    const int parent = skeleton_.joints[joint].parent;
    if (needed[joint] && parent >= 0) needed[parent] = rotates[parent] = true;
  }
  int first_channel = 0;
  for (int joint = 0; joint < count; ++joint) {
    if (needed[joint]) {
      steps_.push_back({joint, skeleton_.joints[joint].parent, rotates[joint], first_channel});
    }
    first_channel += static_cast<int>(skeleton_.joints[joint].channels.size());
  }
}

std::vector<bool> BvhKinematics::UsedValues() const {
  std::vector<bool> used(skeleton_.num_channels(), false);
  for (const Step& step : steps_) {
    const std::vector<BvhChannel>& channels = skeleton_.joints[step.joint].channels;
    for (std::size_t i = 0; i < channels.size(); ++i) {
      used[step.first_channel + i] = step.rotates_something || !IsRotation(channels[i]);
    }
  }
  return used;
}

void BvhKinematics::Positions(const double* row, Eigen::Vector3d* positions) {
  for (const Step& step : steps_) {
    const BvhJoint& joint = skeleton_.joints[step.joint];
    const double* values = row + step.first_channel;
    Eigen::Matrix3d& rotation = world_rotation_[step.joint];
    if (step.parent >= 0) {
      rotation = world_rotation_[step.parent];
    } else {
      rotation.setIdentity();
    }
    Eigen::Vector3d translation = joint.offset;
    for (std::size_t i = 0; i < joint.channels.size(); ++i) {
      const BvhChannel channel = joint.channels[i];
      if (!IsRotation(channel)) translation[AxisOf(channel)] = values[i];
    }
    world_position_[step.joint] = rotation * translation;
    if (step.parent >= 0) world_position_[step.joint] += world_position_[step.parent];
    if (!step.rotates_something) continue;
    RotateByChannels(joint, values, &rotation);
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    positions[i] = metres_per_unit_ * world_position_[joints_[i]];
  }
}

MaybeError WriteBvh(const std::string& path, const BvhMotion& motion) {
  const std::string problem = MotionProblem(motion);
  if (!problem.empty()) return Error{"the motion cannot be written: " + problem, path};
  AtomicFile file;
  if (MaybeError failed = file.Open(path)) return failed;
  file.Append(HierarchyText(motion.skeleton));
  file.Append(StrCat("MOTION\nFrames: ", motion.num_frames(),
                     "\nFrame Time: ", DoubleText(motion.frame_time_s), "\n"));
  const std::size_t channels = motion.skeleton.num_channels();
  for (std::size_t i = 0; i < motion.values.size(); ++i) {
    file.Append(DoubleText(motion.values[i]) + ((i + 1) % channels == 0 ? '\n' : ' '));
  }
  return file.Commit();
}

Result<double> ReadBvhFrameTime(const std::string& path) {
  return Caught([&] {
    LineReader reader(path);
    return ReadBvhHeader(&reader).frame_time_s;
  });
}

Result<PointMotion> ReadBvhPoints(const std::string& path, const PointReadOptions& options) {
  return Caught([&] {
    LineReader reader(path);
    const BvhHeader header = ReadBvhHeader(&reader);
    PointMotion motion;
    motion.path = path;
    motion.rate_hz = 1.0 / header.frame_time_s;
    motion.names = header.skeleton.Names();
    motion.skeleton = std::make_shared<const BvhSkeleton>(header.skeleton);
    ChoosePoints(options, &motion);
    motion.positions.resize(motion.chosen.size());
    const std::size_t frames = FramesToReserve(reader, header);
    for (auto& track : motion.positions) track.reserve(frames);
    BvhKinematics kinematics(header.skeleton, 1.0, motion.chosen);
    std::vector<Eigen::Vector3d> positions(motion.chosen.size());
    int row = 0;
    const auto take_row = [&](const std::vector<double>& values) {
      kinematics.Positions(values.data(), positions.data());
      if (row >= options.first_kept && row - options.first_kept < options.kept_rows) {
        motion.values.insert(motion.values.end(), values.begin(), values.end());
      }
      ++row;
      for (std::size_t i = 0; i < positions.size(); ++i) {
        motion.positions[i].push_back(positions[i]);
      }
    };
    const std::vector<bool> all(header.skeleton.num_channels(), true);
    ReadFrames(&reader, header, options.kept_rows > 0 ? all : kinematics.UsedValues(), take_row);
    motion.content_hash = reader.HashHex();
    return motion;
  });
}

}  // namespace pushid
