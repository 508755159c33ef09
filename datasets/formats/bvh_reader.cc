// datasets: the rows of a BVH file, read one at a time.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/bvh.h"

namespace pushid {
namespace {

// Which joint and channel the value at `index` of a row belongs to, for messages.
std::string ChannelName(const BvhSkeleton& skeleton, int index) {
  for (const BvhJoint& joint : skeleton.joints) {
    const int count = static_cast<int>(joint.channels.size());
    if (index < count) return joint.name + " " + NameOf(joint.channels[index]);
    index -= count;
  }
  return "value " + std::to_string(index);
}

// The end of a plain decimal number (-digits.digits of at most 32 characters, so finite), as nearly
// all are; null of anything else, which std::from_chars then judges.
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
    // Rare: a leading plus, or no number at all.
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

// Indices of the joints the options ask for.
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
