// ident: a formation's run as pictures, and as files that spreadsheets, animation programs and
// pushid itself read.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "ident/formations/formation_run.h"

namespace pushid {

// The hips, as trajectories.h has them.
MaybeError WriteFormationTrajectories(const std::string& path, const FormationRun& run);

// The pendulums as recordings: folder/manifest.json, folder/bvh/NAME.bvh and folder/push/*.csv, in
// millimetres. Each BVH is Cart (position) -> Rod (rotations phi about x, then theta about y) ->
// Hips, with both ankles at the cart's sides, so that the programs that read recordings find cart,
// rod and hip again. The manifest comes last: without it the folder is no recording.
MaybeError WriteFormationRecording(const std::string& folder, const FormationRun& run);

// Rows get too thin to read beyond these.
inline constexpr int kMostPeopleInWave = 300;

// The wave: time across, person down, colour the hip's speed (on a square-root scale; orange for
// going back, so that recoil does not look like the wave); pushes framed, each person's onset
// dotted, with its band where there are bands. Speeds that nobody walks at saturate, so that one
// who falls does not fade the others.
std::string WaveSvg(const FormationRun& run, const std::string& title,
                    const std::vector<OnsetBand>& onsets = {});

}  // namespace pushid
