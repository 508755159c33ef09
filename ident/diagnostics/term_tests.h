// ident: do the recordings ask for a term that the model leaves out?
//
// A score (Lagrange multiplier) test of each linear self force that is held at zero, clustered as
// the standard errors are: with J_n the term's column at the estimate, freed of what the fitted
// parameters explain of it, s_g = J_n' r over cluster g and t = sum s_g / sqrt(G / (G - 1) sum (s_g
// - mean)^2), G - 1 degrees of freedom (Wooldridge 2010, section 12.6). It costs one evaluation of
// the Jacobian and needs no fit with the term.
#pragma once

#include <string>
#include <vector>

#include "ident/diagnostics/diagnostics.h"

namespace pushid {

// Empty for networks and many columns, and with fewer than three clusters.
std::vector<TermTest> TestTerms(const FitProblem& problem, const FitPoint& estimate);

}  // namespace pushid
