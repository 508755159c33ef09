// apps: pushid-simulate --formation with --restoration or --generator: bodies of the formation's
// people, and the files that show them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/flags/formation_output_flags.h"
#include "ident/formations/formation_run.h"

namespace pushid {

struct FormationBodyPlan {
  std::unique_ptr<Restoration> restoration;  // or
  std::optional<LoadedGenerator> generator;
  std::vector<Pose> first_poses;
};

// Nothing without either flag. Gives the scene's people the pendulums of their bodies.
Result<std::optional<FormationBodyPlan>> PlanBodies(const FormationBodyFlags& flags, bool rod_moves,
                                                    Scene* scene);

// The pages that the flags name, without bodies.
MaybeError WriteFormationPendulums(const FormationBodyFlags& flags, const FormationRun& run,
                                   const std::string& title);

// The files that the flags name.
MaybeError WriteFormationBodies(const FormationBodyFlags& flags, const FormationBodyPlan& plan,
                                const FormationRun& run, const std::string& title);

}  // namespace pushid
