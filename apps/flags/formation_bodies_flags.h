// apps: pushid-simulate --formation --restoration: bodies in the formation and what is written of
// them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ident/formations/formation_bodies.h"

namespace pushid {

// The first of the bodies' flags that is given; nullptr when there is none.
const char* GivenBodyFlag();

struct FormationBodyPlan {
  std::unique_ptr<Restoration> restoration;
  PostprocessOptions postprocess;
  std::vector<Pose> first_poses;
};

// Nothing without --restoration. Gives the scene's people the pendulums of their bodies.
Result<std::optional<FormationBodyPlan>> PlanBodies(bool rod_moves, Scene* scene);

// What --html_out, --strip_out, --joints_out and --bodies_out name.
MaybeError WriteFormationBodies(const FormationRun& run, const FormationBodyPlan& plan,
                                const std::string& title);

}  // namespace pushid
