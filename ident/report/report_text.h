// ident: a fit's result in words and tables, of which the report and the screen that a terminal
// shows first are made. Functions are pure; a text is empty, and a table only a header, where there
// is nothing to say.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "datasets/files/error.h"
#include "ident/figures/text_table.h"
#include "ident/model/fitted_model.h"
#include "ident/model/identified_model.h"

namespace pushid {

// The end of a 95 % interval as it is shown: infinite if it bounds nothing (for a positive value:
// if it is a factor of more than 100 away, or the interval spans four orders of magnitude).
double ShownEnd(double value, double end, double other_end);
// "[20, 42]", "[20, open]"; "undetermined" where both ends are open.
std::string IntervalText(double value, double lower, double upper, int digits = 4);

// Values of the free parameters with their deciding intervals; if there are many, the identified
// ones come first and the prior-held ones last.
TextTable ShortTable(const FitResult& result);
// "Ankle stiffness 1.6 times m g l (1 is just enough to hold a pendulum upright), ..."
std::string GainsText(const FitResult& result);
// Why the fitted person does not come to rest; empty if the person does.
std::string BalanceText(const FitResult& result);
// The behaviour after a push, in words and settling simulation by settling simulation.
std::string BehaviourText(const FitResult& result);
TextTable BehaviourTable(const FitResult& result);

inline constexpr double kHolmLevel = 0.05;
// The difference between two values of a label; below it who is compared with whom, whether effects
// are in standard deviations, and Holm's correction.
TextTable ContrastTable(const Contrast& contrast);
std::string ContrastText(const FitResult& result);
// The surest of these differences in one sentence; empty of a fit without a contrast.
std::string DifferencesText(const FitResult& result);

// The identified loop of the quoted person (problem/linear_loop.h), a row for each plane, one for
// both where they are alike: stiffness over m g l, damping ratio and frequency of the slowest
// oscillation, phase and delay margin, factors between which the gains may change. Feet that slide
// have none.
TextTable LoopTable(const FitResult& result);
// The delay that the residuals ask for and the model leaves out.
std::string LagText(const FitResult& result);

// Recordings that standing still predicts better, and the verdict on the model; brief: without the
// numbers of its tests, and with its first finding alone.
std::string FirstSentences(const FitResult& result, bool brief = false);

// The first screen of a fit: verdict, values, gains, warnings, and the first advice. The rest is
// in BuildReport of page/build_report.h.
Screen ScreenOf(const FittedModel& model);

// The learned terms: "rod ldp:2 (29 weights, prior 1)"; empty where nothing is learned.
std::string NetworkText(const FitResult& result);

// A sentence on how hips are forecast after observed frames.
std::string ForecastText(const ForecastRule& forecasts);

// The interval of the parameter or combination of that name; none where it was not asked for.
std::optional<Interval> ProfileInterval(const FittedModel& model, const std::string& name);
std::optional<Interval> BootstrapInterval(const FittedModel& model, const std::string& name);
// Both intervals beside the clustered one; only a header where neither was asked for.
TextTable IntervalTable(const FittedModel& model);

// "resampling 4 people: 199 of 199 replicas, seed 1", and a warning where so few can be resampled.
std::string ResamplingText(const Bootstrap& bootstrap);

// The verdict on a model in words (uncertainty/model_verdict.h).

// "The model check found no contradiction: ...", or "The model does not fit these recordings: ..."
// with what to check or to try, or why nothing was checked. more: another finding stands before it.
std::string ModelVerdictText(const ModelVerdict& verdict, bool more = false, bool brief = false);

// A row for each quantity that was taken as known: stated error, wanted value, test.
TextTable AssumptionTable(const FitResult& result);

}  // namespace pushid
