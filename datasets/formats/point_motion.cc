// datasets: trajectories of named points, in tables and in TRC files.
#include "datasets/formats/point_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "datasets/files/input_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

// The ends of the names of a point's three columns, by the first of them; empty: it is none.
// OpenSim flattens points to LASI_1, LASI_2 and LASI_3.
std::string AxesOf(const std::string& name) {
  return EndsWith(name, "x")    ? "xyz"
         : EndsWith(name, "X")  ? "XYZ"
         : EndsWith(name, "_1") ? "123"
                                : "";
}

std::vector<TablePoint> NamedPoints(const std::string& path, const std::vector<std::string>& names,
                                    const std::vector<PointColumns>& wanted) {
  std::vector<TablePoint> points;
  for (const PointColumns& one : wanted) {
    TablePoint& point = points.emplace_back();
    point.name = one.name;
    const std::string* columns[] = {&one.x, &one.y, &one.z};
    for (int axis = 0; axis < 3; ++axis) {
      const auto found = std::find(names.begin(), names.end(), *columns[axis]);
      if (found == names.end()) throw UnknownNameError(path, "column", names, *columns[axis]);
      point.columns[axis] = static_cast<int>(found - names.begin());
    }
  }
  return points;
}

Result<PointMotion> ReadTablePoints(const std::string& path, TableFormat format,
                                    const PointReadOptions& options) {
  return Caught([&] {
    PointMotion motion;
    motion.path = path;
    int time_column = -1;
    // Columns x, y and z of each of the chosen points, and then the time.
    const auto choose = [&](const std::vector<std::string>& names) {
      const std::vector<TablePoint> points =
          options.columns.empty() ? PointsOf(names) : NamedPoints(path, names, options.columns);
      time_column = FindTimeColumn(names, options.time_column);
      if (time_column < 0 && !options.time_column.empty()) {
        throw Error{"there is no column '" + options.time_column + "' for the time", path};
      }
      for (const TablePoint& point : points) motion.names.push_back(point.name);
      if (!points.empty()) ChoosePoints(options, &motion);
      std::vector<int> columns;
      for (int index : motion.chosen) {
        columns.insert(columns.end(), points[index].columns, points[index].columns + 3);
      }
      if (time_column >= 0) columns.push_back(time_column);
      if (columns.empty() && !names.empty()) columns.push_back(0);  // counts the rows
      return columns;
    };
    const NumericTable table = OrThrow(ReadNumericTable(path, format, choose));
    motion.content_hash = table.content_hash;
    if (time_column >= 0) {
      motion.rate_hz = 1.0 / OrThrow(EvenTimeStep(table, time_column));
      motion.first_time_s = table.data.back().front();
    }
    for (std::size_t i = 0; i < motion.chosen.size(); ++i) {
      const std::vector<double>*x = &table.data[3 * i], *y = x + 1, *z = x + 2;
      std::vector<Eigen::Vector3d>& track = motion.positions.emplace_back();
      for (int row = 0; row < table.num_rows(); ++row) {
        track.push_back(SeenPosition({(*x)[row], (*y)[row], (*z)[row]}));
      }
    }
    return motion;
  });
}

constexpr double kRateTolerance = 0.01;
constexpr std::int64_t kMostMarkers = 100000;

std::vector<std::string_view> TabFields(std::string_view line) {
  std::vector<std::string_view> fields = CellsOf(line, '\t');
  while (!fields.empty() && fields.back().empty()) fields.pop_back();
  return fields;
}

class TrcReader {
 public:
  TrcReader(const std::string& path, const PointReadOptions& options)
      : options_(options), reader_(path) {
    motion_.path = path;
  }

  PointMotion Read() {
    ReadHead();
    ReadNames();
    ReadRows();
    motion_.content_hash = reader_.HashHex();
    return std::move(motion_);
  }

 private:
  [[noreturn]] void Fail(const std::string& problem) const { throw reader_.ErrorHere(problem); }

  // The next line that is not blank, in fields.
  std::vector<std::string_view> Next(const std::string& what) {
    std::string_view line;
    if (reader_.NextNonBlank(&line)) return TabFields(line);
    Fail("the file ends where " + what + " should be: it is truncated");
  }

  void ReadHead() {
    const std::vector<std::string_view> head = Next("PathFileType");
    if (head.empty() || !EqualsIgnoringCase(head[0], "PathFileType")) {
      Fail("a TRC file starts with PathFileType and tabs");
    }
    std::vector<std::string> keys;
    for (const std::string_view key : Next("DataRate")) keys.emplace_back(key);
    const std::vector<std::string_view> fields = Next("the values of DataRate, NumFrames, ...");
    double frames = -1.0, markers = -1.0;
    for (std::size_t i = 0; i < keys.size() && i < fields.size(); ++i) {
      double number = 0.0;
      const bool is_number = ParseDouble(fields[i], &number);
      if (keys[i] == "DataRate" && is_number) motion_.rate_hz = number;
      if (keys[i] == "NumFrames" && is_number) frames = number;
      if (keys[i] == "NumMarkers" && is_number) markers = number;
      if (keys[i] == "Units") motion_.unit_text = std::string(fields[i]);
    }
    if (!(motion_.rate_hz > 0.0 && motion_.rate_hz <= 1e5)) {
      Fail("DataRate must be a number of frames per second above 0; tabs separate cells");
    }
    if (!(frames >= 1.0 && frames <= 2e9) || !(markers >= 1.0 && markers <= kMostMarkers)) {
      Fail("NumFrames and NumMarkers must be 1 or more");
    }
    num_frames_ = static_cast<std::int64_t>(frames);
    num_markers_ = static_cast<std::int64_t>(markers);
    motion_.unit = FromName<LengthUnit>(motion_.unit_text);
  }

