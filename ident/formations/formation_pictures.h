// ident: a formation's run as pictures.
#pragma once

#include <string>

#include "ident/figures/svg.h"
#include "ident/formations/formation_run.h"
#include "ident/formations/wave_speed.h"

namespace pushid {

// Rows and panels get too thin to read beyond these.
inline constexpr int kMostPeopleInWave = 300;
inline constexpr int kMostPeopleInForces = 40;

// The wave: time across, person down, colour the hip's speed (on a square-root scale; orange for
// going back, so that recoil does not look like the wave); pushes
// framed, each person's onset dotted, with its band where there are bands; a plan of the formation
// beside it. Speeds that nobody walks at saturate, so that one who falls does not fade the others.
std::string WaveSvg(const FormationRun& run, const std::string& title,
                    const std::vector<OnsetBand>& onsets = {});

// One row of panels for each person: the net force along the push (N) and the torque about y (N m)
// over time with their parts. On one scale, so that heights compare, or each panel on its own:
// what the tenth person feels is a fraction of the push.
enum class ForceScale { kShared, kOwn };
std::string ForcesSvg(const FormationRun& run, const std::string& title,
                      ForceScale scale = ForceScale::kShared);
SvgPicture ForcesPictureOf(const FormationRun& run, const std::string& title,
                           ForceScale scale = ForceScale::kShared);

}  // namespace pushid
