// datasets: trajectories of crowds.
#include "datasets/formats/trajectories.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "datasets/files/atomic_file.h"
#include "datasets/files/input_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/units.h"

namespace pushid {
namespace {

// People are there for a part of the time; a file of a few rows does not fill the memory.
constexpr double kMostFramesPerRow = 1000.0, kFewFrames = 1e6;
constexpr double kClosestPeople = 0.05, kFarApart = 5.0;  // m

// The first number of the comment's words.
double NumberIn(std::string_view comment) {
  for (std::string_view word = NextToken(&comment); !word.empty(); word = NextToken(&comment)) {
    double number = 0.0;
    if (ParseDouble(word, &number)) return number;
  }
  return 0.0;
}

// Whether a comment has whole words: "in m" is not in "in munich" or "in m/s".
bool HoldsWords(std::string_view text, std::string_view words) {
  const std::size_t at = text.find(words);
  if (at == std::string_view::npos) return false;
  const auto in_word = [](unsigned char c) { return std::isalnum(c) != 0 || c == '/' || c > '~'; };
  const std::string_view rest = text.substr(at + words.size());
  const bool part = (at > 0 && in_word(text[at - 1])) || (!rest.empty() && in_word(rest[0]));
  return !part || HoldsWords(rest, words);
}

// Throws an Error at another unit than that of a comment before it.
void ReadComment(const LineReader& reader, std::string_view comment, PointMotion* motion) {
  if (Holds(comment, "framerate") && motion->rate_hz == 0.0) motion->rate_hz = NumberIn(comment);
  for (const LengthUnitRow& unit : kLengthUnits) {
    const std::string name = unit.name;
    if (HoldsWords(comment, "x/" + name) || Holds(comment, "x[" + name + "]") ||
        Holds(comment, "x(" + name + ")") || HoldsWords(comment, "in " + name)) {
      if (motion->unit && *motion->unit != unit.value) {
        throw reader.ErrorHere("lengths are in " + name + ", but in " + NameOf(*motion->unit) +
                               " by a line before");
      }
      motion->unit = unit.value;
      return;
    }
  }
}

using Tracks = std::map<std::int64_t, std::map<std::int64_t, Eigen::Vector3d>>;  // by id and frame
using Times = std::map<std::int64_t, double>;                                    // s, of frames

// Sets names, chosen, positions and first_time_s (by rate_hz, which is set before).
void TakeTracks(const Tracks& people, const PointReadOptions& options, PointMotion* motion) {
  if (people.empty()) throw Error{"the file contains no positions", motion->path};
  std::vector<const Tracks::mapped_type*> tracks;
  std::int64_t first = people.begin()->second.begin()->first, last = first;
  std::size_t rows = 0;
  for (const auto& [id, track] : people) {
    motion->names.push_back(std::to_string(id));
    tracks.push_back(&track);
    first = std::min(first, track.begin()->first);
    last = std::max(last, track.rbegin()->first);
    rows += track.size();
  }
  ChoosePoints(options, motion);
  // Differences of whole numbers as text has them may overflow.
  const double frames = static_cast<double>(last) - static_cast<double>(first) + 1.0;
  if (frames * static_cast<double>(motion->chosen.size()) >
      kFewFrames + kMostFramesPerRow * static_cast<double>(rows)) {
    throw Error{
        StrCat("frames go from ", first, " to ", last, ", which is too many for ", rows, " rows"),
        motion->path};
  }
  motion->first_time_s = static_cast<double>(first) / motion->rate_hz;
  for (int person : motion->chosen) {
    auto& track = motion->positions.emplace_back(static_cast<std::size_t>(frames),
                                                 SeenPosition(Eigen::Vector3d::Zero()));  // unseen
    for (const auto& [frame, position] : *tracks[person]) track[frame - first] = position;
  }
}

// The cells of a row by what they hold; -1: none does.
struct Columns {
  int id = 0, frame = 1, time = -1, axis[3] = {2, 3, 4};
};

// Cells are separated by semicolons, by commas, or by white space.
std::vector<std::string_view> CellsOfRow(std::string_view line) {
  for (char separator : {';', ','}) {
    if (line.find(separator) != std::string_view::npos) return CellsOf(line, separator);
  }
  return CellsOf(line, kBlanks);
}

// The columns that a header names, whatever unit it gives them ("x/cm"); none where it lacks one.
std::optional<Columns> NamedColumns(std::string_view line) {
  if (line.empty() || (line[0] != '"' && !std::isalpha(static_cast<unsigned char>(line[0])))) {
    return std::nullopt;
  }
  const std::vector<std::string_view> cells = CellsOfRow(line);
  const auto at = [&cells](std::string_view name) {
    for (size_t i = 0; i < cells.size(); ++i) {
      const std::string_view called = cells[i].substr(0, cells[i].find_first_of("/[("));
      if (PlainName(called) == name) return static_cast<int>(i);
    }
    return -1;
  };
  const Columns found{at("id"), at("frame"), at("time"), {at("x"), at("y"), at("z")}};
  if (std::min({found.id, found.frame, found.axis[0], found.axis[1]}) < 0) return std::nullopt;
  return found;
}

void ReadRow(const LineReader& reader, std::string_view line, const Columns& columns,
             Tracks* tracks, Times* times) {
  const std::vector<std::string_view> cells = CellsOfRow(line);
  const auto cell = [&cells](int column) {
    return column < 0 || column >= static_cast<int>(cells.size()) ? std::string_view()
                                                                  : cells[column];
  };
  std::int64_t id[2] = {0, 0};
  for (int i = 0; i < 2; ++i) {
    const std::string_view token = cell(i == 0 ? columns.id : columns.frame);
    double number = 0.0;
    if (!ParseDouble(token, &number) || number != std::floor(number) || std::fabs(number) > 1e15) {
      throw reader.ErrorHere(
          StrCat(i == 0 ? "the id" : "the frame", " must be a whole number, not ", Quoted(token),
                 "; a row is: id frame x y z, or what a header names (id,frame,x,y)"));
    }
    id[i] = static_cast<std::int64_t>(number);
  }
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const std::string_view token = cell(columns.axis[axis]);
    if (axis == 2 && token.empty()) break;
    if (token.empty()) throw reader.ErrorHere("the row is cut; a row is: id frame x y z");
    if (!ParseDouble(token, &position[axis])) {
      throw reader.ErrorHere(std::string(1, "xyz"[axis]) + ": " + NumberProblem(token));
    }
  }
  if (columns.time >= 0 && !ParseDouble(cell(columns.time), &(*times)[id[1]])) {
    throw reader.ErrorHere("time: " + NumberProblem(cell(columns.time)));
  }
  if ((*tracks)[id[0]].emplace(id[1], position).second) return;
  throw reader.ErrorHere(StrCat("person ", id[0], " was in frame ", id[1], " before"));
}

// The ids that are written for the points.
std::vector<std::int64_t> TrajectoryIds(const std::vector<std::string>& names) {
  std::vector<std::int64_t> ids(names.size());
  std::set<std::int64_t> seen;
  bool numbers = true;
  for (std::size_t i = 0; i < names.size(); ++i) {
    numbers = numbers && ParseInteger(names[i], &ids[i]) && seen.insert(ids[i]).second;
  }
  for (std::size_t i = 0; i < names.size() && !numbers; ++i) {
    ids[i] = static_cast<std::int64_t>(i);
  }
  return ids;
}

}  // namespace

