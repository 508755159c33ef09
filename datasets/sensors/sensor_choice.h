// datasets: force sensors in any file: CSV of the two forms in force_csv.h, a column or three of
// another CSV or an OpenSim storage file, an analog channel or a force platform of a C3D file.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/force_csv.h"
#include "datasets/manifest/recording.h"

namespace pushid {

// One sensor, and how it pushes.
struct SensorChoice {
  std::string file;
  // The part of the file: empty for a CSV time,force or time,fx,fy,fz; a column's name, or the
  // common part of three (ground_force_v for ground_force_vx, ..._vy, ..._vz); an analog channel;
  // or platform:1, counted from 1.
  std::string column;
  double gain = 1.0;  // N per unit of the column; negative where it counts the other way
  // Reading of a sensor of one number at rest, N; unset: what it reads before the pull.
  std::optional<double> zero_n;
  // Axes of the file that point up and forward, for forces that are vectors; empty: z and x.
  std::string up, forward;
  // The rest is what PushFromSensor needs.
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  double height_fraction = 1.0;
  std::optional<double> height_m;
  std::optional<double> start_s;  // its clock at frame 0; unset: 0
  double idle_force = 0.0;        // N
};

// Where the sensor was recorded in the file of a person's motion, the choice takes what it lacks
// from that file: clock at frame 0 and axes.
void FillFromMotion(const RecordedPerson& person, SensorChoice* choice);

// Errors besides those of the files' readers: no such column, channel or platform (some that exist
// are listed), missing values, uneven times.
Result<SensorRecord> ReadSensor(const SensorChoice& choice);

// Subtracts what a sensor reads before the pull: the median of its samples there. Sets `subtracted`
// (zero where the reading is as likely noise about zero) and `noise`. Nothing where the record
// begins with the pull (within 0.1 s) or reads 0.3 of its peak before: that is a load, and no zero.
void SubtractRest(SensorRecord* record);

// Several sensors that push together:
//   [{"file": "left.csv", "height": 0.8}, {"file": "trial.c3d", "column": "rod", "gain": -250,
//     "direction": [1, 0, 0], "height_m": 1.1, "start": 0.2, "idle_force": 3}]
// Files are relative to the list. Also up and forward.
Result<std::vector<SensorChoice>> ReadSensorList(const std::string& path);

// Columns of numbers with their times, from CSV and OpenSim storage files.

struct TimedColumns {
  std::string file;
  double first_s = 0.0;                     // of the first row, on the file's clock
  double rate_hz = 0.0;                     // evenly spaced
  std::vector<std::vector<double>> values;  // [as chosen][row]; NaN where a cell is empty
  std::vector<int> lines;                   // of each row

  int num_rows() const { return static_cast<int>(lines.size()); }
  double last_s() const { return first_s + (num_rows() - 1) / rate_hz; }
};

// choose: indices of the columns wanted, from all names; negative ones come out empty. Errors
// besides the choice's and those of numeric_table.h: no column of times, uneven ones.
Result<TimedColumns> ReadTimedColumns(
    const std::string& path,
    const std::function<Result<std::vector<int>>(const std::vector<std::string>&)>& choose);

// Checks that a record, "the record of the ground lasts", goes on for as long as a motion of so
// many seconds that begins at `start_s` of its clock. spare: frames that may be missing at the end.
struct RecordTimes {
  const char* lasts;
  double first_s, last_s, start_s, seconds, fps, spare;
};
MaybeError CheckLasts(const RecordTimes& times, const std::string& file, int line);

// Values at even times: cubic through the four nearest samples (Lagrange; of fewer, through all).
// at: in samples, from 0.
Eigen::Vector3d ValueBetween(const std::vector<Eigen::Vector3d>& track, double at);

}  // namespace pushid
