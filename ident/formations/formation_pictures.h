// ident: a formation's run as pictures.
#pragma once

#include <string>

#include "ident/figures/svg.h"
#include "ident/formations/formation_run.h"

namespace pushid {

// Rows and panels get too thin to read beyond these.
inline constexpr int kMostPeopleInWave = 300;
inline constexpr int kMostPeopleInForces = 40;

// The wave: time across, person down, colour the hip's speed (on a square-root scale; orange for
// going back, so that recoil does not look like the wave); pushes
// framed, each person's onset dotted; a plan of the formation beside it.
std::string WaveSvg(const FormationRun& run, const std::string& title);

// One row of panels for each person: the net force along the push (N) and the torque about y (N m)
// over time with their parts.
std::string ForcesSvg(const FormationRun& run, const std::string& title);
SvgPicture ForcesPictureOf(const FormationRun& run, const std::string& title);

}  // namespace pushid
