// models: what a model may be made of, one row for each: laws of friction and parameters. Names,
// flags, defaults, bounds, the glossary and what acts where are made from the rows (options.h,
// self_terms.h, parameters.h).
#pragma once

// X(id, name, along_y, Law): a law of friction.
//   name     of --friction
//   along_y  the parameter that is the drag along y as mu is along x (self_terms.h)
//   Law      its formula (self_terms.h)
#define PUSHID_FRICTION_LAWS(X)                    \
  X(kIsotropic, "isotropic", kMu, LinearDrag)      \
  X(kAnisotropic, "anisotropic", kMuY, LinearDrag) \
  X(kCoulomb, "coulomb", kMu, CoulombDrag)

// X(id, name, symbol, unit, nominal, lower, upper, scale, transform, acts, freed, meaning, when): a
// parameter.
//   name       on the command line and in files
//   symbol     in the equation that heads the file of its term
//   nominal    start of a fit, value when fixed: where its term vanishes, or LDP's
//   lower, upper  bounds of a fit
//   scale      a typical size, for scaling null directions and judging "weak"
//   transform  the scale on which it is fitted (parameters.h)
//   acts       for a model m: whether the parameter has any effect
//   freed      whether choosing its term frees it, with a weak prior
//   meaning    what it is
//   when       when to free it
//
// Gains are quoted for the reference person (85 kg, rod 0.95 m); see GainScaleOf in self_terms.h.
// Parameters of one term stand together: friction from kMu up to kKpX, contact from
// kContactStiffness to kContactHeight, all that two people share from there up to kSupportFront.

