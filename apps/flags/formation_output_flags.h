// apps: pushid-simulate --formation: what is written of the run, and the bodies in it.
#pragma once

#include <string>

#include "apps/flags/restoration_flags.h"
#include "ident/formations/formation_pictures.h"
#include "models/generators/diffusion_generator.h"

namespace pushid {

// Files and folders; empty: not written.
struct FormationOutputs {
  std::string csv_out;           // trajectories
  std::string trajectories_out;  // hips, for PedPy and JuPedSim
  std::string forces_out;        // net forces by part (CSV)
  std::string bvh_out;           // folder: pendulums as BVH, manifest, pushes
  std::string svg_out;           // picture of the wave
  std::string forces_svg_out;    // picture of the net forces
  ForceScale force_scale = ForceScale::kShared;
};
// Errors: outputs that cannot be written, or too many people for a picture.
Result<FormationOutputs> FormationOutputsFromCommandLine(int people);

struct FormationBodyFlags {
  // Where bodies come from; without either there are none, and pages show pendulums.
  RestorationFlags restoration;
  std::string generator;                // folder of pushid-train-generator
  DiffusionGeneratorOptions diffusion;  // how it is sampled
  std::string poses_from;  // manifest of the first poses; empty: the synthetic skeleton
  std::string html_out;    // page of the moving people, with bodies or without
  std::string strip_out;   // strip of poses (SVG)
  std::string joints_out;  // joint positions (CSV)
  std::string bodies_out;  // BVH, one file a person, or glTF

  bool generates() const { return !generator.empty(); }
  bool given() const { return restoration.given() || generates(); }
};
Result<FormationBodyFlags> FormationBodyFlagsFromCommandLine();

// The first given flag of these; nullptr when there is none.
const char* GivenFormationOutput();

}  // namespace pushid
