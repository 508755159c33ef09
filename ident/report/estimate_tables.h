// ident: what a result says about parameters, behaviour, contrasts and the loop, as tables and
// sentences; the report on a terminal and the page show the same ones. Functions are pure; a text
// is empty, and a table only a header, where there is nothing to say.
#pragma once

#include <string>

#include "ident/figures/text_table.h"
#include "ident/model/fitted_model.h"

namespace pushid {

// The end of a 95 % interval as it is shown: infinite where it tells nothing (of a positive value a
// factor of more than 100 away, or with an interval over four orders of magnitude).
double ShownEnd(double value, double end, double other_end);
// "[20, 42]", "[20, open]"; "undetermined" where both ends are open.
std::string IntervalText(double value, double lower, double upper, int digits = 4);

// Values of the free parameters and the intervals that decide; of many, those first that the
// recordings tell something of.
TextTable ShortTable(const FitResult& result);
// "Ankle stiffness 1.6 times m g l (1 is just enough to hold a pendulum upright), ..."
std::string GainsText(const FitResult& result);
// Why the fitted person does not come to rest; empty of one who does.
std::string BalanceText(const FitResult& result);
// The behaviour after a push, in words and settling simulation by settling simulation.
std::string BehaviourText(const FitResult& result);
TextTable BehaviourTable(const FitResult& result);

// The difference between two values of a label; below it who is compared with whom, whether effects
// are in standard deviations, and Holm's correction.
TextTable ContrastTable(const Contrast& contrast);
std::string ContrastText(const FitResult& result);

// The identified loop of the quoted person (problem/linear_loop.h), a row for each plane, one for
// both where they are alike: stiffness over m g l, damping ratio and frequency of the slowest
// oscillation, phase and delay margin, factors between which the gains may change. Feet that slide
// have none.
TextTable LoopTable(const FitResult& result);
// The delay that the residuals ask for and the model leaves out.
std::string LagText(const FitResult& result);

}  // namespace pushid
