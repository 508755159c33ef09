// ident: the effects of recordings for readers.
#include "ident/report/population_text.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "datasets/files/number_text.h"
#include "ident/problem/time_series.h"

namespace pushid {
namespace {

using Pick = std::string EffectOfRecording::*;

void AddGroups(const RecordingEffect& effect, const char* title, Pick pick, TextTable* table) {
  std::map<std::string, std::vector<double>> groups;
  for (const EffectOfRecording& r : effect.recordings) groups[r.*pick].push_back(r.mean);
  if (groups.size() < 2) return;
  for (const auto& [name, effects] : groups) {
    const MeanAndError mean = MeanOf(effects);
    table->Add({title + (name.empty() ? "none" : name), std::to_string(effects.size()),
                Rounded(mean.mean, 2),
                effects.size() > 1 ? "+- " + Rounded(mean.error, 2) : std::string(),
                Rounded(std::exp(mean.mean), 3)});
  }
}

}  // namespace

std::string PopulationSentence(const RecordingEffect& effect) {
  const std::string scale = "the error of a rollout is " + Rounded(effect.error_scale, 3) +
                            " m half a second after a push of 0.2 m/s";
  if (effect.recordings.empty()) {
    return "No recording effect: it needs people who are pushed alone and a model with a push "
           "tail. " +
           scale + ".";
  }
  return "Recordings differ by a factor exp(b) on tail_gain, b ~ N(0, w^2): w = " +
         Rounded(effect.spread, 3) + " +- " + Rounded(effect.spread_error, 2) + " (" +
         std::to_string(effect.clusters) +
         " clusters, left out one at a time). Each recording's own b removes " +
         Rounded(100.0 * effect.explained, 2) +
         " % of the mean squared error of the hip, divided by the push's speed; without it " +
         scale +
         ". Effects are shrunk towards 0 where a recording contains little information; alone: the "
         "estimate without shrinkage.";
}

std::vector<EffectOfRecording> SortedEffects(const RecordingEffect& effect) {
  std::vector<EffectOfRecording> sorted = effect.recordings;
  std::sort(sorted.begin(), sorted.end(),
            [](const EffectOfRecording& a, const EffectOfRecording& b) {
              return std::tie(a.person, a.condition, a.mean, a.id) <
                     std::tie(b.person, b.condition, b.mean, b.id);
            });
  return sorted;
}

TextTable EffectGroupsTable(const RecordingEffect& effect) {
  TextTable table({"effect of", "recordings", "mean b", "", "factor"},
                  {true, false, false, true, false});
  AddGroups(effect, "person ", &EffectOfRecording::person, &table);
  AddGroups(effect, "condition ", &EffectOfRecording::condition, &table);
  return table;
}

TextTable EffectsTable(const RecordingEffect& effect) {
  TextTable table({"recording", "person", "condition", "b", "", "factor", "alone"},
                  {true, true, true, false, true, false, false});
  for (const EffectOfRecording& r : SortedEffects(effect)) {
    table.Add({r.id, r.person, r.condition, Rounded(r.mean, 2), "+- " + Rounded(r.error, 2),
               Rounded(std::exp(r.mean), 3), Rounded(r.alone, 2)});
  }
  return table;
}

std::string PopulationText(const RecordingEffect& effect) {
  std::string text = PopulationSentence(effect) + "\n";
  for (const TextTable& table : {EffectGroupsTable(effect), EffectsTable(effect)}) {
    if (table.rows().size() > 1) text += table.ToString();
  }
  return text;
}

}  // namespace pushid
