// ident: states of groups.
#include <algorithm>
#include <cmath>
#include <set>

#include "ident/validation/group_metrics.h"
#include "models/restoration/cvae_features.h"

namespace pushid {
namespace {

constexpr double kWholeFrame = 0.1;  // frames; rates are rounded

int WordFrames(const GroupMotion& group) {
  const double seconds = (static_cast<double>(group.people.front().size()) - 1.0) * group.dt;
  return 1 + static_cast<int>(seconds * kWordRate + kWholeFrame);
}

// Of the nearest frames.
template <typename Value>
std::vector<Value> AtWordRate(const std::vector<Value>& values, const GroupMotion& group) {
  std::vector<Value> resampled;
  for (int k = 0; k < WordFrames(group); ++k) {
    const auto at = static_cast<size_t>(std::lround(k / (kWordRate * group.dt)));
    resampled.push_back(values[std::min(at, values.size() - 1)]);
  }
  return resampled;
}

// Everybody's symbol at a frame.
std::vector<int> At(const std::vector<Symbols>& people, size_t t) {
  std::vector<int> symbols;
  for (const Symbols& person : people) symbols.push_back(person[t]);
  return symbols;
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

std::string GroupVocabulary::NameOf(std::vector<int> people, const StateFunction& states) {
  std::sort(people.begin(), people.end());
  std::string name;
  for (size_t i = 0; i < people.size();) {
    const size_t end = std::upper_bound(people.begin(), people.end(), people[i]) - people.begin();
    name += (i == 0 ? "" : " + ") + std::to_string(end - i) + " " + states.names[people[i]];
    i = end;
  }
  return name;
}

GroupVocabulary::GroupVocabulary(const std::vector<GroupMotion>& recorded,
                                 const StateFunction& states) {
  std::map<std::string, std::map<std::string, int>> votes;
  std::set<std::string> all;
  for (const GroupMotion& group : recorded) {
    const std::vector<Symbols> people = StatesOfPeople(group, states);
    const auto annotated =
        group.group_states.empty() ? group.group_states : AtWordRate(group.group_states, group);
    for (size_t t = 0; t < people.front().size(); ++t) {
      const std::string together = NameOf(At(people, t), states);
      const std::string& name = annotated.empty() ? together : annotated[t];
      ++votes[together][name];
      if (name != kOther) all.insert(name);
    }
  }
  names_.assign(all.begin(), all.end());
  names_.push_back(kOther);
  for (size_t i = 0; i < names_.size(); ++i) symbols_[names_[i]] = static_cast<int>(i);
  for (const auto& [together, names] : votes) {
    const auto most =
        std::max_element(names.begin(), names.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    of_[together] = symbols_.at(most->first);
  }
}

Symbols GroupVocabulary::Of(const GroupMotion& group, const StateFunction& states) const {
  Symbols symbols;
  const auto look = [&symbols](const std::map<std::string, int>& in, const std::string& name,
                               int otherwise) {
    const auto found = in.find(name);
    symbols.push_back(found == in.end() ? otherwise : found->second);
  };
  const int other = static_cast<int>(names_.size()) - 1;
  if (!group.group_states.empty()) {
    for (const std::string& name : AtWordRate(group.group_states, group)) {
      look(symbols_, name, other);
    }
    return symbols;
  }
  const std::vector<Symbols> people = StatesOfPeople(group, states);
  for (size_t t = 0; t < people.front().size(); ++t) {
    look(of_, NameOf(At(people, t), states), other);
  }
  return symbols;
}

}  // namespace pushid
