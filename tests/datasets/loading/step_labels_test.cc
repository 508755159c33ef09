// Steps found in the real recordings against steps labelled by eye (step_labels.csv).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "datasets/loading/foot_steps.h"
#include "datasets/loading/load_recordings.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr double kLiftOffWithin = 0.1, kLandingWithin = 0.15;  // s

struct Label {
  std::string recording, foot;  // foot: left, right, none
  int person = 0, lift_off = 0;
  int landing = -1;  // -1: cut off by the end
  bool last = false;
};

std::vector<Label> ReadLabels() {
  std::ifstream file(std::string(PUSHID_SOURCE_DIR) + "/tests/datasets/loading/step_labels.csv");
  std::vector<Label> labels;
  std::string line;
  bool head = true;
  while (std::getline(file, line)) {
    if (line[0] == '#') continue;
    if (std::exchange(head, false)) continue;
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    EXPECT_EQ(cells.size(), 6u) << line;
    Label label{cells[0], cells[2], std::stoi(cells[1]), 0, -1, cells[5] == "last"};
    if (!cells[3].empty()) label.lift_off = std::stoi(cells[3]);
    if (!cells[4].empty()) label.landing = std::stoi(cells[4]);
    labels.push_back(label);
  }
  return labels;
}

struct Agreement {
  int labelled = 0, found = 0, matched = 0;
  std::vector<double> lift_off_error, landing_error;  // s, of those matched
  std::vector<std::string> odd;                       // what did not match

  double Precision() const { return static_cast<double>(matched) / found; }
  double Recall() const { return static_cast<double>(matched) / labelled; }
};

double Median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

void Compare(const Recording& recording, int person, const std::vector<Label>& labels, bool toes,
             Agreement* agreement) {
  RecordedPerson seen = recording.people[person];
  if (!toes) seen.left_toe = seen.right_toe = {};
  std::vector<FootStep> found = FindSteps(seen, recording.fps).steps;
  agreement->found += static_cast<int>(found.size());
  const std::string where = recording.id + " person " + std::to_string(person) + " ";
  for (const Label& label : labels) {
    if (label.foot == "none") continue;
    ++agreement->labelled;
    const int landing = label.landing < 0 ? recording.num_frames() : label.landing;
    const auto match = std::find_if(found.begin(), found.end(), [&](const FootStep& step) {
      return NameOf(step.foot) == label.foot &&
             std::abs(step.lift_off - label.lift_off) <= kLiftOffWithin * recording.fps &&
             std::abs(step.landing - landing) <= kLandingWithin * recording.fps &&
             step.lift_off < landing && label.lift_off < step.landing;
    });
    if (match == found.end()) {
      agreement->odd.push_back(where + label.foot + " labelled " + std::to_string(label.lift_off) +
                               " to " + std::to_string(landing));
      continue;
    }
    ++agreement->matched;
    agreement->lift_off_error.push_back((match->lift_off - label.lift_off) / recording.fps);
    if (label.landing >= 0) {
      agreement->landing_error.push_back((match->landing - landing) / recording.fps);
    }
    found.erase(match);
  }
  for (const FootStep& step : found) {
    agreement->odd.push_back(where + NameOf(step.foot) + " found " + std::to_string(step.lift_off) +
                             " to " + std::to_string(step.landing));
  }
}

void Report(const std::string& name, const Agreement& agreement) {
  std::printf(
      "%s: %d labelled, %d found, %d matched: precision %.3f, recall %.3f; median error of "
      "lift-off %+.3f s, of landing %+.3f s\n",
      name.c_str(), agreement.labelled, agreement.found, agreement.matched, agreement.Precision(),
      agreement.Recall(), Median(agreement.lift_off_error), Median(agreement.landing_error));
  for (const std::string& odd : agreement.odd) std::printf("  %s\n", odd.c_str());
}

TEST(StepLabels, FoundAsLabelled) {
  if (RecordingsRoot().empty()) GTEST_SKIP() << kNoRecordings;
  std::map<std::string, std::map<int, std::vector<Label>>> labels;
  for (const Label& label : ReadLabels()) labels[label.recording][label.person].push_back(label);
  LoadOptions options;
  for (const auto& [id, people] : labels) options.ids.push_back(id);
  const auto recordings = Unwrapped(LoadRecordings(RecordingsRoot() + "/manifest.json", options));
  ASSERT_EQ(recordings.size(), 20u);
  Agreement first, last, first_ankles, last_ankles;
  for (const Recording& recording : recordings) {
    const auto& people = labels[recording.id];
    ASSERT_EQ(people.size(), recording.people.size()) << recording.id << ": label everybody";
    for (const auto& [person, steps] : people) {
      Compare(recording, person, steps, true, steps[0].last ? &last : &first);
      Compare(recording, person, steps, false, steps[0].last ? &last_ankles : &first_ankles);
    }
  }
  Report("labelled first", first);
  Report("labelled last", last);
  Report("labelled first, by ankles alone", first_ankles);
  Report("labelled last, by ankles alone", last_ankles);
  for (const Agreement* agreement : {&first, &last}) {
    EXPECT_GE(agreement->Precision(), 0.95);
    EXPECT_GE(agreement->Recall(), 0.95);
    EXPECT_LE(std::abs(Median(agreement->lift_off_error)), 0.034);
    EXPECT_LE(std::abs(Median(agreement->landing_error)), 0.034);
  }
  for (const Agreement* agreement : {&first_ankles, &last_ankles}) {
    EXPECT_GE(agreement->Precision(), 0.8);
    EXPECT_GE(agreement->Recall(), 0.8);
  }
}

// People who step, by steps and by the plain rule that an ankle goes 5 cm from its first place.
TEST(StepLabels, WhoSteps) {
  if (RecordingsRoot().empty()) GTEST_SKIP() << kNoRecordings;
  const auto recordings = Unwrapped(LoadRecordings(RecordingsRoot() + "/manifest.json", {}));
  int people = 0, step = 0, differ = 0;
  for (const Recording& recording : recordings) {
    for (const RecordedPerson& person : recording.people) {
      double farthest = 0.0;
      for (const auto* ankle : {&person.left_ankle, &person.right_ankle}) {
        for (const Eigen::Vector3d& p : *ankle) {
          farthest = std::max(farthest, (p - ankle->front()).head<2>().norm());
        }
      }
      const bool stepped = FindSteps(person, recording.fps).Stepped();
      ++people;
      step += stepped;
      if (stepped != (farthest > 0.05)) {
        ++differ;
        std::printf("  %s %s: %s, an ankle goes %.3f m\n", recording.id.c_str(),
                    person.subject_id.c_str(), stepped ? "steps" : "does not step", farthest);
      }
    }
  }
  std::printf("%d of %d people step; the plain rule differs in %d\n", step, people, differ);
  EXPECT_EQ(people, 255);
  EXPECT_LE(differ, 2);
}

}  // namespace
}  // namespace pushid
