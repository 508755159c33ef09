// datasets: Motion-BIDS (Brain Imaging Data Structure 1.10, section Motion): the motion of one
// person as a table of numbers without a line of names, and two files that say what they are.
//
//   sub-01_task-push_tracksys-omc_motion.tsv     a row a frame, a column a channel
//   sub-01_task-push_tracksys-omc_channels.tsv   a row a channel: name, component, type,
//                                                tracked_point, units, ...
//   sub-01_task-push_tracksys-omc_motion.json    TaskName, SamplingFrequency, MissingValues, ...
//   sub-01_task-push_tracksys-omc_channels.json  axes of the reference frames; optional
//
// The latter may also stand above it with fewer of its entities ("task-push_motion.json" beside
// dataset_description.json), where nearer ones win. Points are tracked points with channels of type
// POS and the components x, y and z. A push stands in channels of type MISC.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/files/numeric_table.h"
#include "datasets/formats/point_motion.h"

namespace pushid {

struct BidsChannel {
  std::string name, component, type, tracked_point, units;
  std::string reference_frame{};  // empty: not said
};

struct BidsHeader {
  double rate_hz = 0.0;
  std::vector<BidsChannel> channels;
  std::string missing;  // what stands for a missing value besides n/a and nan; may be empty
  std::string up;       // "+z", of the reference frame of the positions; empty where it is not said
  std::string content_hash;
};

// Errors name the file: no such files, required keys and columns that are missing, a rate that is
// no number of hertz, channels of one name.
Result<BidsHeader> ReadBidsHeader(const std::string& motion_path);

// The motion's columns under the names of their channels. Errors besides those of ReadNumericTable:
// not as many columns as channels.
Result<NumericTable> ReadBidsTable(const std::string& motion_path, const BidsHeader& header,
                                   const TableReadOptions& options = {});

Result<PointMotion> ReadMotionBids(const std::string& path, const PointReadOptions& options = {});

// Generalized forces [fx N, fy N, ftheta N m, fphi N m] from a frame of the motion on.
struct TimedForce {
  int start_frame = 0;
  std::vector<Eigen::Vector4d> force;
};

// The channels push_fx, push_fy, push_ftheta and push_fphi; rows without a value are no push.
// Errors name channels that are lacking, rows with some of the four, and files that hold no push.
Result<std::vector<TimedForce>> ReadBidsPushes(const std::string& path);

// `stem`_motion.tsv with its sidecars, atomically one by one, the motion last. Positions in m with
// x forward, y left and z up; pushes may be none. Errors: points of one name, pushes that overlap.
MaybeError WriteMotionBids(const std::string& stem, const std::string& task,
                           const PointMotion& motion, const std::vector<TimedForce>& pushes);

}  // namespace pushid
