// datasets: the contents of a file, and what about them will matter in a fit.
//
//   Result<Inspection> found = Inspect("trial.c3d");
//   for (const auto& [what, text] : found.value().facts) ...
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/foot_steps.h"
#include "datasets/loading/pendulum_recording.h"
#include "datasets/manifest/joint_mapping.h"

namespace pushid {

// A line of a picture: a force at a constant rate, N.
struct InspectedSignal {
  std::string name;
  double rate_hz = 0.0;
  std::vector<double> values;
};

struct Inspection {
  std::string path;
  std::string format;  // "BVH", "C3D", "TRC", "STO", "CSV", "manifest", ...
  std::vector<std::pair<std::string, std::string>> facts;  // "frames", "580 at 100 per second"
  std::vector<std::string> warnings;

  // Ground and platforms of a manifest's recordings, an object each: of the ground kind, rate of
  // its file, and at the frames the farthest place, the peak acceleration and tilt; of platforms
  // use, number and rate, mean vertical force over m g, and the range of the centre of pressure.
  nlohmann::ordered_json ground = nlohmann::ordered_json::array(), plates = ground;

  // Data of the picture; empty where the file has no such thing.
  double rate_hz = 0.0;              // of hip
  std::vector<Eigen::Vector3d> hip;  // m, file's axes, less that of the first frame seen
  std::vector<InspectedSignal> forces;
  int onset_frame = -1;              // the hip's first 2 cm
  std::optional<PersonSteps> steps;  // forward is where the person faces

  void Fact(const std::string& what, const std::string& text) { facts.emplace_back(what, text); }
  void Warn(const std::string& text) { warnings.push_back(text); }
};

// Inspects a file by its ending and its first line; joints, columns, times and rate as the mapping
// says. Error: it cannot be read at all. Several manifests, "a.json,b.json", are one study; a C3D
// file that is cut short is read as far as it goes, with a warning.
Result<Inspection> Inspect(const std::string& path, const ColumnMapping& mapping = {});

// Masses of one person that differ by more than 5 % between recordings: an id is
// one person. "S01 weighs 62.7 to 70 kg: ..."
std::vector<std::string> MassTexts(const std::vector<PendulumRecording>& recordings);

// "file: format", the facts and the warnings, one a line.
std::string InspectionText(const Inspection& inspection);

// The inspection with names and numbers: {"file", "format", "facts", "warnings", "ground",
// "plates"}.
nlohmann::ordered_json InspectionJson(const Inspection& inspection);

}  // namespace pushid
