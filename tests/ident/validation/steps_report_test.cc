// Steps of recordings in words and as JSON, against a case worked by hand.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "ident/prediction/predicted_steps.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

// Three people at 50 frames per second: one steps forward and is cut off in the next step, one
// steps to the left, one stands.
std::vector<PendulumRecording> SteppingRecordings() {
  PendulumRecording row, one;
  row.id = "row";
  one.id = "one";
  row.scene.dt = one.scene.dt = 0.02;
  row.subject_ids = {"anna", "ben"};
  one.subject_ids = {"carl"};
  row.steps.resize(2);
  one.steps.resize(1);
  row.steps[0].steps = {{Foot::kRight, 20, 35, true, {0.5, 0.0}},
                        {Foot::kLeft, 40, 60, false, {0.3, 0.1}}};
  one.steps[0].steps = {{Foot::kLeft, 30, 50, true, {0.0, 0.2}}};
  return {row, one};
}

TEST(StepsReport, InWords) {
  EXPECT_EQ(StepsReport(SteppingRecordings(), false),
            "steps: 2 of 3 people step; medians: first lift-off after 0.5 s, first step 0.35 m\n");
  const std::string all = StepsReport(SteppingRecordings(), true);
  for (const char* part :
       {"row        anna    right 0.4-0.7 s 0.5 m forwards; left from 0.8 s 0.32 m forwards, cut",
        "           ben     none", "one        carl    left 0.6-1 s 0.2 m to the left"}) {
    EXPECT_TRUE(Contains(all, part));
  }
}

TEST(StepsReport, NobodySteps) {
  PendulumRecording still;
  still.steps.resize(1);
  EXPECT_EQ(StepsReport({still}, false), "steps: 0 of 1 person steps\n");
  nlohmann::ordered_json json = {{"recordings", {{{"id", "still"}}}}};
  AddStepsJson({still}, &json);
  EXPECT_EQ(
      json.dump(),
      R"({"recordings":[{"id":"still","steps":[[]]}],"steps":{"people":1,"people_who_step":0,)"
      R"("first_lift_off_median_s":null,"first_length_median_m":null}})");
}

TEST(StepsReport, AsJson) {
  nlohmann::ordered_json json = {{"recordings", {{{"id", "row"}}, {{"id", "one"}}}}};
  AddStepsJson(SteppingRecordings(), &json);
  const auto& row = json["recordings"][0]["steps"];
  ASSERT_EQ(row.size(), 2u);
  ASSERT_EQ(row[0].size(), 2u);
  EXPECT_EQ(row[0][0]["foot"], "right");
  EXPECT_DOUBLE_EQ(row[0][0]["lift_off_s"].get<double>(), 0.4);
  EXPECT_DOUBLE_EQ(row[0][0]["landing_s"].get<double>(), 0.7);
  EXPECT_DOUBLE_EQ(row[0][0]["length_m"].get<double>(), 0.5);
  EXPECT_DOUBLE_EQ(row[0][0]["direction_deg"].get<double>(), 0.0);
  EXPECT_TRUE(row[0][1]["landing_s"].is_null());
  EXPECT_TRUE(row[1].empty());
  EXPECT_DOUBLE_EQ(json["recordings"][1]["steps"][0][0]["direction_deg"].get<double>(), 90.0);
  EXPECT_EQ(json["steps"]["people"], 3);
  EXPECT_EQ(json["steps"]["people_who_step"], 2);
  EXPECT_DOUBLE_EQ(json["steps"]["first_lift_off_median_s"].get<double>(), 0.5);
}

}  // namespace
}  // namespace pushid