  void ReadNames() {
    const std::vector<std::string_view> fields = Next("Frame#, Time and the markers");
    if (fields.size() < 3 || !EqualsIgnoringCase(fields[0].substr(0, 5), "Frame") ||
        !EqualsIgnoringCase(fields[1], "Time")) {
      Fail("Frame#, Time and the names of the markers are expected here");
    }
    for (std::size_t i = 2; i < fields.size(); ++i) {
      if (!fields[i].empty()) motion_.names.emplace_back(fields[i]);
    }
    if (static_cast<std::int64_t>(motion_.names.size()) != num_markers_) {
      Fail(StrCat("NumMarkers is ", num_markers_, ", but ", motion_.names.size(),
                  " markers are named here"));
    }
    Next("X1, Y1, Z1, ...");
    ChoosePoints(options_, &motion_);
    motion_.positions.resize(motion_.chosen.size());
  }

  void ReadRows() {
    row_.resize(3 * num_markers_);
    std::int64_t rows = 0;
    const std::string wrong = StrCat("wrong frame count: NumFrames is ", num_frames_, ", but ");
    for (std::string_view line; reader_.NextNonBlank(&line);) {
      if (++rows > num_frames_) Fail(wrong + "here is one row more");
      ReadRow(line, rows);
    }
    if (rows < num_frames_) {
      Fail(StrCat(wrong, "the file ends after ", rows, ": it is truncated, or the count is wrong"));
    }
    // Times may be rounded to a millisecond.
    const double span = last_time_s_ - motion_.first_time_s;
    if (rows < 3 || !(span > 0.0)) return;
    const double step = span / static_cast<double>(rows - 1);
    if (std::fabs(step * motion_.rate_hz - 1.0) <= kRateTolerance + 1e-3 / span) return;
    Fail("Time grows by " + Rounded(step) + " s a row, " + Rounded(1.0 / step) +
         " rows a second, but DataRate is " + Rounded(motion_.rate_hz) +
         "; correct the one that is wrong");
  }

  // Frame# grows by 1, or by what it grows in the first row of a file with every n-th frame, which
  // is one row by Time; Time by a row, rounded to a millisecond.
  void CheckSequence(double frame, double time, std::int64_t rows) {
    const double from = std::exchange(last_frame_, frame),
                 since = std::exchange(last_time_s_, time);
    const double frames = frame - from, seconds = time - since, row_s = 1.0 / motion_.rate_hz;
    if (rows == 1) motion_.first_time_s = time;
    if (rows == 2) {
      usual_s_ = std::max(seconds, row_s);
      if (seconds > 0.0 && seconds < 1.5 * row_s && frames >= 0.0) usual_frames_ = frames;
    }
    const bool jumps = frames != usual_frames_;
    if (rows < 2 || (!jumps && seconds >= 0.0 && seconds <= 1.5 * usual_s_ + 1.1e-3)) return;
    const bool back = jumps ? frames <= 0.0 : seconds < 0.0;
    Fail((back ? "rows are in another order here: " : "rows are missing before this one: ") +
         (jumps ? "Frame# goes from " + Rounded(from, 9) + " to " + Rounded(frame, 9)
                : "Time goes from " + Rounded(since, 9) + " to " + Rounded(time, 9) + " s"));
  }

