// ident: settings of Yue et al., Human Motion Prediction Under Unexpected Perturbation, CVPR 2024,
// before FreeTerms (presets.h).
#pragma once

#include "ident/parameters/fit_options.h"

namespace pushid {

inline constexpr double kLdpRate = 60.0;  // Hz: LDP counts Kd per frame
inline constexpr char kLdpPublished[] = "ldp_published";
inline constexpr char kLdpPublishedGroups[] = "ldp_published_groups";

// Plain PD balance and one friction, from upright. Kd is 200 N m per frame of 1/60 s in the paper
// and in its code, hence 200 / 60 N m s/rad; to read it as SI, use
// --fix=Kd_theta=200,Kd_phi=200.
FitOptions LdpPreset();

// What LDP puts between people, to fit around: potential, torques against leaning on each other,
// and a small network on every neighbour.
FitOptions LdpGroupsPreset();

// LDP as published: one force law at all times, to which the push is added; all networks in their
// sizes, trained together with mu by LDP's loss; gains, potential and torques as they are given.
// The carts' Kd of 4 per frame acts on backward differences, as in LDP's code.
FitOptions LdpPublishedPreset();
FitOptions LdpPublishedGroupsPreset();

}  // namespace pushid
