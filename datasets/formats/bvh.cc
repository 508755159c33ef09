// datasets: BVH motions as data, read and written, and their forward kinematics.
#include "datasets/formats/bvh.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "datasets/files/atomic_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/bvh_header.h"

namespace pushid {
namespace {

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

std::string SkeletonProblem(const BvhSkeleton& skeleton) {
  std::unordered_set<std::string> names;
  std::vector<int> path;  // from the root to the joint before
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    const BvhJoint& joint = skeleton.joints[i];
    if (joint.name.empty() || joint.name != Trimmed(joint.name) ||
        joint.name.find_first_of("{}\n\r") != std::string::npos) {
      return "the joint name " + Quoted(joint.name) + " cannot be written";
    }
    if (!names.insert(joint.name).second) {
      return "two joints are called " + Quoted(joint.name);
    }
    while (!path.empty() && path.back() != joint.parent) path.pop_back();
    if (path.empty() && joint.parent != -1) {
      return "joint " + Quoted(joint.name) + " is not in depth-first order";
    }
    path.push_back(static_cast<int>(i));
    if (!joint.offset.allFinite()) return "the offset of " + Quoted(joint.name) + " is not finite";
    for (const Eigen::Vector3d& end_site : joint.end_sites) {
      if (!end_site.allFinite()) return "an end site of " + Quoted(joint.name) + " is not finite";
    }
    for (std::size_t a = 0; a < joint.channels.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        if (joint.channels[a] == joint.channels[b]) {
          return "joint " + Quoted(joint.name) + " lists " + NameOf(joint.channels[a]) + " twice";
        }
      }
    }
  }
  if (skeleton.num_channels() == 0) return "no joint has any channels";
  return "";
}

std::string MotionProblem(const BvhMotion& motion) {
  const std::string problem = SkeletonProblem(motion.skeleton);
  if (!problem.empty()) return problem;
  if (motion.values.empty() || motion.values.size() % motion.skeleton.num_channels() != 0) {
    return "there are " + std::to_string(motion.values.size()) + " values for " +
           std::to_string(motion.skeleton.num_channels()) + " channels per frame";
  }
  for (std::size_t i = 0; i < motion.values.size(); ++i) {
    if (!std::isfinite(motion.values[i])) {
      return "a value of frame " + std::to_string(i / motion.skeleton.num_channels()) +
             " is not finite";
    }
  }
  return FrameTimeProblem(motion.frame_time_s);
}

class HierarchyWriter {
 public:
  HierarchyWriter(const BvhMotion& motion, LengthUnit unit) : motion_(motion), unit_(unit) {}

  std::string Write() {
    text_ = "HIERARCHY\n";
    const std::vector<BvhJoint>& joints = motion_.skeleton.joints;
    std::vector<int> path;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      while (!path.empty() && path.back() != joints[i].parent) {
        path.pop_back();
        Line(path.size(), "}");
      }
      const bool leaf = i + 1 == joints.size() || joints[i + 1].parent != static_cast<int>(i);
      Open(joints[i], path.size(), leaf);
      path.push_back(static_cast<int>(i));
    }
    while (!path.empty()) {
      path.pop_back();
      Line(path.size(), "}");
    }
    return std::move(text_);
  }

 private:
  void Line(std::size_t depth, const std::string& content) {
    text_.append(depth, '\t');
    text_ += content + "\n";
  }

  std::string OffsetText(const Eigen::Vector3d& offset) const {
    std::string text = "OFFSET";
    for (int axis = 0; axis < 3; ++axis) {
      text += ' ';
      AppendDouble(ConvertLength(offset[axis], motion_.length_unit, unit_), &text);
    }
    return text;
  }

  void Open(const BvhJoint& joint, std::size_t depth, bool leaf) {
    Line(depth, (depth == 0 ? "ROOT " : "JOINT ") + joint.name);
    Line(depth, "{");
    Line(depth + 1, OffsetText(joint.offset));
    std::string channels = "CHANNELS " + std::to_string(joint.channels.size());
    for (BvhChannel channel : joint.channels) channels += " " + NameOf(channel);
    Line(depth + 1, channels);
    for (const Eigen::Vector3d& end_site : joint.end_sites) EndSite(end_site, depth + 1);
    if (leaf && joint.end_sites.empty()) EndSite(Eigen::Vector3d::Zero(), depth + 1);
  }

  void EndSite(const Eigen::Vector3d& offset, std::size_t depth) {
    Line(depth, "End Site");
    Line(depth, "{");
    Line(depth + 1, OffsetText(offset));
    Line(depth, "}");
  }

  const BvhMotion& motion_;
  const LengthUnit unit_;
  std::string text_;
};

