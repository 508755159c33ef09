// models: what a model may be made of, one row for each: laws of friction, self forces
// and parameters. Names, flags, defaults, bounds, the glossary and what acts where
// are made from the rows (options.h, interaction.h, parameters.h).
#pragma once

#include "models/parameter_rows.h"

// X(id, name, along_y, Law): a law of friction.
//   name     of --friction
//   along_y  the parameter that is the drag along y as mu is along x (self_terms.h)
//   Law      its formula (self_terms.h)
#define PUSHID_FRICTION_LAWS(X)                    \
  X(kIsotropic, "isotropic", kMu, LinearDrag)      \
  X(kAnisotropic, "anisotropic", kMuY, LinearDrag) \
  X(kCoulomb, "coulomb", kMu, CoulombDrag)

// What --self_force names: at most one law and at most one network.
//
// Law(id, name, first, last, mode_weight, note): a law of closed form (self_terms.h).
//   first, last  its parameters, which are zero where it does not act and are freed where it does
//   mode_weight  weight with it of the demand that free modes decay
//   note         for the help
// Network(id, name, gates, recurrent, cell, biased, Kind): a kind of network (self_network.h).
//   gates      rows [W U C] per hidden unit
//   recurrent, cell  whether it remembers its hidden units, and cells besides
//   biased     whether it has LDP's biases, so that a person at rest may feel a force
//   Kind       its formula (MlpCell in self_network.h) and, by hand, its derivatives (AdvanceMlp in
//              network_sensitivities.cc, ActivateMlp and DeactivateMlp in residuals/packed/)
// clang-format off
#define PUSHID_SELF_FORCES(Law, Network) \
  Law(kLinear, "linear", kAx, kDq, 30.0, "cross terms, quadratic") \
  Network(kMlp, "mlp", 1, false, false, false, Mlp) \
  Network(kGru, "gru", 2, true, false, false, Gru) \
  Network(kLstm, "lstm", 3, true, true, false, Lstm) \
  Network(kLdp, "ldp", 4, true, true, true, Ldp)
// clang-format on
#define PUSHID_NO_SELF_FORCE(...)  // for tables of the other kind alone