bool IsCrowdCsv(const std::string& path) {
  const auto named = Caught([&] {
    LineReader reader(path);
    std::string_view line;
    return reader.NextRow(&line) && NamedColumns(line).has_value();
  });
  return named.ok() && named.value();
}

Result<PointMotion> ReadTrajectoryText(const std::string& path, const PointReadOptions& options) {
  return Caught([&] {
    LineReader reader(path);
    PointMotion motion;
    motion.path = path;
    Tracks tracks;
    Times times;
    Columns columns;
    for (std::string_view line; reader.NextNonBlank(&line);) {
      line = Trimmed(line);
      if (line.front() == '#') {
        ReadComment(reader, line.substr(1), &motion);
      } else if (const std::optional<Columns> named = NamedColumns(line)) {
        columns = *named;
        ReadComment(reader, line, &motion);
      } else {
        ReadRow(reader, line, columns, &tracks, &times);
      }
    }
    if (!motion.unit) motion.unit = LengthUnit::kMetre;
    if (motion.rate_hz == 0.0 && times.size() > 1) {
      const auto &first = *times.begin(), &last = *times.rbegin();
      motion.rate_hz = WholeFrameRate(static_cast<double>(last.first - first.first) /
                                      (last.second - first.second));
    }
    if (!FrameRateProblem(motion.rate_hz).empty()) {
      throw Error{
          "no comment gives the frames per second as a number; there must be a line such as '# "
          "framerate: 16' at the top, or a column time (s)",
          path};
    }
    TakeTracks(tracks, options, &motion);
    motion.content_hash = reader.HashHex();
    return motion;
  });
}

