// datasets: ground that moves, from markers on it.
#include "datasets/loading/ground_markers.h"

#include <algorithm>
#include <cmath>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/loading/motion_tracks.h"
#include "models/decompositions.h"

namespace pushid {
namespace {

using Track = std::vector<Eigen::Vector3d>;

constexpr double kGroundGap = 0.1;      // s, of a marker: longer ones are not filled
constexpr double kMarkersApart = 0.01;  // m, rms about a line: less tells no tilt about it

Eigen::Matrix3Xd AboutMiddle(const std::vector<Eigen::Vector3d>& marks, Eigen::Vector3d* middle) {
  Eigen::Matrix3Xd about(3, marks.size());
  for (size_t i = 0; i < marks.size(); ++i) about.col(i) = marks[i];
  *middle = about.rowwise().mean();
  return about.colwise() - *middle;
}

// Marks on one line, or one named twice, leave the tilt about it open.
void CheckApart(const std::vector<Eigen::Vector3d>& marks, const ManifestGround& ground,
                const std::string& path) {
  Eigen::Vector3d middle;
  const Eigen::VectorXd spread = DecomposeRight(AboutMiddle(marks, &middle)).values;
  const double off = spread[1] / std::sqrt(static_cast<double>(marks.size()));
  if (off >= kMarkersApart) return;
  throw Error{"the markers of the ground (" + ListOfNames(ground.markers) +
                  ") lie on a line within " + Rounded(1000.0 * off, 2) +
                  " mm, which leaves the tilt about it open; name one beside it, " +
                  Rounded(1000.0 * kMarkersApart) + " mm or more",
              path};
}

// The turn that takes the marks of frame 0 to those of a frame best (Kabsch 1976), and where it and
// the shift of their middle take the point `under` the person, about which the ground tilts.
void AddRigid(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to,
              const Eigen::Vector3d& under, GroundTracks* tracks) {
  Eigen::Vector3d a, b;
  const Eigen::Matrix3Xd before = AboutMiddle(from, &a), now = AboutMiddle(to, &b);
  const Eigen::Matrix3d turn = NearestRotation(now * before.transpose());
  const Eigen::Vector3d normal = turn.col(2);  // where the ground's z points
  tracks->shift.push_back(b + turn * (under - a) - under);
  tracks->tilt.emplace_back(std::asin(std::clamp(normal[0], -1.0, 1.0)),
                            std::atan2(-normal[1], normal[2]), 0.0);
}

// A marker that slides, falls off or was exchanged for another moves the ground as it never moved.
void CheckRigid(const std::vector<Track>& marks, const ManifestGround& ground,
                const std::string& path) {
  for (size_t a = 0; a < marks.size(); ++a) {
    for (size_t b = 0; b < a; ++b) {
      double mean = 0.0, square = 0.0, farthest = 0.0;
      size_t at = 0;
      const auto frames = static_cast<double>(marks[a].size());
      for (size_t t = 0; t < marks[a].size(); ++t) mean += (marks[a][t] - marks[b][t]).norm();
      mean /= frames;
      for (size_t t = 0; t < marks[a].size(); ++t) {
        const double off = std::abs((marks[a][t] - marks[b][t]).norm() - mean);
        square += off * off / frames;
        if (off > farthest) farthest = off, at = t;
      }
      if (square <= kRigidMarkers * kRigidMarkers) continue;
      throw Error{
          StrCat("the markers ", ground.markers[b], " and ", ground.markers[a],
                 " of the ground are not rigid: their distance scatters by ",
                 Rounded(1000.0 * std::sqrt(square), 2), " mm about ", Rounded(1000.0 * mean, 3),
                 " mm, most at frame ", at, ", and may by ", Rounded(1000.0 * kRigidMarkers),
                 " mm; leave out the one that moves on the platform"),
          path};
    }
  }
}

// Short gaps are filled, and told; longer ones are errors.
void CloseGaps(const ManifestRecording& entry, const std::string& path, double rate,
               std::vector<Track>* marks, Warnings* warnings) {
  for (size_t m = 0; m < marks->size(); ++m) {
    const std::string name = "the marker " + entry.ground.markers[m] + " of the ground";
    std::vector<double> weight((*marks)[m].size(), 1.0);
    const GapCount count =
        FillGaps(static_cast<int>(std::lround(kGroundGap * rate)), &(*marks)[m], &weight);
    const auto gap = std::find(weight.begin(), weight.end(), 0.0);
    if (gap != weight.end()) {
      throw Error{StrCat(name, " is not seen at frame ", gap - weight.begin(), " for longer than ",
                         Rounded(kGroundGap), " s; fill the gap, or leave the marker out"),
                  path};
    }
    if (count.gaps == 0) continue;
    WarnOf(entry.id,
           StrCat(name, " has ", CountText(count.gaps, "gap"), ", ", count.filled_frames,
                  " frames in all, filled by ", count.gaps == 1 ? "a cubic" : "cubics"),
           warnings);
  }
}

}  // namespace

GroundTracks GroundOfMarkers(const ManifestRecording& entry, const Recording& recording,
                             const GroundReading& reading, Warnings* warnings) {
  const std::string path = ResolvePath(entry.manifest, entry.motion[0]);
  PointReadOptions options;
  options.choose = [&](const std::vector<std::string>& names) {
    std::vector<int> chosen;
    for (const std::string& marker : entry.ground.markers) {
      const auto found = std::find(names.begin(), names.end(), marker);
      if (found == names.end()) throw UnknownNameError(path, "marker", names, marker);
      chosen.push_back(static_cast<int>(found - names.begin()));
    }
    return chosen;
  };
  PointMotion read = OrThrow(ReadPointMotion(path, entry.motion_format, options));
  std::vector<Track>& marks = read.positions;
  GroundTracks tracks{{path, reading.file_fps, read.first_time_s, 0, 0, marks[0].size()}};
  CloseGaps(entry, path, tracks.rate_hz, &marks, warnings);
  const RecordedPerson& person = recording.people[0];
  const Eigen::Matrix3d axes = AxesGiven(person.file_up, person.file_forward);
  for (Track& mark : marks) {
    for (Eigen::Vector3d& v : mark) v = reading.metres_per_unit * (axes * v);
  }
  CheckRigid(marks, entry.ground, path);
  const auto at = [&](int frame) {
    std::vector<Eigen::Vector3d> now;
    for (const Track& mark : marks) now.push_back(mark[frame]);
    return now;
  };
  const int frames = static_cast<int>(marks[0].size());
  const int first = std::clamp(entry.first_frame, 0, frames - 1);
  CheckApart(at(first), entry.ground, path);
  const Eigen::Vector3d under = 0.5 * (person.left_ankle[0] + person.right_ankle[0]);
  for (int t = 0; t < frames; ++t) AddRigid(at(first), at(t), under, &tracks);
  return tracks;
}

}  // namespace pushid
