// datasets: points and pushes of Motion-BIDS tables, in and out.
#include "datasets/formats/motion_bids.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "datasets/files/atomic_file.h"
#include "datasets/files/input_file.h"
#include "datasets/files/json_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/point_motion.h"

namespace pushid {
namespace {

constexpr std::array<const char*, 4> kPushChannels = {"push_fx", "push_fy", "push_ftheta",
                                                      "push_fphi"};
constexpr std::array<const char*, 4> kPushUnits = {"N", "N", "N m", "N m"};
constexpr std::array<const char*, 4> kPushComponents = {"x", "y", "n/a", "n/a"};

int AxisNamed(const std::string& component) {
  if (component.size() != 1) return -1;
  const char axis = static_cast<char>(component[0] | 0x20);
  return axis >= 'x' && axis <= 'z' ? axis - 'x' : -1;
}

// Tracked points whose position has all three components, in the order of their first.
std::vector<TablePoint> TrackedPoints(const std::vector<BidsChannel>& channels) {
  std::vector<TablePoint> points;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const int axis = AxisNamed(channels[i].component);
    if (!EqualsIgnoringCase(channels[i].type, "POS") || axis < 0) continue;
    auto found = std::find_if(points.begin(), points.end(), [&](const TablePoint& point) {
      return point.name == channels[i].tracked_point;
    });
    if (found == points.end()) found = points.insert(points.end(), {channels[i].tracked_point});
    found->columns[axis] = static_cast<int>(i);
  }
  points.erase(std::remove_if(points.begin(), points.end(),
                              [](const TablePoint& point) {
                                return *std::min_element(point.columns, point.columns + 3) < 0;
                              }),
               points.end());
  return points;
}

// The unit that all positions have.
MaybeError SetUnit(const std::string& path, const BidsHeader& header, PointMotion* motion) {
  for (const BidsChannel& channel : header.channels) {
    if (!EqualsIgnoringCase(channel.type, "POS")) continue;
    if (!motion->unit_text.empty() && channel.units != motion->unit_text) {
      return Error{"positions are in " + Quoted(motion->unit_text) + " and in " +
                       Quoted(channel.units) + "; give all of them in one unit",
                   path};
    }
    motion->unit_text = channel.units;
  }
  motion->unit = FromName<LengthUnit>(motion->unit_text);
  return std::nullopt;
}

Error MissingPushChannels(const std::string& path, const std::vector<std::string>& names) {
  return Error{
      "a push needs the channels push_fx, push_fy, push_ftheta and push_fphi; the file has " +
          ListOfNames(names),
      path};
}

// No value where nothing is given, else all four.
Result<std::vector<TimedForce>> Runs(const NumericTable& table) {
  std::vector<TimedForce> pushes;
  bool inside = false;
  for (int row = 0; row < table.num_rows(); ++row) {
    Eigen::Vector4d force;
    for (int i = 0; i < 4; ++i) force[i] = table.data[i][row];
    const auto given = force.array().isFinite().count();
    if (given != 0 && given != 4) {
      return Error{"some of the push's four channels have no value here; give all or none",
                   table.path, table.lines[row]};
    }
    if (given == 4 && !inside) pushes.push_back({row, {}});
    inside = given == 4;
    if (inside) pushes.back().force.push_back(force);
  }
  if (pushes.empty()) return Error{"the channels of the push have no value at all", table.path};
  return pushes;
}

struct Column {
  BidsChannel channel;
  std::vector<double> values;
};

std::vector<Column> PointColumnsOf(const PointMotion& motion) {
  std::vector<Column> columns;
  for (std::size_t i = 0; i < motion.names.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::string component(1, "xyz"[axis]);
      Column column{
          {motion.names[i] + "_POS_" + component, component, "POS", motion.names[i], "m", "world"},
          {}};
      for (const Eigen::Vector3d& at : motion.positions[i]) column.values.push_back(at[axis]);
      columns.push_back(std::move(column));
    }
  }
  return columns;
}

Result<std::vector<Column>> PushColumnsOf(const std::string& path, int frames,
                                          const std::vector<TimedForce>& pushes) {
  std::vector<Column> columns;
  if (pushes.empty()) return columns;
  for (int i = 0; i < 4; ++i) {
    columns.push_back(
        {{kPushChannels[i], kPushComponents[i], "MISC", "push", kPushUnits[i], "world"},
         std::vector<double>(frames, std::nan(""))});
  }
  for (const TimedForce& push : pushes) {
    for (std::size_t row = 0; row < push.force.size(); ++row) {
      const std::size_t frame = push.start_frame + row;
      if (frame >= static_cast<std::size_t>(frames)) break;
      if (!std::isnan(columns[0].values[frame])) {
        return Error{"two pushes on one person overlap, which one set of channels cannot hold",
                     path};
      }
      for (int i = 0; i < 4; ++i) columns[i].values[frame] = push.force[row][i];
    }
  }
  return columns;
}

std::string TableText(const std::vector<Column>& columns, int frames) {
  std::string text;
  for (int frame = 0; frame < frames; ++frame) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (i > 0) text += '\t';
      const double value = columns[i].values[frame];
      if (std::isfinite(value))
        AppendDouble(value, &text);
      else
        text += "n/a";
    }
    text += '\n';
  }
  return text;
}

