// apps: pushid-formation: what is written of a run, by flag, and the bodies of its people.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/flags/restoration_flags.h"
#include "ident/formations/formation_pictures.h"
#include "ident/formations/formation_run.h"
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

struct FormationBodyPlan {
  std::unique_ptr<Restoration> restoration;  // or
  std::optional<LoadedGenerator> generator;
  std::vector<Pose> first_poses;
};

// Nothing without either flag. Gives the scene's people the pendulums of their bodies.
Result<std::optional<FormationBodyPlan>> PlanBodies(const FormationBodyFlags& flags, bool rod_moves,
                                                    Scene* scene);

// The tables and pictures of the run that the flags name.
MaybeError WriteOutputs(const FormationOutputs& outputs, const FormationRun& run,
                        const std::vector<OnsetBand>& onsets, const std::string& title);

// The pages and bodies that the flags name; of pendulums where there is no plan for bodies.
MaybeError WriteFormationBodies(const FormationBodyFlags& flags,
                                const std::optional<FormationBodyPlan>& plan,
                                const FormationRun& run, const std::string& title);

}  // namespace pushid
