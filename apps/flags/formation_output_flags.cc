// apps: outputs of a formation by flag.
#include "apps/flags/formation_output_flags.h"

#include <gflags/gflags.h>

#include <vector>

#include "apps/flags/command_line.h"
#include "apps/flags/diffusion_flags.h"
#include "apps/flags/overwrite_flag.h"
#include "datasets/exchange/crowd.h"
#include "ident/formations/formation_pictures.h"

DEFINE_string(csv_out, "", "formation: trajectories, one row per frame and person (CSV)");
DEFINE_string(trajectories_out, "",
              "formation: trajectories of the hips, for PedPy and JuPedSim (.txt, or .sqlite)");
DEFINE_string(forces_out, "", "formation: net forces, one row per frame, person and part (CSV)");
DEFINE_string(bvh_out, "",
              "formation: folder for the pendulums as BVH, with manifest.json and the pushes");
DEFINE_string(svg_out, "",
              "formation: picture of the wave (SVG): time across, person down, colour speed");
DEFINE_string(forces_svg_out, "", "formation: picture of the net forces with their parts (SVG)");
DEFINE_bool(forces_own_scale, false,
            "formation: with --forces_svg_out, give each panel its own scale");

DEFINE_string(generator, "",
              "formation: whole bodies by diffusion instead of --restoration: the folder that "
              "pushid-train-generator --kind=diffusion --out wrote");
DEFINE_string(poses_from, "",
              "formation with bodies: manifest.json of recordings whose first poses (skeleton and "
              "lean) are used, in their order (default: the synthetic skeleton, upright)");
DEFINE_string(html_out, "", "formation: page of the moving people (HTML)");
DEFINE_string(strip_out, "", "formation: strip of poses (SVG)");
DEFINE_string(joints_out, "", "formation with bodies: joint positions (CSV)");
DEFINE_string(bodies_out, "",
              "formation with bodies: the bodies (.gltf or .glb: all in one animated file; "
              "otherwise BVH, one file per person, named after this one)");

namespace pushid {
namespace {

const std::vector<const char*> kOfBodies = {"poses_from", "joints_out", "bodies_out"};

const char* FirstGiven(const std::vector<const char*>& flags) {
  for (const char* flag : flags) {
    if (Given(flag)) return flag;
  }
  return nullptr;
}

// Flags that go with one way to bodies, where that is not the one.
MaybeError CheckWayToBodies(bool restores) {
  const bool generates = !FLAGS_generator.empty();
  if (restores && generates) {
    return Error{"--restoration and --generator both make the bodies; give one of them"};
  }
  if (generates && Given("postprocess")) {
    return Error{"--postprocess needs --restoration; a generator does its own postprocessing"};
  }
  if (const char* flag = generates ? nullptr : FirstGiven(DiffusionFlagNames())) {
    return Error{std::string("--") + flag + " needs --generator"};
  }
  if (const char* flag = restores || generates ? nullptr : FirstGiven(kOfBodies)) {
    return Error{std::string("--") + flag +
                 " needs bodies: give the folder of pushid-train-restoration as --restoration, or "
                 "that of pushid-train-generator as --generator"};
  }
  return std::nullopt;
}

MaybeError CheckPicture(const std::string& flag, const std::string& file, int people, int most) {
  if (file.empty() || people <= most) return std::nullopt;
  return Error{"--" + flag + " shows at most " + std::to_string(most) +
               " people; leave it out or lower --people"};
}

}  // namespace

const char* GivenFormationOutput() {
  std::vector<const char*> flags = {"csv_out",  "trajectories_out", "forces_out",  "bvh_out",
                                    "svg_out",  "forces_svg_out",   "restoration", "generator",
                                    "html_out", "forces_own_scale", "strip_out"};
  for (const std::vector<const char*>& more : {DiffusionFlagNames(), kOfBodies}) {
    flags.insert(flags.end(), more.begin(), more.end());
  }
  return FirstGiven(flags);
}

Result<FormationOutputs> FormationOutputsFromCommandLine(int people) {
  for (MaybeError error :
       {CheckPicture("svg_out", FLAGS_svg_out, people, kMostPeopleInWave),
        CheckPicture("forces_svg_out", FLAGS_forces_svg_out, people, kMostPeopleInForces),
        CheckTrajectoryFile("trajectories_out", FLAGS_trajectories_out),
        CheckOutputFiles({FLAGS_csv_out, FLAGS_trajectories_out, FLAGS_forces_out, FLAGS_svg_out,
                          FLAGS_forces_svg_out})}) {
    if (error) return *error;
  }
  if (!FLAGS_bvh_out.empty()) {
    if (MaybeError error = CheckOutputFolder("bvh_out", FLAGS_bvh_out)) return *error;
  }
  if (FLAGS_forces_own_scale && FLAGS_forces_svg_out.empty()) {
    return Error{"--forces_own_scale needs --forces_svg_out"};
  }
  return FormationOutputs{FLAGS_csv_out,
                          FLAGS_trajectories_out,
                          FLAGS_forces_out,
                          FLAGS_bvh_out,
                          FLAGS_svg_out,
                          FLAGS_forces_svg_out,
                          FLAGS_forces_own_scale ? ForceScale::kOwn : ForceScale::kShared};
}

Result<FormationBodyFlags> FormationBodyFlagsFromCommandLine() {
  const Result<RestorationFlags> restoration = RestorationFlagsFromCommandLine();
  if (!restoration.ok()) return restoration.error();
  if (MaybeError error = CheckWayToBodies(restoration.value().given())) return *error;
  const Result<DiffusionGeneratorOptions> diffusion = DiffusionOptionsFromCommandLine();
  if (!diffusion.ok()) return diffusion.error();
  const FormationBodyFlags flags{restoration.value(), FLAGS_generator, diffusion.value(),
                                 FLAGS_poses_from,    FLAGS_html_out,  FLAGS_strip_out,
                                 FLAGS_joints_out,    FLAGS_bodies_out};
  if (MaybeError error =
          CheckOutputFiles({flags.html_out, flags.strip_out, flags.joints_out, flags.bodies_out})) {
    return *error;
  }
  return flags;
}

}  // namespace pushid