std::string ChannelsText(const std::vector<Column>& columns) {
  std::string text = "name\tcomponent\ttype\ttracked_point\tunits\treference_frame\n";
  for (const Column& column : columns) {
    const BidsChannel& c = column.channel;
    text += c.name + '\t' + c.component + '\t' + c.type + '\t' + c.tracked_point + '\t' + c.units +
            '\t' + c.reference_frame + '\n';
  }
  return text;
}

nlohmann::ordered_json MotionJson(const std::string& task, const PointMotion& motion,
                                  std::size_t push_channels) {
  nlohmann::ordered_json json;
  json["TaskName"] = task;
  json["SamplingFrequency"] = motion.rate_hz;
  json["MotionChannelCount"] = 3 * motion.names.size() + push_channels;
  json["POSChannelCount"] = 3 * motion.names.size();
  if (push_channels > 0) json["MISCChannelCount"] = push_channels;
  json["TrackedPointsCount"] = motion.names.size();
  json["RecordingDuration"] = motion.num_frames() / motion.rate_hz;
  json["MissingValues"] = "n/a";
  return json;
}

// x forward (anterior), y left, z up (superior).
nlohmann::ordered_json FramesJson() {
  nlohmann::ordered_json json;
  json["reference_frame"]["Levels"]["world"] = {
      {"SpatialAxes", "ALS"}, {"RotationOrder", "n/a"}, {"RotationRule", "n/a"}};
  return json;
}

}  // namespace

Result<NumericTable> ReadBidsTable(const std::string& motion_path, const BidsHeader& header,
                                   const TableReadOptions& options) {
  TableReadOptions named = options;
  for (const BidsChannel& channel : header.channels) named.names.push_back(channel.name);
  return ReadNumericTable(motion_path, TableFormat::kCsv, named);
}

Result<PointMotion> ReadMotionBids(const std::string& path, const PointReadOptions& options) {
  const Result<BidsHeader> header = ReadBidsHeader(path);
  if (!header.ok()) return header.error();
  PointMotion motion;
  motion.path = path;
  motion.rate_hz = header.value().rate_hz;
  motion.up = header.value().up;
  if (MaybeError failed = SetUnit(path, header.value(), &motion)) return *std::move(failed);
  const std::vector<TablePoint> points = TrackedPoints(header.value().channels);
  for (const TablePoint& point : points) motion.names.push_back(point.name);
  if (points.empty()) return motion;
  if (MaybeError failed = ChoosePoints(options, &motion)) return *std::move(failed);
  TableReadOptions table_options;
  table_options.choose = [&](const std::vector<std::string>&) -> Result<std::vector<int>> {
    std::vector<int> columns = ColumnsOf(points, motion.chosen);
    if (columns.empty()) columns.push_back(0);  // counts the rows
    return columns;
  };
  const Result<NumericTable> table = ReadBidsTable(path, header.value(), table_options);
  if (!table.ok()) return table.error();
  double missing = std::nan("");
  if (!ParseDouble(header.value().missing, &missing)) missing = std::nan("");
  TakeTracks(table.value(), missing, &motion);
  ContentHash hash;
  hash.Add(table.value().content_hash);
  hash.Add(header.value().content_hash);
  motion.content_hash = hash.Hex();
  return motion;
}

Result<std::vector<TimedForce>> ReadBidsPushes(const std::string& path) {
  const Result<BidsHeader> header = ReadBidsHeader(path);
  if (!header.ok()) return header.error();
  TableReadOptions options;
  options.keep_lines = true;
  options.choose = [&](const std::vector<std::string>& names) -> Result<std::vector<int>> {
    std::vector<int> columns;
    for (const char* name : kPushChannels) {
      const auto found = std::find(names.begin(), names.end(), name);
      if (found == names.end()) return MissingPushChannels(path, names);
      columns.push_back(static_cast<int>(found - names.begin()));
    }
    return columns;
  };
  const Result<NumericTable> table = ReadBidsTable(path, header.value(), options);
  if (!table.ok()) return table.error();
  return Runs(table.value());
}

MaybeError WriteMotionBids(const std::string& stem, const std::string& task,
                           const PointMotion& motion, const std::vector<TimedForce>& pushes) {
  const std::string path = stem + "_motion.tsv";
  if (std::set<std::string>(motion.names.begin(), motion.names.end()).size() !=
      motion.names.size()) {
    return Error{"two points have the same name, which Motion-BIDS identifies them by", path};
  }
  std::vector<Column> columns = PointColumnsOf(motion);
  const Result<std::vector<Column>> push = PushColumnsOf(path, motion.num_frames(), pushes);
  if (!push.ok()) return push.error();
  columns.insert(columns.end(), push.value().begin(), push.value().end());
  if (MaybeError failed =
          WriteJson(stem + "_motion.json", MotionJson(task, motion, push.value().size()))) {
    return failed;
  }
  if (MaybeError failed = WriteJson(stem + "_channels.json", FramesJson())) return failed;
  if (MaybeError failed = WriteFileAtomically(stem + "_channels.tsv", ChannelsText(columns))) {
    return failed;
  }
  return WriteFileAtomically(path, TableText(columns, motion.num_frames()));
}

}  // namespace pushid