// The joint and channel that the value at `index` of a row belongs to, for messages.
std::string ChannelName(const BvhSkeleton& skeleton, int index) {
  for (const BvhJoint& joint : skeleton.joints) {
    const int count = static_cast<int>(joint.channels.size());
    if (index < count) return joint.name + " " + NameOf(joint.channels[index]);
    index -= count;
  }
  return "value " + std::to_string(index);
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
MaybeError ParseFrame(const LineReader& reader, std::string_view line, const BvhSkeleton& skeleton,
                      const std::vector<bool>& used, double* values) {
  const int count = static_cast<int>(used.size());
  const char* at = line.data();
  const char* const end = at + line.size();
  for (int i = 0;; ++i) {
    while (at != end && IsBlank(*at)) ++at;
    if (at == end) {
      if (i == count) return std::nullopt;
      return reader.ErrorHere("the row has " + std::to_string(i) + " numbers, not " +
                              std::to_string(count) + ": the file is truncated or damaged");
    }
    if (i == count) {
      return reader.ErrorHere("the row has more than the " + std::to_string(count) +
                              " numbers that the hierarchy's channels ask for");
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
      return reader.ErrorHere("number " + std::to_string(i + 1) + " of the row (" +
                              ChannelName(skeleton, i) + "): " + NumberProblem(token));
    }
    at += token.size();
  }
}

// Calls take_row(values) for every row; checks that there are as many as announced. used: which
// values take_row needs; whole_row: the row, from 0, of which it needs all; -1: none.
template <typename TakeRow>
MaybeError ReadFrames(LineReader* reader, const BvhHeader& header, const std::vector<bool>& used,
                      int whole_row, const TakeRow& take_row) {
  const std::vector<bool> everything(used.size(), true);
  std::vector<double> values(used.size());
  std::int64_t rows = 0;
  std::string_view line;
  while (reader->NextNonBlank(&line)) {
    if (rows == header.num_frames) {
      return reader->ErrorHere("wrong frame count: Frames: is " +
                               std::to_string(header.num_frames) + ", but here is one row more");
    }
    if (MaybeError failed = ParseFrame(*reader, line, header.skeleton,
                                       rows == whole_row ? everything : used, values.data())) {
      return failed;
    }
    take_row(values);
    ++rows;
  }
  if (reader->error()) return reader->error();
  if (rows < header.num_frames) {
    return reader->ErrorHere("wrong frame count: Frames: is " + std::to_string(header.num_frames) +
                             ", but the file ends after " + std::to_string(rows) +
                             ": it is truncated, or the count is wrong");
  }
  return std::nullopt;
}

// The announced number of frames, but no more than a file of this size can hold: memory is not
// handed out on a claim. Every number takes a digit and a separator.
std::size_t FramesToReserve(const LineReader& reader, const BvhHeader& header) {
  const std::int64_t possible = reader.file_size() / (2 * header.skeleton.num_channels()) + 1;
  return static_cast<std::size_t>(std::min(header.num_frames, possible));
}

Result<std::vector<int>> ChooseJoints(const std::string& path, const BvhSkeleton& skeleton,
                                      const BvhPositionOptions& options) {
  if (options.choose_joints) return options.choose_joints(skeleton);
  std::vector<int> chosen;
  for (const std::string& name : options.joints) {
    const int joint = skeleton.Find(name);
    if (joint < 0) return UnknownNameError(path, "joint", skeleton.Names(), name);
    chosen.push_back(joint);
  }
  if (options.joints.empty()) {
    for (std::size_t i = 0; i < skeleton.joints.size(); ++i) chosen.push_back(static_cast<int>(i));
  }
  return chosen;
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

MaybeError WriteBvh(const std::string& path, const BvhMotion& motion, LengthUnit unit) {
  const std::string problem = MotionProblem(motion);
  if (!problem.empty()) return Error{"the motion cannot be written: " + problem, path, 0};

  std::vector<bool> is_length;  // per channel
  for (const BvhJoint& joint : motion.skeleton.joints) {
    for (BvhChannel channel : joint.channels) is_length.push_back(!IsRotation(channel));
  }
  AtomicFile file;
  if (MaybeError failed = file.Open(path)) return failed;
  file.Append(HierarchyWriter(motion, unit).Write());
  file.Append("MOTION\nFrames: " + std::to_string(motion.num_frames()) +
              "\nFrame Time: " + DoubleText(motion.frame_time_s) + "\n");
  std::string row;
  for (std::size_t i = 0; i < motion.values.size(); ++i) {
    const std::size_t channel = i % is_length.size();
    const double value = motion.values[i];
    AppendDouble(is_length[channel] ? ConvertLength(value, motion.length_unit, unit) : value, &row);
    row += channel + 1 == is_length.size() ? '\n' : ' ';
    if (channel + 1 == is_length.size()) {
      file.Append(row);
      row.clear();
    }
  }
  return file.Commit();
}

Result<BvhMotion> ReadBvh(const std::string& path, const BvhReadOptions& options) {
  LineReader reader;
  if (MaybeError failed = reader.Open(path)) return *std::move(failed);
  Result<BvhHeader> header = ReadBvhHeader(&reader);
  if (!header.ok()) return header.error();

  BvhMotion motion;
  motion.length_unit = options.length_unit;
  motion.frame_time_s = header.value().frame_time_s;
  motion.values.reserve(FramesToReserve(reader, header.value()) *
                        header.value().skeleton.num_channels());
  const std::vector<bool> everything(header.value().skeleton.num_channels(), true);
  MaybeError failed =
      ReadFrames(&reader, header.value(), everything, -1, [&motion](const auto& values) {
        motion.values.insert(motion.values.end(), values.begin(), values.end());
      });
  if (failed) return *std::move(failed);
  motion.skeleton = std::move(header.value().skeleton);
  return motion;
}

Result<BvhPositions> ReadBvhPositions(const std::string& path, const BvhPositionOptions& options) {
  LineReader reader;
  if (MaybeError failed = reader.Open(path)) return *std::move(failed);
  Result<BvhHeader> header = ReadBvhHeader(&reader);
  if (!header.ok()) return header.error();
  Result<std::vector<int>> chosen = ChooseJoints(path, header.value().skeleton, options);
  if (!chosen.ok()) return chosen.error();

  BvhPositions result;
  result.frame_time_s = header.value().frame_time_s;
  result.joints = chosen.value();
  result.positions.resize(result.joints.size());
  for (auto& track : result.positions) track.reserve(FramesToReserve(reader, header.value()));

  const double metres =
      options.metres_per_unit > 0.0 ? options.metres_per_unit : MetresPer(options.length_unit);
  BvhKinematics kinematics(header.value().skeleton, metres, result.joints);
  int frame = 0;
  std::vector<Eigen::Vector3d> positions(result.joints.size());
  const auto take_row = [&](const std::vector<double>& values) {
    kinematics.Positions(values.data(), positions.data());
    if (frame++ == options.kept_frame) result.kept_values = values;
    for (std::size_t i = 0; i < positions.size(); ++i) result.positions[i].push_back(positions[i]);
  };
  MaybeError failed =
      ReadFrames(&reader, header.value(), kinematics.UsedValues(), options.kept_frame, take_row);
  if (failed) return *std::move(failed);
  result.skeleton = std::move(header.value().skeleton);
  result.content_hash = reader.HashHex();
  return result;
}

}  // namespace pushid
