// datasets: how the ground of a recording moved, frame by frame, from a file.
//
//   time,x,y,theta,phi
//   0.00,0.000,0.0,0.0,0.0
//   0.01,0.002,0.0,0.0,0.0
// x, y (x, z of a file whose y is up): m, or m/s, or m/s^2; theta and phi: tilt about y and about x
// as the pendulum's angles are, whatever the file's axes, rad, or per s, or per s^2. Columns that
// lack are zero. Rates are summed up so that they are those by which a rollout steps
// (models/ground.h), from rest.
//
// The measurements of force platforms under a person, at the frames of the motion.
//
// C3D: platforms of the types of sensors/force_sensors.h. Tables: columns that end with fx, fy, fz
// (vx, vy, vz in OpenSim's) and px, py (and pz, which is not needed), for each platform behind a
// prefix of its own:
//   time,fx,fy,fz,px,py             time,left_fx,...,left_py,right_fx,...,right_py
//   time,fx,fy,fz,mx,my,mz          N m about the entry's `origin`, instead of a centre
// N on the person or on the platform, which can only be pressed, m, in the axes that are said.
// Forces of several platforms add up, and their moments do. Low-passed without delay below half the
// frame rate before frames are taken. Frames near samples of a table where a platform is pressed
// and has no centre of pressure (a gap, or zeros) have no weight.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/manifest/manifest.h"

namespace pushid {

// A platform moves at frame 0 where it is faster than this, m/s or rad/s, by more than its noise:
// people would not be at rest.
inline constexpr double kGroundAtRest = 0.02;

// Speed of the ground at the first of some poses, in the fastest coordinate, m/s or rad/s: the
// slope of a parabola through them, less what the scatter about it explains (three standard
// errors), and no more than the first step, which is short where ground starts quickly from rest.
double GroundSpeedAtFirst(const std::vector<GroundPose>& poses, double dt);

// Poses at the recording's frames (its fps, its number of frames), counted from frame 0, with the
// low-pass that the motion gets (Hz; 0: none). Errors: those of the file, a column that is
// misspelt, a record that ends early or begins late, ground that does not start at rest.
Result<std::vector<GroundPose>> LoadGround(const ManifestRecording& entry,
                                           const Recording& recording, double lowpass_hz = 0.0);

// A record that is evenly sampled, in the project's axes.
struct EvenRecord {
  std::string file;
  double rate_hz = 0.0, first_s = 0.0;
  int first_line = 0, last_line = 0;  // of a table's rows
  size_t samples = 0;

  double last_s() const { return first_s + (static_cast<double>(samples) - 1.0) / rate_hz; }
};

struct GroundTracks : EvenRecord {
  std::vector<Eigen::Vector3d> shift{}, tilt{};  // z: nothing
};

// The ground of the table that the entry names. Throws an Error.
GroundTracks GroundOfCsv(const ManifestRecording& entry);

inline constexpr double kWeightTolerance = 0.05;  // of the mean vertical force about m g
inline constexpr double kFarFromFeet = 0.6;       // m, of the centre of pressure

// Throws an Error unless whoever stands on the platforms of `file` weighs what these measure, and
// stands nearest to where they are pressed.
void CheckPlates(const std::string& file, const Recording& recording, int person);

// Sets the person's `plates`. Throws Errors: those of the files, no such platform or column, a
// record that ends early, a mean vertical force that is not the weight, a centre of pressure off
// the platform or far from the feet. Warnings: those of the tracks.
void LoadPlates(const ManifestRecording& entry, const ManifestPlates& plates, double lowpass_hz,
                Recording* recording, Warnings* warnings = nullptr);

// Force platforms of a file, added up: force, and the moments [F_z p_x, F_z p_y, F_z].
struct PlateTracks : EvenRecord {
  int platforms = 0;                    // that were added up
  std::vector<std::string> warnings{};  // of unusual ones, and of those that are left out
  std::vector<Eigen::Vector3d> force{}, moment{};
  // Samples, counted from 0, at which the centre of a platform that is pressed is not known.
  std::vector<int> unknown{};

  void Add(size_t at, const Eigen::Vector3d& on_person, const Eigen::Vector3d& centre) {
    if (samples <= at) {
      samples = at + 1;
      force.resize(samples, Eigen::Vector3d::Zero());
      moment.resize(samples, Eigen::Vector3d::Zero());
    }
    force[at] += on_person;
    if (!centre.allFinite() || on_person.z() <= 0.0) return;
    moment[at] += on_person.z() * Eigen::Vector3d(centre.x(), centre.y(), 1.0);
  }
};

// The platforms of a manifest's entry, from the file that it names or from the motion's; a motion's
// file has the axes of its person. Throws Errors: those of the files, no such platform or column, a
// platform that is named and cannot be evaluated, or none that can. Platforms of a C3D file that
// are not named and cannot be are left out.
PlateTracks ReadPlates(const ManifestRecording& entry, const ManifestPlates& plates,
                       const RecordedPerson& person);

}  // namespace pushid
