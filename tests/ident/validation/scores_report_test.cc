// Scores as JSON, and their means read back; what is damaged is refused with the key's name.
#include "ident/validation/scores_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

// Two scored recordings, one of two people, and a failure.
ScoreSummary SampleScores() {
  ScoreSummary s;
  s.recordings.resize(3);
  const char* ids[] = {"a", "b", "c"};
  for (int i = 0; i < 3; ++i) {
    s.recordings[i].id = ids[i];
    s.recordings[i].frames = 90 + i;
  }
  s.recordings[0].value[kHipAde] = 0.1;
  s.recordings[0].value[kHipFde] = 1.0 / 3.0;
  s.recordings[1].value[kHipAde] = 0.3;
  s.recordings[1].fell = true;
  s.recordings[2].failure = "theta of person 0 leaves the model's domain at frame 7";
  s.mean.value[kHipAde] = 0.2;
  s.mean.value[kHipFde] = 1.0 / 7.0;
  s.mean.error[kHipAde] = 0.1;
  s.mean.error[kHipFde] = 1.0 / 9.0;
  s.mean.recordings = 2;
  s.by["magnitude"]["weak"] = s.mean;
  s.by["subject"]["Sa"].value[kHipFde] = 0.5;
  s.by["setting"]["row_1"].recordings = 1;
  s.propagation.recordings = 1;
  s.propagation.movers = 2.5;
  s.propagation.figures[kOnsetError] = {3.0, 0.5, 4.0};
  s.without_label["setting"] = 1;
  return s;
}

TEST(ScoresJsonTest, EntriesAndMeansReadBack) {
  const nlohmann::ordered_json json = ToJson(SampleScores(), true);
  const Metrics means = Unwrapped(MeanMetrics(json, TableMetrics(0), "scores.json"));
  EXPECT_EQ(means[kHipFde], 1.0 / 7.0);
  EXPECT_EQ(json["mean"]["hipADE_standard_error_m"], 0.1);
  EXPECT_EQ(json["mean"]["clustered_by"], "recording");
  EXPECT_EQ(json["by_setting"]["row_1"]["recordings"], 1);
  EXPECT_EQ(json["recordings"][1]["fell"], true);
  EXPECT_EQ(json["recordings"][2]["failure"], SampleScores().recordings[2].failure);
  EXPECT_FALSE(json["recordings"][2].contains("hipADE_m"));
  const auto& propagation = json["propagation"];
  EXPECT_EQ(propagation["onset_error_frames"]["standard_error"], 0.5);
  EXPECT_TRUE(propagation["onset_bias_frames"].is_null());
  EXPECT_EQ(json["without_label"]["setting"], 1);
}

TEST(ScoresJsonTest, WhenPeopleStep) {
  ScoreSummary scores = SampleScores();
  StepTiming timing;
  timing.lift_off = 0.5;
  timing.travel = {0.25, 0.0};
  timing.recorded_lift_off = 0.25;
  scores.recordings[0].steps = {{0.1, 0.75, true, "a", timing},
                                {-0.1, 0.25, false, "b", StepTiming()},
                                {-0.1, 0.25, false, "c"}};
  scores.steps = ScoreSteps(scores.recordings[0].steps);
  const nlohmann::ordered_json json = ToJson(scores, true);
  const auto& people = json["recordings"][0]["predicted_steps"];
  EXPECT_EQ(people[0]["lift_off_s"], 0.5);
  EXPECT_TRUE(people[0]["landing_s"].is_null());  // still stepping at the end
  EXPECT_EQ(people[0]["travel_m"], nlohmann::ordered_json({0.25, 0.0}));
  EXPECT_TRUE(people[1]["lift_off_s"].is_null());
  EXPECT_FALSE(people[2].contains("lift_off_s"));  // a model without step states
  EXPECT_EQ(json["who_steps"]["lift_off"]["median_error_s"], 0.25);
}

