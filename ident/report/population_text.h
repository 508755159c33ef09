// ident: how recordings differ from what the same push does to the mean person, in words and
// tables.
#pragma once

#include <string>
#include <vector>

#include "ident/figures/text_table.h"
#include "ident/results/recording_effect.h"

namespace pushid {

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
