// ident: annotated states, and those found in other motion.
#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "ident/forecasts/social_report.h"
#include "models/restoration/state_classifier.h"

namespace pushid {
namespace {

constexpr int kClassifierFolds = 4;

bool AllBuiltIn(const std::set<std::string>& names) {
  return std::all_of(names.begin(), names.end(), [](const std::string& name) {
    return FromName<SocialState>(name).has_value();
  });
}

int SymbolOf(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

using Samples = std::vector<StateClassifier::Annotated>;

StateClassifier TrainedOn(const Samples& samples, int num_symbols, size_t left_out = SIZE_MAX) {
  std::vector<const StateClassifier::Annotated*> groups;
  for (size_t i = 0; i < samples.size(); ++i) {
    if (i % kClassifierFolds != left_out) groups.push_back(&samples[i]);
  }
  return StateClassifier(groups, num_symbols);
}

double ShareOfMostFrequent(const Samples& samples, int num_symbols) {
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(num_symbols);
  for (const StateClassifier::Annotated& group : samples) {
    for (const Symbols& person : group.states) {
      for (const int symbol : person) counts[symbol] += 1.0;
    }
  }
  return counts.maxCoeff() / counts.sum();
}

// Mean over recordings, each of them left out with its fold.
double ShareFoundLeftOut(const Samples& samples, int num_symbols) {
  double sum = 0.0;
  for (size_t fold = 0; fold < kClassifierFolds; ++fold) {
    if (fold >= samples.size()) continue;
    const StateClassifier classifier = TrainedOn(samples, num_symbols, fold);
    for (size_t i = fold; i < samples.size(); i += kClassifierFolds) {
      sum += ShareFound(classifier.Of(samples[i].features), samples[i].states);
    }
  }
  return sum / static_cast<double>(samples.size());
}

MaybeError FindByClassifier(const StateTable& table, const std::vector<BodyRecording>& recordings,
                            SocialCues* cues) {
  Samples samples;
  for (size_t i = 0; i < recordings.size(); ++i) {
    if (cues->annotated[i].people.empty()) continue;
    const GroupMotion group = RecordedGroup(recordings[i], *cues, i, 1);
    samples.push_back(
        {StateFeaturesOf(AtWordRate(group), 1.0 / kWordRate), StatesOfPeople(group, cues->states)});
  }
  if (samples.size() < 2 || cues->states.names.size() < 2) {
    return Error{
        "the states of people are not the built-in ones, so that a classifier has to find "
        "them in forecasts: it needs two of these recordings with states of their people, "
        "and two different states",
        table.path};
  }
  const int num_symbols = cues->states.num_symbols();
  cues->share_found = ShareFoundLeftOut(samples, num_symbols);
  cues->share_of_most_frequent = ShareOfMostFrequent(samples, num_symbols);
  const auto classifier = std::make_shared<StateClassifier>(TrainedOn(samples, num_symbols));
  cues->states.of = [classifier](const std::vector<BodyMotion>& people, double dt) {
    return classifier->Of(StateFeaturesOf(people, dt));
  };
  return std::nullopt;
}

}  // namespace

Result<SocialCues> SocialCuesOf(const StateTable& table, const std::vector<std::string>& ids,
                                const std::vector<BodyRecording>& recordings) {
  if (MaybeError error = CheckRecordings(table, ids)) return *error;
  SocialCues cues;
  cues.source = table.path;
  std::set<std::string> names;
  for (const BodyRecording& recording : recordings) {
    const PendulumRecording& pendulum = recording.pendulum;
    Result<RecordedStates> states =
        StatesOf(table, pendulum.id, pendulum.subject_ids, recording.num_frames());
    if (!states.ok()) return states.error();
    for (const auto& person : states.value().people) names.insert(person.begin(), person.end());
    cues.annotated.push_back(std::move(states.value()));
  }
  if (AllBuiltIn(names)) return cues;
  cues.states.names.assign(names.begin(), names.end());
  if (MaybeError error = FindByClassifier(table, recordings, &cues)) return *error;
  return cues;
}

GroupMotion RecordedGroup(const BodyRecording& recording, const SocialCues& cues, size_t index,
                          int first_frame, bool annotated) {
  const PendulumRecording& pendulum = recording.pendulum;
  GroupMotion group{recording.bodies, pendulum.scene.dt, pendulum.pushed_person, first_frame};
  if (!annotated || cues.annotated.empty()) return group;
  const RecordedStates& states = cues.annotated[index];
  group.group_states = states.group;
  for (const std::vector<std::string>& person : states.people) {
    group.states.emplace_back();
    for (const std::string& name : person) {
      group.states.back().push_back(SymbolOf(cues.states.names, name));
    }
  }
  return group;
}

std::vector<RecordedStates> StatesInUse(const std::vector<BodyRecording>& recordings,
                                        const SocialCues& cues) {
  std::vector<GroupMotion> groups;
  for (size_t i = 0; i < recordings.size(); ++i) {
    groups.push_back(RecordedGroup(recordings[i], cues, i, 1));
  }
  const GroupVocabulary vocabulary(groups, cues.states);
  std::vector<RecordedStates> all;
  for (size_t i = 0; i < recordings.size(); ++i) {
    const PendulumRecording& pendulum = recordings[i].pendulum;
    RecordedStates states{pendulum.id, pendulum.subject_ids};
    const auto at_frames = [&](const Symbols& symbols, const std::vector<std::string>& names) {
      std::vector<std::string> named;
      for (int t = 0; t < recordings[i].num_frames(); ++t) {
        const auto at = static_cast<size_t>(std::lround(t * pendulum.scene.dt * kWordRate));
        named.push_back(names[symbols[std::min(at, symbols.size() - 1)]]);
      }
      return named;
    };
    for (const Symbols& person : StatesOfPeople(groups[i], cues.states)) {
      states.people.push_back(at_frames(person, cues.states.names));
    }
    states.group = at_frames(vocabulary.Of(groups[i], cues.states), vocabulary.names());
    all.push_back(std::move(states));
  }
  return all;
}

}  // namespace pushid
