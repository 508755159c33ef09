// datasets: the formats of motion files, one row each: manifest key, file endings and reader.
// Everything that a program, message or manifest says of a format comes from here.
//
//   Result<PointMotion> motion = ReadPointMotion("trial.trc", MotionFormat::kTrc, {});
//
// A new format is a value and a row in this file, and a reader that returns a PointMotion.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "datasets/files/numeric_table.h"
#include "datasets/formats/bvh.h"
#include "datasets/formats/c3d.h"
#include "datasets/formats/point_motion.h"
#include "datasets/formats/trajectories.h"

namespace pushid {

enum class MotionFormat { kBvh, kC3d, kTrc, kCsv, kStorage, kTrajectoryText };

struct MotionFormatRow {
  const char* name;  // the key of the list of files in a manifest
  MotionFormat value;
  const char* title;                   // as people write it
  std::array<const char*, 2> endings;  // of file names, whatever the case; null: none
  Result<PointMotion> (*read)(const std::string& path, const PointReadOptions& options);
  std::optional<TableFormat> table = std::nullopt;  // of files that are tables of numbers
};

inline constexpr MotionFormatRow kMotionFormats[] = {
    {"bvh", MotionFormat::kBvh, "BVH", {"bvh"}, &ReadBvhPoints},
    {"c3d", MotionFormat::kC3d, "C3D", {"c3d"}, &ReadC3dPoints},
    {"trc", MotionFormat::kTrc, "TRC", {"trc"}, &ReadTrc},
    {"csv", MotionFormat::kCsv, "CSV", {"csv"}, &ReadCsvPoints, TableFormat::kCsv},
    {"sto",
     MotionFormat::kStorage,
     "STO",
     {"sto", "mot"},
     &ReadStoragePoints,
     TableFormat::kStorage},
    {"txt", MotionFormat::kTrajectoryText, "trajectories", {"txt"}, &ReadTrajectoryText},
};

constexpr const auto& Names(MotionFormat) { return kMotionFormats; }
static_assert(RowsAreInOrder(kMotionFormats), "RowOf finds a row by its value");

// Whether the points of the format are the joints of a skeleton.
inline bool HasSkeleton(MotionFormat format) { return format == MotionFormat::kBvh; }
// Whether the points of the format are people of a crowd.
inline bool HoldsCrowd(MotionFormat format) { return format == MotionFormat::kTrajectoryText; }
// The reason why recordings of people cannot be made of such a file.
inline constexpr char kCrowdIsNoRecording[] =
    "a file of trajectories holds one point for each person of a group: it shows when each began "
    "to move and how fast a push travelled (pushid-inspect --wave), and where people stand for "
    "pushid-formation --formation; balance, contact forces and steps it does not show, for which "
    "a fit needs the ankles of each; a tracker's numbered markers need \"joints\" (in a mapping "
    "file or the manifest)";
// The name for people: "BVH", "C3D", ...
inline std::string Title(MotionFormat format) { return RowOf(format).title; }

// The format by the file's ending: ".c3d" is C3D, ".mot" and ".sto" storage, ...
std::optional<MotionFormat> MotionFormatOfFile(std::string_view path);
// The format by the ending, or trajectories where a CSV file's header says so.
std::optional<MotionFormat> MotionFormatInFile(const std::string& path);

// ".bvh, .c3d, .trc, .csv, .sto, .mot" and "bvh, c3d, trc, csv, sto", for messages.
std::string MotionFileEndings();
std::string MotionKeys();

// Errors besides those of the single readers: no points.
Result<PointMotion> ReadPointMotion(const std::string& path, MotionFormat format,
                                    const PointReadOptions& options = {});

// The file's rate, as WholeFrameRate reads it; 0 where it does not say. No motion is kept, and that
// of a BVH file is not read.
Result<double> ReadFrameRate(const std::string& path, MotionFormat format,
                             const PointReadOptions& options = {});

// Columns of numbers with their times, from CSV and OpenSim storage files.

struct TimedColumns {
  std::string file;
  double first_s = 0.0;                     // of the first row, on the file's clock
  double rate_hz = 0.0;                     // evenly spaced
  std::vector<std::vector<double>> values;  // [as chosen][row]; NaN where a cell is empty
  std::vector<int> lines;                   // of each row

  int num_rows() const { return static_cast<int>(lines.size()); }
};

// choose: indices of the columns wanted; negative ones come out empty. Throws an Error: the
// choice's, those of numeric_table.h, no column of times, uneven ones.
TimedColumns ReadTimedColumns(const std::string& path, const Choice& choose);

}  // namespace pushid
