// ident: profiles, bootstrap and diagnostics in words and tables for a terminal.
#pragma once

#include <string>
#include <vector>

#include "ident/figures/text_table.h"
#include "ident/model/fitted_model.h"
#include "ident/observed/recording_effect.h"

namespace pushid {

// Clustered, profile and bootstrap intervals side by side (only a header when neither was asked
// for), and whether they agree.
TextTable AgreementTable(const FittedModel& model);
std::string AgreementNote(const FittedModel& model);

// "resampling 4 people: 199 of 199 replicas, seed 1", and what to think of so few.
std::string ResamplingText(const Bootstrap& bootstrap);

// What was noted before the solve, the recordings that fit worst or move most, whether residuals
// are white, and what to try next.
std::string DiagnosticsText(const FittedModel& model);

// What the starts of a multi-start agree on.

// Starts whose cost is within this of the best one share its basin, or one as good.
inline constexpr double kSameCost = 0.01;  // relative

// How many starts ended as well as the best one, and over which range their parameters spread
// beside the best one's standard errors; empty for a single start.
std::string AcrossStartsText(const FitResult& result);

// The same in parts: a sentence, and a table (only a header when none is as good).
std::string AcrossStartsNote(const FitResult& result);
TextTable AcrossStartsTable(const FitResult& result);

// How recordings differ from what the same push does to the mean person, in words and
// tables.

// "b ~ N(0, w^2) on the log of tail_gain: w 0.43 +- 0.08 (4 clusters) ..."
std::string PopulationSentence(const RecordingEffect& effect);

// Means of the effects of each person and each condition.
TextTable EffectGroupsTable(const RecordingEffect& effect);
// One row a recording, by person, condition and effect: as shrunk, and alone.
TextTable EffectsTable(const RecordingEffect& effect);
// The rows' order.
std::vector<EffectOfRecording> SortedEffects(const RecordingEffect& effect);

// All of it.
std::string PopulationText(const RecordingEffect& effect);

}  // namespace pushid