  void ReadRow(std::string_view line, std::int64_t rows) {
    const std::size_t expected = row_.size() + 2;
    const std::size_t cells = 1 + std::count(line.begin(), line.end(), '\t');
    // Rows may leave out the tabs of markers not seen, so only its newline tells that a shorter one
    // is whole.
    if (!reader_.ended_in_newline() && cells < expected) {
      Fail(StrCat(
          "the file ends after ", cells, " of the ", expected,
          " cells of its last row, without a newline: it is truncated; export it again, or end "
          "the row with a newline if it only leaves out markers not seen"));
    }
    const std::vector<std::string_view> fields = TabFields(line);
    if (fields.size() < 2 || fields.size() > expected) {
      Fail(StrCat("the row has ", fields.size(), " cells, not ", expected, ", separated by tabs"));
    }
    double numbers[2] = {0.0, 0.0};
    for (int i = 0; i < 2; ++i) {
      if (ParseDouble(fields[i], &numbers[i])) continue;
      Fail((i == 0 ? "Frame#: " : "Time: ") + NumberProblem(fields[i]));
    }
    CheckSequence(numbers[0], numbers[1], rows);
    for (std::size_t i = 0; i < row_.size(); ++i) {
      const std::string_view cell = i + 2 < fields.size() ? fields[i + 2] : "";
      if (cell.empty() || EqualsIgnoringCase(cell, "nan")) {
        row_[i] = std::numeric_limits<double>::quiet_NaN();
      } else if (!ParseDouble(cell, &row_[i])) {
        Fail(motion_.names[i / 3] + ": " + NumberProblem(cell) + kMissingCell);
      }
    }
    for (std::int64_t marker = 0; marker < num_markers_; ++marker) {
      const double* at = row_.data() + 3 * marker;
      const int missing = std::isnan(at[0]) + std::isnan(at[1]) + std::isnan(at[2]);
      if (missing == 0 || missing == 3) continue;
      Fail(StrCat(
          motion_.names[marker], ": ", missing, " of its 3 cells ", missing == 1 ? "is" : "are",
          " missing: the row is cut or damaged; export the file again, or leave all 3 empty where "
          "the marker was not seen"));
    }
    for (std::size_t i = 0; i < motion_.chosen.size(); ++i) {
      const double* at = row_.data() + 3 * motion_.chosen[i];
      // Some programs write zeros where a point was not seen.
      motion_.positions[i].push_back(SeenPosition({at[0], at[1], at[2]}));
    }
  }

  const PointReadOptions& options_;
  LineReader reader_;
  PointMotion motion_;
  std::int64_t num_frames_ = 0, num_markers_ = 0;
  double last_frame_ = 0.0, last_time_s_ = 0.0;
  double usual_frames_ = 1.0, usual_s_ = 0.0;  // from row to row
  std::vector<double> row_;                    // x, y, z of every marker
};

}  // namespace

void ChoosePoints(const PointReadOptions& options, PointMotion* motion) {
  motion->chosen.resize(motion->names.size());
  std::iota(motion->chosen.begin(), motion->chosen.end(), 0);
  if (options.choose) motion->chosen = options.choose(*motion);
}

Eigen::Vector3d SeenPosition(const Eigen::Vector3d& position) {
  const bool seen = position.allFinite() && !position.isZero(0.0);
  return seen ? position : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
}

std::vector<TablePoint> PointsOf(const std::vector<std::string>& names) {
  std::unordered_map<std::string, int> index;
  for (std::size_t i = 0; i < names.size(); ++i) index.emplace(names[i], static_cast<int>(i));
  std::vector<TablePoint> points;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string axes = AxesOf(names[i]), stem = names[i].substr(0, names[i].size() - 1);
    if (axes.empty() || stem.empty()) continue;
    const auto y = index.find(stem + axes[1]), z = index.find(stem + axes[2]);
    if (y == index.end() || z == index.end()) continue;
    if (axes == "123" && index.count(stem + "4") > 0) continue;
    const std::string name = stem.substr(0, stem.find_last_not_of("_.:- ") + 1);
    if (name.empty()) continue;
    points.push_back({name, {static_cast<int>(i), y->second, z->second}});
  }
  return points;
}

bool IsForceColumn(const std::string& name) {
  if (!Holds(name, "force")) return false;
  const std::size_t end = name.size();
  return end < 3 || name[end - 3] != '_' || name[end - 2] != 'p';
}

// Forces are told by their names: those with "force" in them, a platform's ("left_v" or "left_f"),
// and beside it its centre of pressure and moments ("left_p", "left_m").
PointMotion WithoutForces(const PointMotion& motion) {
  PointMotion points = motion;
  points.names.clear();
  points.chosen.clear();
  points.positions.clear();
  const auto there = [&motion](const std::string& name) {
    return std::find(motion.names.begin(), motion.names.end(), name) != motion.names.end();
  };
  for (std::size_t i = 0; i < motion.names.size(); ++i) {
    const std::string& name = motion.names[i];
    if (Holds(name, "force") || Holds(name, "torque") || Holds(name, "moment")) continue;
    const std::string prefix = name.substr(0, name.size() - 1);
    if (Holds("vfpm", name.substr(prefix.size())) && (prefix.empty() || prefix.back() == '_') &&
        (there(prefix + 'v') || there(prefix + 'f'))) {
      continue;
    }
    points.chosen.push_back(static_cast<int>(points.names.size()));
    points.names.push_back(name);
    points.positions.push_back(motion.positions[i]);
  }
  return points;
}

Result<PointMotion> ReadCsvPoints(const std::string& path, const PointReadOptions& options) {
  return ReadTablePoints(path, TableFormat::kCsv, options);
}

Result<PointMotion> ReadStoragePoints(const std::string& path, const PointReadOptions& options) {
  return ReadTablePoints(path, TableFormat::kStorage, options);
}

Result<PointMotion> ReadTrc(const std::string& path, const PointReadOptions& options) {
  return Caught([&] { return TrcReader(path, options).Read(); });
}

}  // namespace pushid
