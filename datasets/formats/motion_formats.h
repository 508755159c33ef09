// datasets: the formats of motion files, one row each: manifest key, file endings and reader. What
// any program, message or manifest says of a format comes from here.
//
//   Result<PointMotion> motion = ReadPointMotion("trial.trc", MotionFormat::kTrc, {});
//
// A new format is a value and a row in this file, and a reader that returns a PointMotion.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "datasets/files/numeric_table.h"
#include "datasets/formats/c3d.h"
#include "datasets/formats/motion_bids.h"
#include "datasets/formats/point_motion.h"
#include "datasets/formats/trajectories.h"
#include "datasets/formats/trc.h"

namespace pushid {

enum class MotionFormat {
  kBvh,
  kC3d,
  kTrc,
  kCsv,
  kStorage,
  kBids,
  kTrajectoryText,
  kTrajectorySqlite
};

struct MotionFormatRow {
  MotionFormat format;
  const char* key;                     // of the list of files in a manifest
  const char* title;                   // as people write it
  std::array<const char*, 2> endings;  // of file names, whatever the case; null: none
  // Null: the file holds a skeleton and the motion of its joints, which bvh.h reads.
  Result<PointMotion> (*read)(const std::string& path, const PointReadOptions& options);
  std::optional<TableFormat> table;  // of files that are tables of numbers
};

inline constexpr MotionFormatRow kMotionFormats[] = {
    {MotionFormat::kBvh, "bvh", "BVH", {"bvh"}, nullptr, std::nullopt},
    {MotionFormat::kC3d, "c3d", "C3D", {"c3d"}, &ReadC3dPoints, std::nullopt},
    {MotionFormat::kTrc, "trc", "TRC", {"trc"}, &ReadTrc, std::nullopt},
    {MotionFormat::kCsv, "csv", "CSV", {"csv"}, &ReadCsvPoints, TableFormat::kCsv},
    {MotionFormat::kStorage,
     "sto",
     "STO",
     {"sto", "mot"},
     &ReadStoragePoints,
     TableFormat::kStorage},
    {MotionFormat::kBids, "tsv", "Motion-BIDS", {"tsv"}, &ReadMotionBids, std::nullopt},
    {MotionFormat::kTrajectoryText,
     "txt",
     "trajectories",
     {"txt"},
     &ReadTrajectoryText,
     std::nullopt},
    {MotionFormat::kTrajectorySqlite,
     "sqlite",
     "JuPedSim SQLite",
     {"sqlite"},
     &ReadTrajectorySqlite,
     std::nullopt},
};

const MotionFormatRow& RowOf(MotionFormat format);

inline bool HasSkeleton(MotionFormat format) { return RowOf(format).read == nullptr; }
// Whether its points are people of a crowd.
inline bool HoldsCrowd(MotionFormat format) {
  return format == MotionFormat::kTrajectoryText || format == MotionFormat::kTrajectorySqlite;
}
// The manifest's key: "bvh", "c3d", ...
std::string Name(MotionFormat format);
// As people write it: "BVH", "C3D", ...
std::string Title(MotionFormat format);

// By the file's ending: ".c3d" is C3D, ".mot" and ".sto" storage, ...; nullopt for other endings.
std::optional<MotionFormat> MotionFormatOfFile(std::string_view path);

// For messages: ".bvh, .c3d, .trc, .csv, .sto, .mot" and "bvh, c3d, trc, csv, sto".
std::string MotionFileEndings();
std::string MotionKeys();

// Of a format without a skeleton. Errors besides those of the single readers: no points.
Result<PointMotion> ReadPointMotion(const std::string& path, MotionFormat format,
                                    const PointReadOptions& options = {});

// What the file says, as WholeFrameRate reads it; 0 where it does not say. The motion of a BVH file
// is not read for it, and of the others none is kept.
Result<double> ReadFrameRate(const std::string& path, MotionFormat format,
                             const PointReadOptions& options = {});

}  // namespace pushid