MaybeError WriteTrajectoryText(const std::string& path, const PointMotion& motion) {
  const std::vector<std::int64_t> ids = TrajectoryIds(motion.names);
  std::string text = "# framerate: " + DoubleText(motion.rate_hz) + "\n";
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (std::to_string(ids[i]) == motion.names[i]) continue;
    text += StrCat("# person ", ids[i], ": ", motion.names[i], "\n");
  }
  text += "# id\tframe\tx/m\ty/m\tz/m\n";
  for (std::size_t i = 0; i < ids.size(); ++i) {
    for (int frame = 0; frame < motion.num_frames(); ++frame) {
      const Eigen::Vector3d& position = motion.positions[i][frame];
      if (!position.allFinite()) continue;
      text += StrCat(ids[i], '\t', frame);
      for (int axis = 0; axis < 3; ++axis) {
        text += '\t';
        AppendDouble(position[axis], &text);
      }
      text += '\n';
    }
  }
  return WriteFileAtomically(path, text);
}

std::int64_t FirstFrame(const PointMotion& motion) {
  return std::llround(motion.first_time_s * motion.rate_hz);
}

Result<std::vector<CrowdPlace>> PlacesAt(const PointMotion& motion,
                                         std::optional<std::int64_t> wanted) {
  const std::int64_t first = FirstFrame(motion), last = first + motion.num_frames() - 1;
  const std::int64_t frame = wanted.value_or(first);
  if (frame < first || frame > last) {
    return Error{
        StrCat("there is no frame ", frame, "; the file has those from ", first, " to ", last),
        motion.path};
  }
  const double metres = MetresPer(motion.unit.value_or(LengthUnit::kMetre));
  std::vector<CrowdPlace> places;
  for (std::size_t i = 0; i < motion.chosen.size(); ++i) {
    const Eigen::Vector3d& position = motion.positions[i][frame - first];
    if (!position.allFinite()) continue;
    places.push_back({motion.names[motion.chosen[i]], metres * position.head<2>()});
  }
  if (places.empty()) {
    return Error{StrCat("nobody is there in frame ", frame), motion.path};
  }
  std::stable_sort(places.begin(), places.end(), [](const CrowdPlace& a, const CrowdPlace& b) {
    return a.position.x() != b.position.x() ? a.position.x() < b.position.x()
                                            : a.position.y() < b.position.y();
  });
  return places;
}

double MedianSpacing(const std::vector<CrowdPlace>& places) {
  if (places.size() < 2) return 0.0;
  std::vector<double> nearest;
  for (const CrowdPlace& one : places) {
    double distance = std::numeric_limits<double>::infinity();
    for (const CrowdPlace& other : places) {
      if (&other != &one) distance = std::min(distance, (one.position - other.position).norm());
    }
    nearest.push_back(distance);
  }
  return UpperMedian(std::move(nearest));
}

std::string OddSpacing(const std::vector<CrowdPlace>& places) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if ((places[i].position - places[k].position).norm() > kClosestPeople) continue;
      return "people " + places[k].name + " and " + places[i].name +
             " (the file's ids) are no more than 5 cm apart";
    }
  }
  const double spacing = MedianSpacing(places);
  if (spacing < kFarApart) return "";
  return "the nearest neighbour is " + Rounded(spacing, 3) +
         " m away (median); are the lengths metres? The comment '# id frame x/cm y/cm' declares cm";
}

}  // namespace pushid
