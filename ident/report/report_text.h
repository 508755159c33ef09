// ident: a fit's result in words and tables for a terminal: a pure function of the result.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "ident/figures/text_table.h"
#include "ident/model/fitted_model.h"
#include "ident/model/identified_model.h"
#include "ident/observed/recording_filter.h"

namespace pushid {

// "1 score", "2 scores".
std::string Count(int number, const std::string& noun);

// The parameter table, what is derived, what the data cannot tell apart, what the fitted person
// does after a push, warnings.
std::string ReportText(const FittedModel& model);

// What is learned on top of the physics, and what it acts like; no line break at the end, and empty
// where nothing is.
std::string NetworkText(const FitResult& result);

// -2 log likelihood, AIC, BIC and what they may be compared with; result.likelihood must be there.
std::string LikelihoodText(const FitResult& result);

// What was done to recordings before the fit, as the report says it.

// "motion: low-pass at 6 Hz (zero-phase Butterworth), resampled to 60 frames per second" with a
// newline, from the flags that a result keeps; empty where the motion was taken as recorded. A
// replica of a bootstrap says so on a line of its own.
std::string PreparationText(const std::map<std::string, std::string>& configuration);

// Identified values beside the truth of synthetic recordings.

// The true parameters, by name, that a manifest of pushid-simulate holds under `synthetic`.
// Errors: unreadable, or a manifest of real recordings.
Result<std::map<std::string, double>> ReadTruth(const std::string& manifest_path);

// truth | identified | 95 % interval | whether it covers the truth, for every fitted parameter.
std::string TruthTable(const FitResult& result, const std::map<std::string, double>& truth);

// The difference between two values of a label, as a table and in words. Pure functions of
// the result.

// Only a header without a contrast.
TextTable ContrastTable(const Contrast& contrast);

// Who is compared with whom, whether effects are told in standard deviations, and what Holm's
// correction says: a line each.
std::string ContrastText(const FitResult& result);

// How hips are forecast that were seen to begin, in words.
std::string ForecastText(const ForecastRule& forecasts);

// The identified loop in the numbers that a control engineer quotes.

// A row for each plane, one for both where they are alike: stiffness over m g l, damping ratio and
// frequency of the slowest oscillation, phase margin, delay margin, factors between which the gains
// may change (problem/linear_loop.h), of the person that gains are quoted for. Only a header where
// feet slide, or a model has no closed form.
TextTable LoopTable(const FitResult& result);

// The same in sentences; empty where the table is.
std::string LoopText(const FitResult& result);

// What the residuals say of a delay that the model leaves out, which is taken for less damping;
// empty: nothing.
std::string LagText(const FitResult& result);

// How values and intervals are said, in tables and sentences alike.

// The end of a 95 % interval as it is shown: one that tells nothing (of a positive value a factor
// of more than 100 away, or with an interval over four orders of magnitude) is infinite.
double ShownEnd(double value, double end, double other_end);
// "[20, 42]", "[20, open]"; "undetermined" where both ends are open.
std::string IntervalText(double value, double lower, double upper);

// The gains in words: "ankle stiffness 1.6 times m g l (1 just holds a pendulum upright)".
std::string GainsText(const FitResult& result);

// The verdict on a model in words (uncertainty/model_verdict.h).

// "The model fits: ..." or "The model does not fit: ..." with what does not and what to try; or
// why nothing was checked.
std::string ModelVerdictText(const ModelVerdict& verdict);

// What was taken as known, with what is stated of it, what the recordings want, and the test.
TextTable AssumptionTable(const FitResult& result);

// Profiles, bootstrap and diagnostics in words and tables for a terminal.

// Of the parameter or combination of that name; none where it was not asked for.
std::optional<Interval> ProfileInterval(const FittedModel& model, const std::string& name);
std::optional<Interval> BootstrapInterval(const FittedModel& model, const std::string& name);
// Both beside the clustered interval; only a header when neither was asked for.
TextTable IntervalTable(const FittedModel& model);

// "resampling 4 people: 199 of 199 replicas, seed 1", and what to think of so few.
std::string ResamplingText(const Bootstrap& bootstrap);

// What was noted before the solve, the recordings that fit worst or move most, whether residuals
// are white, and what to try next.
std::string DiagnosticsText(const FittedModel& model);

// What a result says, as tables and sentences: the terminal's report and the page show the
// same ones. Pure functions of the result; empty where there is nothing to say.

TextTable EstimateTable(const FitResult& result);
// Which of the free parameters the data identify: "All 7 free parameters are identified by the
// data.", or how many, and which are not and why.
std::string IdentifiedText(const FitResult& result);
// What the columns of shares and pulls mean.
std::string SharesNote();

// How errors were estimated, and whom they are about.
std::string HowSure(const FitResult& result);

// What the feet of the model do, and why.
std::string FeetOfFit(const FitResult& result);

// c_x, c_y and gains per mass, and the convention that separates mu from Kp.
TextTable DerivedTable(const FitResult& result);
std::string ConventionText(const FitResult& result);

// Values of each unit that parameters are pooled by; only a header where nothing is pooled.
TextTable PooledTable(const FitResult& result);
// The shared values and how far units differ from them; only a header where nothing is pooled.
TextTable SpreadTable(const FitResult& result);

// Pairs of parameters that the data separate poorly.
std::string CorrelationText(const FitResult& result);

// What people do after a push, in words, and settling simulation by settling simulation.
std::string BehaviourText(const FitResult& result);
// Where lines that are pushed forwards at their first person end up; only a header where no person
// touches.
TextTable LinesTable(const FitResult& result);
TextTable BehaviourTable(const FitResult& result);

}  // namespace pushid
