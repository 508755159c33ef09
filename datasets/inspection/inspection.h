// datasets: what a file holds, and what about it will matter in a fit.
//
//   Result<Inspection> found = Inspect("trial.c3d");
//   for (const auto& [what, text] : found.value().facts) ...
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/c3d.h"
#include "datasets/formats/point_motion.h"
#include "datasets/inspection/facing_and_steps.h"
#include "datasets/loading/foot_steps.h"
#include "datasets/manifest/column_mapping.h"
#include "datasets/manifest/joint_choice.h"

namespace pushid {

// A line of a picture: values at a constant rate.
struct InspectedSignal {
  std::string name, unit;
  double rate_hz = 0.0;
  std::vector<double> values;
};

struct Inspection {
  std::string path;
  std::string format;  // "BVH", "C3D", "TRC", "STO", "CSV", "manifest", ...
  std::vector<std::pair<std::string, std::string>> facts;  // "frames", "580 at 100 per second"
  std::vector<std::string> warnings;

  // For the picture; empty where the file has no such thing.
  double rate_hz = 0.0;                  // of hip and seen
  std::vector<Eigen::Vector3d> hip;      // m, file's axes, less that of the first frame seen
  std::vector<std::string> point_names;  // of seen
  std::vector<std::vector<bool>> seen;   // [point][frame]
  std::vector<InspectedSignal> forces;   // N
  int onset_frame = -1;                  // the hip's first 2 cm
  std::optional<PersonSteps> steps;      // forward is where the person faces

  void Fact(const std::string& what, const std::string& text) { facts.emplace_back(what, text); }
  void Warn(const std::string& text) { warnings.push_back(text); }
};

// By the file's ending and its first line; joints, columns, times and rate as the mapping says. An
// Error where it cannot be read at all; several manifests, "a.json,b.json", are one study; a C3D
// file cut short is read as far as it goes, with a warning.
Result<Inspection> Inspect(const std::string& path, const ColumnMapping& mapping = {});

// "file: format", the facts and the warnings, one a line.
std::string InspectionText(const Inspection& inspection);

// The parts of Inspect.

// A motion: unit, axes, rate, gaps, jumps, standing height, a static start, the onset of the push,
// steps. Adds facts, warnings and the picture's data. `joints`: indices into motion.names, all of
// which were read; without them only rate, gaps and jumps are looked at. pelvis: alike.
void InspectMotion(const PointMotion& motion, const std::optional<PendulumJoints>& joints,
                   const PelvisSides& pelvis, Inspection* inspection);

// Peak, impulse and onset of a force in N; keeps it for the picture. NaN: no value.
void AddForce(const std::string& name, double rate_hz, std::vector<double> values,
              Inspection* found);

// The analog channels of a C3D file, and what presses its force platforms.
void LookAtAnalog(const C3dFile& file, Inspection* found);
void LookAtPlatforms(const C3dFile& file, Inspection* found);

// People, times, how close they stand. motion: of every person, as trajectories.h reads them.
void InspectCrowd(const PointMotion& motion, Inspection* found);

// Adds facts about the manifest at inspection->path, and a warning for every recording that cannot
// be read and everything unusual about the others.
MaybeError InspectManifest(Inspection* inspection);

}  // namespace pushid
