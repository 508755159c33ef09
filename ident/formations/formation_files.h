// ident: a formation's run as files that spreadsheets, animation programs and pushid itself read.
#pragma once

#include <string>

#include "datasets/files/error.h"
#include "ident/formations/formation_run.h"

namespace pushid {

// One row for each frame, person and part that acts anywhere, and for their sum, `net`:
//   frame,time_s,person,part,fx_N,fy_N,ftheta_Nm,fphi_Nm
MaybeError WriteForcesCsv(const std::string& path, const FormationRun& run);

// The hips, for programs that know crowds; the file's ending says the format (crowd.h).
MaybeError WriteFormationTrajectories(const std::string& path, const FormationRun& run);

// The pendulums as recordings: folder/manifest.json, folder/bvh/NAME.bvh and folder/push/*.csv, in
// millimetres. Each BVH is Cart (position) -> Rod (rotations phi about x, then theta about y) ->
// Hips, with both ankles at the cart's sides, so that the programs that read recordings find cart,
// rod and hip again. The manifest comes last: without it the folder is no recording.
MaybeError WriteFormationRecording(const std::string& folder, const FormationRun& run);

}  // namespace pushid