// clang-format off
#define PUSHID_PARAMETERS(X) \
  /* friction and balance: the cart's gains may turn negative, the data must be able to say so */ \
  X(kMu, "mu", "mu", "N s/m", 100, -2000, 2000, 100, kIdentity, \
    m.stance == Stance::kSlide, false, \
    "drag of the stepping feet (not floor friction)", \
    "always: with Kp_x and Kp_y held it is the whole drag of the stepping feet") \
  X(kMuY, "mu_y", "mu_y", "N s/m", 100, -2000, 2000, 100, kIdentity, \
    m.friction == FrictionKind::kAnisotropic && m.stance == Stance::kSlide, false, \
    "drag of the stepping feet along y", \
    "with pushes to the side, and anisotropic friction") \
  X(kCoulombFriction, "mu_coulomb", "mu_c", "1", 0.02, 0, 5, 0.05, kIdentity, \
    m.friction == FrictionKind::kCoulomb && m.stance == Stance::kSlide, \
    m.friction == FrictionKind::kCoulomb, \
    "dry friction of the cart over its weight", \
    "with --friction=coulomb: rigs and robots whose cart comes to a stop") \
  X(kKpX, "Kp_x", "Kp_x", "N s/m", 0, -2000, 2000, 100, kIdentity, \
    m.stance == Stance::kSlide, false, \
    "balance gain on the cart's velocity, x", \
    "never together with mu: only mu + Kp_x is identifiable") \
  X(kKpY, "Kp_y", "Kp_y", "N s/m", 0, -2000, 2000, 100, kIdentity, \
    m.stance == Stance::kSlide, false, \
    "balance gain on the cart's velocity, y", \
    "never together with mu or mu_y: only the sum is identifiable") \
  X(kKpTheta, "Kp_theta", "Kp_theta", "N m/rad", 1500, 1, 1e5, 1500, kLog, \
    true, false, \
    "balance stiffness about y", \
    "always, with pushes forwards or backwards") \
  X(kKpPhi, "Kp_phi", "Kp_phi", "N m/rad", 1500, 1, 1e5, 1500, kLog, \
    true, false, \
    "balance stiffness about x", \
    "with pushes to the side") \
  X(kKdX, "Kd_x", "Kd_x", "kg", 0, -500, 500, 10, kIdentity, \
    m.cart_derivative == CartDerivative::kBackward, false, \
    "balance gain on the cart's acceleration, x", \
    "to compare with LDP's code; it is an algebraic loop") \
  X(kKdY, "Kd_y", "Kd_y", "kg", 0, -500, 500, 10, kIdentity, \
    m.cart_derivative == CartDerivative::kBackward, false, \
    "balance gain on the cart's acceleration, y", \
    "to compare with LDP's code; it is an algebraic loop") \
  X(kKdTheta, "Kd_theta", "Kd_theta", "N m s/rad", 70, 1e-3, 1e4, 70, kLog, \
    true, false, \
    "balance damping about y", \
    "where the angular rates are well measured") \
  X(kKdPhi, "Kd_phi", "Kd_phi", "N m s/rad", 70, 1e-3, 1e4, 70, kLog, \
    true, false, \
    "balance damping about x", \
    "with pushes to the side and well measured rates") \
  /* how late active feedback comes, and what muscles do at once (reaction_delay.h) */ \
  X(kReactionDelay, "reaction_delay", "d", "s", 0.13, 0.005, 0.6, 0.05, kLog, \
    m.delay != Delay::kNone, m.delay != Delay::kNone, \
    "reaction delay of active feedback", \
    "with --delay: people answer after 0.1 to 0.2 s, and without it damping comes out too low") \
  X(kStepDelay, "step_delay", "d_s", "s", 0.2, 0.005, 0.8, 0.05, kLog, \
    m.delay == Delay::kAnkleAndStep && m.stance != Stance::kFixed, \
    m.delay == Delay::kAnkleAndStep && m.stance != Stance::kFixed, \
    "reaction delay of the feet", \
    "with --delay=ankle_and_step") \
  X(kPassiveStiffness, "passive_stiffness", "s_K", "1", 0.2, 0.005, 0.99, 0.2, kLogit, \
    m.delay != Delay::kNone, m.delay != Delay::kNone, \
    "share of the stiffness that acts at once", \
    "with --delay: muscles and tendons do not wait") \
  X(kPassiveDamping, "passive_damping", "s_D", "1", 0.2, 0.005, 0.99, 0.2, kLogit, \
    m.delay != Delay::kNone, m.delay != Delay::kNone, \
    "share of the damping that acts at once", \
    "with --delay: muscles and tendons do not wait") \
  /* the body and its drive, of robots and rigs (ipm.h) */ \
  X(kCartMassShare, "cart_share", "s_c", "1", 0.1, 0.001, 0.98, 0.1, kLogit, \
    m.body == BodyModel::kTable && m.stance == Stance::kSlide, false, \
    "share of the mass that is in the cart", \
    "with --body=table, where it is not known") \
  X(kGyrationRadius, "gyration_radius", "r", "1", 0, 0, 3, 0.3, kIdentity, \
    m.body == BodyModel::kTable && m.stance == Stance::kSlide, false, \
    "radius of gyration about the centre of mass over the rod", \
    "with --body=table, where it is not known") \
  X(kPushGain, "push_gain", "g_u", "1", 1, 0.01, 100, 1, kLog, \
    m.body == BodyModel::kTable, false, \
    "force of a push over what was recorded of it", \
    "with --body=table, where a motor's force is known up to a factor") \
  /* the linear self force */ \
  X(kAx, "a_x", "a_x", "m/s^2/rad", 0, -200, 200, 10, kIdentity, \
    m.stance == Stance::kSlide, false, \
    "cart force from the lean, x", \
    "where the feet follow the lean, as they do after most pushes") \
  X(kAy, "a_y", "a_y", "m/s^2/rad", 0, -200, 200, 10, kIdentity, \
    m.stance == Stance::kSlide, false, \
    "cart force from the lean, y", \
    "with pushes to the side") \
  X(kBx, "b_x", "b_x", "m/s/rad", 0, -50, 50, 2, kIdentity, \
    m.stance == Stance::kSlide, false, \
    "cart force from the lean's rate, x", \
    "with many recordings: only fast motion separates it from a_x") \
  X(kBy, "b_y", "b_y", "m/s/rad", 0, -50, 50, 2, kIdentity, \
    m.stance == Stance::kSlide, false, \
    "cart force from the lean's rate, y", \
    "with many pushes to the side") \
  X(kTx, "t_x", "t_x", "m/s", 0, -50, 50, 2, kIdentity, \
    m.stance == Stance::kSlide, false, \
    "torque from the cart's velocity, x", \
    "where the lean goes on while the cart runs") \
  X(kTy, "t_y", "t_y", "m/s", 0, -50, 50, 2, kIdentity, \
    m.stance == Stance::kSlide, false, \
    "torque from the cart's velocity, y", \
    "with many pushes to the side") \
  X(kCq, "c_q", "c_q", "1/m", 0, -20, 20, 0.5, kIdentity, \
    m.stance == Stance::kSlide, false, \
    "quadratic damping of the cart", \
    "with pushes of very different strength") \
  X(kDq, "d_q", "d_q", "1/rad", 0, -50, 50, 1, kIdentity, \
    m.stance == Stance::kSlide, false, \
    "quadratic damping of the angles", \
    "with pushes of very different strength") \
  /* the push tail */ \
  X(kTailGain, "tail_gain", "g", "1", 1, 1e-3, 50, 1, kLog, \
    m.push_tail == PushTail::kExponential && m.stance != Stance::kFixed, false, \
    "ratio of tail force to mean push force", \
    "where the pushes cover only their first part") \
  X(kTailTorque, "tail_torque", "r", "1", 0.3, -50, 50, 0.3, kIdentity, \
    m.push_tail == PushTail::kExponential && m.stance == Stance::kSlide, false, \
    "ratio of tail torque to mean push torque", \
    "where the pushes cover only their first part") \
  X(kTailTime, "tail_time", "t", "s", 0.2, 0.005, 5, 0.2, kLog, \
    m.push_tail == PushTail::kExponential && m.stance != Stance::kFixed, false, \
    "tail's decay time after a push of 0.1 s", \
    "where the pushes cover only their first part") \
  X(kTailExponent, "tail_exponent", "e", "1", 0, -5, 5, 1, kIdentity, \
    m.push_tail == PushTail::kExponential && m.stance != Stance::kFixed, false, \
    "growth of that time with the push's duration", \
    "with pushes of different duration") \
  X(kTailBase, "tail_base", "b", "m/s", 0, -5, 5, 0.5, kIdentity, \
    m.push_tail == PushTail::kExponential && m.stance != Stance::kFixed, false, \
    "speed from the tail's part that does not depend on the push", \
    "with pushes of different strength that cover only their first part") \
  /* between people: contact first, in one piece */ \
  X(kContactStiffness, "contact_stiffness", "A", "N/m", 2000, 1, 1e5, 2000, kLog, \
    m.interaction.spring, m.interaction.spring, \
    "stiffness of contact between people", \
    "where people touch") \
  X(kContactDistance, "contact_distance", "d_contact", "m", 0.4, 0.05, 1.5, 0.4, kLog, \
    m.interaction.Contact(), m.interaction.Contact(), \
    "distance at which people touch", \
    "where people touch") \
  X(kContactKappa, "contact_kappa", "kappa", "1", 0.6, 0.01, 10, 0.6, kLog, \
    m.interaction.Contact(), m.interaction.Contact(), \
    "weight of the sideways distance", \
    "where people stand side by side as well") \
  X(kContactDamping, "contact_damping", "B", "N s/m", 100, 1e-3, 1e4, 100, kLog, \
    m.interaction.damping, m.interaction.damping, \
    "damping of contact", \
    "where people touch") \
  X(kContactHeight, "contact_height", "s", "1", 0.5, 0.01, 1.6, 0.5, kIdentity, \
    m.interaction.Contact(), false, \
    "height of contact over the ankles, in lengths of the rod (1: the hip)", \
    "with many groups that touch, whose check says so") \
  X(kPotentialStrength, "potential_strength", "u", "N m", 150, 0.1, 1e5, 150, kLog, \
    m.interaction.ldp_published, false, \
    "strength of LDP's potential", \
    "to compare with LDP") \
  X(kPotentialLength, "potential_length", "sigma", "m", 0.5, 0.02, 5, 0.5, kLog, \
    m.interaction.ldp_published, false, \
    "decay length of LDP's potential", \
    "to compare with LDP") \
  X(kNeighbourRange, "neighbour_range", "range", "m", 0.5, 0.1, 3, 0.5, kLog, \
    m.interaction.AtCarts(), false, \
    "cart distance at which LDP's terms end", \
    "where people stand farther apart than half a metre") \
  X(kLeanTheta, "lean_theta", "k_theta", "N m", 100, -2000, 2000, 100, kIdentity, \
    m.interaction.ldp_published, false, \
    "torque against leaning on others, y", \
    "to compare with LDP") \
  X(kLeanPhi, "lean_phi", "k_phi", "N m", 50, -2000, 2000, 100, kIdentity, \
    m.interaction.ldp_published, false, \
    "torque against leaning on others, x", \
    "to compare with LDP") \
  /* feet that stand and step (stance.h) */ \
  X(kSupportFront, "support_front", "b", "m", 0.1, 0.01, 0.5, 0.1, kLog, \
    m.stance == Stance::kSteps, false, \
    "how far before the ankles the capture point goes before a step is due", \
    "with pushes forwards, some of which make people step and some not") \
  X(kSupportBack, "support_back", "b_back", "m", 0.06, 0.01, 0.5, 0.06, kLog, \
    m.stance == Stance::kSteps, false, \
    "how far behind the ankles the capture point goes before a step is due", \
    "with pushes backwards, some of which make people step and some not") \
  X(kSupportSide, "support_side", "b_side", "m", 0.1, 0.01, 0.5, 0.1, kLog, \
    m.stance == Stance::kSteps, false, \
    "how far beside an ankle the capture point goes before a step is due", \
    "with pushes to the side, some of which make people step and some not") \
  X(kFootFront, "foot_front", "f", "m", 0.2, 0.02, 0.5, 0.1, kLog, \
    m.stance == Stance::kSteps, false, \
    "how far before the ankles the centre of pressure reaches", \
    "never without force plates: few recorded people reach the limit") \
  X(kStepGain, "step_gain", "kappa", "1", 0.9, 0.05, 5, 1, kLog, \
    m.stance == Stance::kSteps, false, \
    "length of a step over the way of the capture point at landing", \
    "with recordings long enough to show where the feet end") \
  X(kStepOnset, "step_onset", "t_on", "s", 0.5, 0.005, 2, 0.2, kLog, \
    m.stance == Stance::kSteps, false, \
    "how long a step is prepared just beyond the edge of the support", \
    "where feet hold and step") \
  X(kStepSwing, "step_swing", "t_s", "s", 0.32, 0.05, 2, 0.2, kLog, \
    m.stance == Stance::kSteps, false, \
    "how long the foot of a first step is in the air", \
    "where feet hold and step") \
  /* feet that hold, whatever happens (standing.h) */ \
  X(kComHeight, "com_height", "k", "1", 1.09, 0.1, 2, 0.1, kLog, \
    m.stance == Stance::kFixed || m.body == BodyModel::kTable, false, \
    "height of the body's centre of mass above the ankles over the hip's", \
    "with known pushes on people who stand: it tells where their mass is") \
  /* process noise, and the noise of what is measured (process_noise.h); freed by a likelihood */ \
  X(kSigmaX, "sigma_x", "sigma_x", "N s^0.5", 20, 1e-4, 1e5, 20, kLog, \
    m.process_noise != ProcessNoise::kNone, false, \
    "white force along x", \
    "with --likelihood=transition or innovation") \
  X(kSigmaY, "sigma_y", "sigma_y", "N s^0.5", 20, 1e-4, 1e5, 20, kLog, \
    m.process_noise != ProcessNoise::kNone, false, \
    "white force along y", \
    "with --likelihood=transition or innovation") \
  X(kSigmaTheta, "sigma_theta", "sigma_theta", "N m s^0.5", 15, 1e-4, 1e5, 15, kLog, \
    m.process_noise != ProcessNoise::kNone, false, \
    "white torque about y", \
    "with --likelihood=transition or innovation") \
  X(kSigmaPhi, "sigma_phi", "sigma_phi", "N m s^0.5", 15, 1e-4, 1e5, 15, kLog, \
    m.process_noise != ProcessNoise::kNone, false, \
    "white torque about x", \
    "with --likelihood=transition or innovation") \
  X(kMeasuredCart, "measured_cart", "s_c", "m", 0.003, 1e-4, 1, 0.003, kLog, \
    m.process_noise != ProcessNoise::kNone, false, \
    "error of the measured cart on each axis", \
    "with --likelihood=innovation") \
  X(kMeasuredHip, "measured_hip", "s_h", "m", 0.003, 1e-4, 1, 0.003, kLog, \
    m.process_noise != ProcessNoise::kNone, false, \
    "error of the measured hip on each axis", \
    "with --likelihood=innovation")
// clang-format on
