// ident: a fit's result in words, and the screen that a terminal shows first.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "datasets/files/error.h"
#include "ident/figures/screen.h"
#include "ident/figures/text_table.h"
#include "ident/model/fitted_model.h"
#include "ident/model/identified_model.h"
#include "ident/report/estimate_tables.h"

namespace pushid {

// Recordings that standing still predicts better, and the verdict on the model; brief: without the
// numbers of its tests, and with its first finding alone.
std::string FirstSentences(const FitResult& result, bool brief = false);

// The first screen of a fit: verdict, values, gains, warnings, and the first advice. The rest is
// in BuildReport of page/build_report.h.
Screen ScreenOf(const FittedModel& model);

// The learned terms: "rod ldp:2 (29 weights, prior 1)"; empty where nothing is learned.
std::string NetworkText(const FitResult& result);

// -2 log likelihood, AIC, BIC and what they may be compared with; result.likelihood must be there.
std::string LikelihoodText(const FitResult& result);

// "motion: low-pass at 6 Hz (zero-phase Butterworth), resampled to 60 frames per second", and on a
// line of its own whether this is a bootstrap's replica; from the flags that a result keeps.
std::string PreparationText(const std::map<std::string, std::string>& configuration);

// The true parameters, by name, that a manifest of pushid-simulate holds under `synthetic`.
// Errors: unreadable, or a manifest of real recordings.
Result<std::map<std::string, double>> ReadTruth(const std::string& manifest_path);
// truth | identified | 95 % interval | whether it covers the truth, for every fitted parameter.
std::string TruthTable(const FitResult& result, const std::map<std::string, double>& truth);

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
// with what to check or to try, or why nothing was checked. more: than was said before it.
std::string ModelVerdictText(const ModelVerdict& verdict, bool more = false, bool brief = false);

// Its name among a manifest's stated_errors; empty of what the laboratory does not measure.
std::string StatedErrorKey(const AssumptionTest& test);

// A row for each quantity that was taken as known: stated error, wanted value, test.
TextTable AssumptionTable(const FitResult& result);

}  // namespace pushid
