// apps: outputs of a formation by flag.
#include "apps/flags/formation_output_flags.h"

#include <gflags/gflags.h>

#include "apps/flags/command_line.h"
#include "apps/support/output_folder.h"
#include "ident/formations/formation_pictures.h"

DEFINE_string(csv_out, "", "formation: trajectories, one row a frame and person (CSV)");
DEFINE_string(forces_out, "", "formation: net forces, one row a frame, person and part (CSV)");
DEFINE_string(bvh_out, "",
              "formation: folder for the pendulums as BVH, with manifest.json and the pushes");
DEFINE_string(svg_out, "",
              "formation: picture of the wave (SVG): time across, person down, colour speed");
DEFINE_string(forces_svg_out, "", "formation: picture of the net forces with their parts (SVG)");

DEFINE_string(poses_from, "",
              "formation with --restoration: manifest.json of recordings whose first poses (with "
              "skeleton and lean, in their order) the people take (default: the synthetic "
              "skeleton, upright)");
DEFINE_string(html_out, "", "formation with --restoration: page of the moving bodies (HTML)");
DEFINE_string(strip_out, "", "formation with --restoration: strip of poses (SVG)");
DEFINE_string(joints_out, "", "formation with --restoration: joint positions (CSV)");
DEFINE_string(bodies_out, "",
              "formation with --restoration: the bodies (BVH; one file a person, named after "
              "this one)");

namespace pushid {
namespace {

constexpr const char* kOfBodies[] = {"poses_from", "html_out", "strip_out", "joints_out",
                                     "bodies_out"};

const char* GivenBodyFlag() {
  for (const char* flag : kOfBodies) {
    if (Given(flag)) return flag;
  }
  return nullptr;
}

MaybeError CheckPicture(const std::string& flag, const std::string& file, int people, int most) {
  if (file.empty() || people <= most) return std::nullopt;
  return Error{"--" + flag + " shows at most " + std::to_string(most) +
               " people; leave it out or lower --people"};
}

}  // namespace

const char* GivenFormationOutput() {
  for (const char* flag :
       {"csv_out", "forces_out", "bvh_out", "svg_out", "forces_svg_out", "restoration"}) {
    if (Given(flag)) return flag;
  }
  return GivenBodyFlag();
}

Result<FormationOutputs> FormationOutputsFromCommandLine(int people) {
  for (MaybeError error :
       {CheckPicture("svg_out", FLAGS_svg_out, people, kMostPeopleInWave),
        CheckPicture("forces_svg_out", FLAGS_forces_svg_out, people, kMostPeopleInForces),
        CheckOutputFiles({FLAGS_csv_out, FLAGS_forces_out, FLAGS_svg_out, FLAGS_forces_svg_out})}) {
    if (error) return *error;
  }
  if (!FLAGS_bvh_out.empty()) {
    if (MaybeError error = CheckOutputFolder("bvh_out", FLAGS_bvh_out)) return *error;
  }
  return FormationOutputs{FLAGS_csv_out, FLAGS_forces_out, FLAGS_bvh_out, FLAGS_svg_out,
                          FLAGS_forces_svg_out};
}

Result<FormationBodyFlags> FormationBodyFlagsFromCommandLine() {
  const Result<RestorationFlags> restoration = RestorationFlagsFromCommandLine();
  if (!restoration.ok()) return restoration.error();
  if (!restoration.value().given()) {
    if (const char* flag = GivenBodyFlag()) return NeedsRestoration(flag);
    return FormationBodyFlags();
  }
  const FormationBodyFlags flags{restoration.value(), FLAGS_poses_from, FLAGS_html_out,
                                 FLAGS_strip_out,     FLAGS_joints_out, FLAGS_bodies_out};
  if (MaybeError error =
          CheckOutputFiles({flags.html_out, flags.strip_out, flags.joints_out, flags.bodies_out})) {
    return *error;
  }
  return flags;
}

}  // namespace pushid
