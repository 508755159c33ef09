// datasets: which joints or markers of a file play the roles of a body.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/bvh.h"
#include "datasets/manifest/body_roles.h"
#include "datasets/manifest/joint_choice.h"

namespace pushid {

// Hip, ankles and toes are those of the pendulum and its feet; for the rest the words of the naming
// that knows most of the file's names (role_choice.cc has the table), and for the spine of a
// skeleton the joints between hip and shoulders. A skeleton of the FZJ push recordings plays the
// roles as it stands. What `mapping` names wins; a name there that the file has not is the only
// Error: roles that nothing plays stay empty.
// skeleton: null for points, `names` are theirs.
Result<BodyRoles> ChooseRoles(const std::string& path, const std::vector<std::string>& names,
                              const BvhSkeleton* skeleton, const PendulumJoints& pendulum,
                              const JointMapping& mapping);

// "all roles", "all roles, filled from neighbours: ...", or "none: ..." and why, for people.
std::string RolesText(const Result<BodyRoles>& roles);

}  // namespace pushid
