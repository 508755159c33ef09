#include "ident/validation/group_metrics.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numeric>

#include "ident/parameters/json_archive.h"
#include "ident/prediction/propagation.h"
#include "models/restoration/cvae_restoration.h"

namespace pushid {
namespace {

constexpr double kWholeFrame = 0.1;  // frames; rates are rounded

int WordFrames(const GroupMotion& group) {
  const double seconds = (static_cast<double>(group.people.front().size()) - 1.0) * group.dt;
  return 1 + static_cast<int>(seconds * kWordRate + kWholeFrame);
}

template <typename Value>
std::vector<Value> AtWordRate(const std::vector<Value>& values, const GroupMotion& group) {
  std::vector<Value> resampled;
  for (int k = 0; k < WordFrames(group); ++k) {
    const auto at = static_cast<size_t>(std::lround(k / (kWordRate * group.dt)));
    resampled.push_back(values[std::min(at, values.size() - 1)]);
  }
  return resampled;
}

constexpr int kNever = -1;

// True where a begins before b: people who never move come last.
bool Before(int a, int b) { return a != kNever && (b == kNever || a < b); }

int FirstOf(const std::vector<int>& onsets) {
  size_t first = 0;
  for (size_t n = 1; n < onsets.size(); ++n) {
    if (Before(onsets[n], onsets[first])) first = n;
  }
  return onsets[first] == kNever ? kNever : static_cast<int>(first);
}

std::optional<double> Share(double part, int whole) {
  return whole > 0 ? std::optional<double>(part / whole) : std::nullopt;
}

std::vector<int> OnsetFrames(const GroupMotion& group) {
  std::vector<int> onsets;
  for (const BodyMotion& person : group.people) {
    HipPath hip;
    for (const Pose& pose : person) hip.push_back(pose.col(kBodyHip));
    onsets.push_back(OnsetFrame(hip));
  }
  return onsets;
}

std::string Cell(const std::optional<double>& value) {
  if (!value) return "none";
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", *value);
  return text;
}

}  // namespace

std::vector<BodyMotion> AtWordRate(const GroupMotion& group) {
  std::vector<BodyMotion> people;
  for (const BodyMotion& person : group.people) {
    people.push_back(Resampled(person, group.dt, 1.0 / kWordRate, WordFrames(group)));
  }
  return people;
}

std::ptrdiff_t FirstStep(const GroupMotion& group) {
  const double frames = std::max(0, group.first_frame - 1) * group.dt * kWordRate;
  return static_cast<std::ptrdiff_t>(std::ceil(frames - kWholeFrame));
}

std::vector<Symbols> StatesOfPeople(const GroupMotion& group, const StateFunction& states) {
  if (group.states.empty()) return states.of(AtWordRate(group), 1.0 / kWordRate);
  std::vector<Symbols> people;
  for (const Symbols& person : group.states) people.push_back(AtWordRate(person, group));
  return people;
}

Symbols Counted(const GroupMotion& group, const Symbols& symbols) {
  const auto size = static_cast<std::ptrdiff_t>(symbols.size());
  Symbols counted(symbols.begin() + std::min(FirstStep(group), size), symbols.end());
  if (counted.size() > 1) counted[0] = counted[1];
  return counted;
}

std::vector<Symbols> CountedStates(const std::vector<GroupMotion>& groups,
                                   const StateFunction& states) {
  std::vector<Symbols> all;
  for (const GroupMotion& group : groups) {
    for (const Symbols& symbols : StatesOfPeople(group, states)) {
      all.push_back(Counted(group, symbols));
    }
  }
  return all;
}

std::vector<BodyMotion> CountedMotions(const std::vector<GroupMotion>& groups) {
  std::vector<BodyMotion> all;
  for (const GroupMotion& group : groups) {
    for (const BodyMotion& person : AtWordRate(group)) {
      const auto size = static_cast<std::ptrdiff_t>(person.size());
      all.emplace_back(person.begin() + std::min(FirstStep(group), size), person.end());
    }
  }
  return all;
}

SocialMetrics CompareStates(const std::vector<GroupMotion>& recorded,
                            const std::vector<GroupMotion>& motions) {
  const StateFunction states = SocialStateFunction();
  const std::vector<Symbols> of_recorded = CountedStates(recorded, states);
  const std::vector<Symbols> of_motions = CountedStates(motions, states);
  const auto distance = [&](Transitions which) {
    return JensenShannon(CountTransitions(of_recorded, states.num_symbols(), which),
                         CountTransitions(of_motions, states.num_symbols(), which));
  };
  return {distance(Transitions::kAll), distance(Transitions::kChanges), std::nullopt};
}

std::optional<double> CompareWords(const std::vector<GroupMotion>& recorded,
                                   const std::vector<GroupMotion>& motions) {
  const MotionWords words(CountedMotions(recorded));
  double sum = 0.0;
  int count = 0;
  if (words.size() == 0) return std::nullopt;
  for (const BodyMotion& person : CountedMotions(motions)) {
    const std::vector<double> scores = words.Scores(person);
    sum += std::accumulate(scores.begin(), scores.end(), 0.0);
    count += static_cast<int>(scores.size());
  }
  return Share(sum, count);
}

void AddOnsets(const GroupMotion& recorded, const GroupMotion& predicted, OnsetMetrics* metrics) {
  const std::vector<int> truth = OnsetFrames(recorded), onsets = OnsetFrames(predicted);
  const auto shown = [&](size_t n) {
    return truth[n] != kNever && truth[n] < predicted.first_frame;
  };
  const int first = FirstOf(truth);
  if (first == kNever || !shown(first)) {
    ++metrics->recordings;
    if (FirstOf(onsets) == recorded.pushed_person) ++metrics->pushed_named;
  }
  for (size_t a = 0; a < truth.size(); ++a) {
    if (shown(a)) continue;
    for (size_t b = 0; b < truth.size(); ++b) {
      if (truth[a] == kNever || truth[b] == kNever || truth[a] >= truth[b]) continue;
      ++metrics->pairs;
      if (Before(onsets[a], onsets[b])) ++metrics->in_order;
    }
    if (truth[a] == kNever && onsets[a] != kNever) ++metrics->false_movers;
    if (truth[a] != kNever && onsets[a] == kNever) ++metrics->missed_movers;
    if (truth[a] == kNever || onsets[a] == kNever) continue;
    ++metrics->movers;
    metrics->error_sum += std::abs(onsets[a] - truth[a]) * recorded.dt;
  }
}

GroupMetrics CompareGroups(const std::vector<GroupMotion>& recorded,
                           const std::vector<GroupMotion>& predicted) {
  GroupMetrics metrics;
  metrics.social = CompareStates(recorded, predicted);
  metrics.social.ndms = CompareWords(recorded, predicted);
  for (size_t i = 0; i < recorded.size(); ++i) {
    AddOnsets(recorded[i], predicted[i], &metrics.onsets);
  }
  return metrics;
}

nlohmann::ordered_json ToJson(const GroupMetrics& metrics) {
  const OnsetMetrics& onsets = metrics.onsets;
  return {{"sscp", NumberOrNull(metrics.social.sscp)},
          {"sscp_changes", NumberOrNull(metrics.social.sscp_changes)},
          {"ndms", NumberOrNull(metrics.social.ndms)},
          {"recordings", onsets.recordings},
          {"pushed_named", onsets.pushed_named},
          {"onset_order", NumberOrNull(Share(onsets.in_order, onsets.pairs))},
          {"onset_error_s", NumberOrNull(Share(onsets.error_sum, onsets.movers))},
          {"false_movers", onsets.false_movers},
          {"missed_movers", onsets.missed_movers}};
}

TextTable GroupMetricsTable(const NamedValues<GroupMetrics>& predictors) {
  const std::vector<std::string> header = {"groups",         "SSCP",         "changes",
                                           "NDMS",           "pushed named", "onset order",
                                           "onset error, s", "false movers", "missed movers"};
  TextTable table = TextTable::OfNumbers(header);
  for (const auto& [predictor, metrics] : predictors) {
    const SocialMetrics& social = metrics->social;
    const OnsetMetrics& onsets = metrics->onsets;
    table.Add({predictor, Cell(social.sscp), Cell(social.sscp_changes), Cell(social.ndms),
               std::to_string(onsets.pushed_named) + " of " + std::to_string(onsets.recordings),
               Cell(Share(onsets.in_order, onsets.pairs)),
               Cell(Share(onsets.error_sum, onsets.movers)), onsets.false_movers,
               onsets.missed_movers});
  }
  return table;
}

std::string GroupMetricsText(const NamedValues<GroupMetrics>& predictors) {
  return GroupMetricsTable(predictors).ToString() +
         "SSCP, changes (0: the same) and NDMS (1: the same) measure how people move and how often "
         "they step, but not whether the right person does so in time; onsets measure only that.\n";
}

}  // namespace pushid
