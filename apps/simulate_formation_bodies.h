// apps: pushid-simulate --formation --restoration: bodies of the formation's people, and the files
// that show them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/flags/formation_output_flags.h"
#include "ident/formations/formation_bodies.h"

namespace pushid {

struct FormationBodyPlan {
  std::unique_ptr<Restoration> restoration;
  std::vector<Pose> first_poses;
};

// Nothing without --restoration. Gives the scene's people the pendulums of their bodies.
Result<std::optional<FormationBodyPlan>> PlanBodies(const FormationBodyFlags& flags, bool rod_moves,
                                                    Scene* scene);

// The files that the flags name.
MaybeError WriteFormationBodies(const FormationBodyFlags& flags, const FormationBodyPlan& plan,
                                const FormationRun& run, const std::string& title);

}  // namespace pushid
