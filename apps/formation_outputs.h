// apps: pushid-formation: what is written of a run, by flag, and the bodies of its people.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/flags/body_flags.h"
#include "ident/formations/formation_files.h"
#include "ident/formations/formation_run.h"
#include "models/generators/diffusion_generator.h"

namespace pushid {

// Errors: outputs that cannot be written, or too many people for a picture.
void CheckOutputFlags(int people);
// Whether a picture of the wave is asked for.
bool DrawsWave();

// Where bodies come from; without either there are none, and pages show pendulums.
struct FormationBodyFlags {
  RestorationFlags restoration;
  DiffusionGeneratorOptions diffusion;  // how --generator is sampled
};
FormationBodyFlags FormationBodyFlagsFromCommandLine();

struct FormationBodyPlan {
  std::unique_ptr<Restoration> restoration;  // or
  std::optional<LoadedGenerator> generator;
  std::vector<Pose> first_poses;
};

// Nothing without either flag. first_poses: of recorded people; without them everybody gets the
// synthetic skeleton, and the scene's people its pendulum.
std::optional<FormationBodyPlan> PlanBodies(const FormationBodyFlags& flags,
                                            const std::vector<Pose>& first_poses, Scene* scene);

// The tables and pictures of the run that the flags name.
void WriteOutputs(const FormationRun& run, const std::vector<OnsetBand>& onsets,
                  const std::string& title);

// The pages and bodies that the flags name; of pendulums where there is no plan for bodies.
void WriteFormationBodies(const PostprocessOptions& postprocess,
                          const std::optional<FormationBodyPlan>& plan, const FormationRun& run,
                          const std::string& title);

}  // namespace pushid