// A row in the table of metrics is all that files need.
TEST(ScoresJsonTest, EveryMetricIsWritten) {
  const nlohmann::ordered_json json = ToJson(SampleScores(), true);
  for (MetricId m : TableMetrics(0)) {
    const Metric& metric = kMetrics[m];
    EXPECT_TRUE(json["recordings"][0].contains(metric.Key())) << metric.name;
    EXPECT_TRUE(json["mean"].contains(metric.ErrorKey())) << metric.name;
  }
  EXPECT_EQ(kMetrics[kHipAde].Key(), "hipADE_m");
  EXPECT_EQ(kMetrics[kHipFde].ErrorKey(), "hipFDE_standard_error_m");
  EXPECT_EQ(MetricsText(TableMetrics(0), SampleScores().recordings[0].value, 2),
            "hipADE 0.1 m, hipFDE 0.33 m");
}

// What first frames bring stands in files where they were asked for, and nowhere else.
TEST(ScoresJsonTest, FirstFramesComeBack) {
  EXPECT_FALSE(ToJson(SampleScores(), true)["mean"].contains("after_hipADE_m"));
  ScoreSummary scores = SampleScores();
  scores.observed = 12;
  scores.bands = true;
  scores.recordings[0].value[kAfterHipAde] = 0.12;
  scores.mean.value[kAfterHipAde] = 0.12;
  scores.mean.error[kInside90] = 0.04;
  const nlohmann::ordered_json json = ToJson(scores, true);
  EXPECT_EQ(json["observed"], 12);
  EXPECT_EQ(json["mean"]["after_hipADE_m"], 0.12);
  EXPECT_EQ(json["mean"]["inside90_x_standard_error_share"], 0.04);
  EXPECT_EQ(json["recordings"][0]["after_hipADE_m"], 0.12);
  EXPECT_EQ(MetricsText(TableMetrics(12), scores.recordings[0].value, 2),
            "hipADE 0.1 m, hipFDE 0.33 m, after hipADE 0.12 m");
}

TEST(ScoresJsonTest, DamageIsNamed) {
  const auto message = [](const char* key, const nlohmann::ordered_json& value) {
    nlohmann::ordered_json json = ToJson(SampleScores(), true);
    json["mean"][key] = value;
    if (value.is_null()) json["mean"].erase(key);
    return ProblemOf(MeanMetrics(json, TableMetrics(0), "scores.json"));
  };
  EXPECT_TRUE(Contains(message("hipADE_m", nullptr), "scores.json: "));
  EXPECT_TRUE(Contains(message("hipADE_m", nullptr), "hipADE_m"));
  EXPECT_TRUE(Contains(message("hipADE_m", "0.1"), "'0.1' is not a number"));
  EXPECT_TRUE(Contains(message("hipFDE_m", nullptr), "evaluate again"));
  EXPECT_FALSE(MeanMetrics(nlohmann::ordered_json::array(), kBodyMetrics, "x").ok());
}

// Two samples, one 0.1 m to the left and one 0.3 m to the right of what was recorded: each errs by
// itself, 0.2 m in the mean, where their mean motion errs by 0.1 m.
TEST(ScoresJsonTest, EachSampleCountsAndTheMeanIsTaken) {
  const auto sample = [](double error, nlohmann::ordered_json sscp) {
    return nlohmann::ordered_json{{"id", "a"},
                                  {"frames", 90},
                                  {"mean", {{"MPJPE_m", error}}},
                                  {"by_frame", {0.5, std::move(sscp)}}};
  };
  const auto mean = MeanOfSamples({sample(0.1, 0.2), sample(0.3, 0.4)});
  EXPECT_NEAR(mean["mean"]["MPJPE_m"].get<double>(), 0.2, 1e-12);
  EXPECT_NEAR(mean["by_frame"][1].get<double>(), 0.3, 1e-12);
  EXPECT_EQ(mean["by_frame"][0], 0.5);
  EXPECT_TRUE(mean["frames"].is_number_integer());
  EXPECT_EQ(mean["id"], "a");
  EXPECT_TRUE(MeanOfSamples({sample(0.1, nullptr), sample(0.3, 0.4)})["by_frame"][1].is_null());
  EXPECT_TRUE(MeanOfSamples({sample(0.1, 0.4), sample(0.3, nullptr)})["by_frame"][1].is_null());
}

}  // namespace
}  // namespace pushid
