// What a model says of pushes of all sizes, durations and directions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ident/prediction/prediction.h"
#include "models/self_terms.h"
#include "tests/ident/formation_samples.h"

namespace pushid {
namespace {

// Feet that slide alike in all directions, with less support behind than elsewhere.
IdentifiedModel SlidingModel() {
  IdentifiedModel model = ContactModel();
  model.options.interaction = {};
  for (const SidewaysParameter& alike : kSidewaysParameters) {
    model.parameters[alike.sideways] = model.parameters[alike.forward];
  }
  model.parameters[kSupportFront] = model.parameters[kSupportSide] = 0.1;
  model.parameters[kSupportBack] = 0.05;
  StepProbability probability;
  probability.coefficients = {1.0, 30.0};
  model.step_probability = probability;
  return model;
}

TEST(PushResponse, HarderPushesSendFartherAndMakeMorePeopleStep) {
  const PushResponse response = ComputePushResponse(SlidingModel());
  const size_t impulses = response.impulse_per_mass.size();
  ASSERT_EQ(response.step_by_duration.size(), impulses);
  ASSERT_EQ(response.step_by_direction.size(), impulses);
  ASSERT_EQ(response.end_by_direction.size(), impulses);
  for (size_t i = 1; i < impulses; ++i) {
    SCOPED_TRACE(response.impulse_per_mass[i]);
    for (size_t j = 0; j < response.duration_s.size(); ++j) {
      EXPECT_GT(response.step_by_duration[i][j], response.step_by_duration[i - 1][j]);
    }
    for (size_t j = 0; j < response.direction_deg.size(); ++j) {
      EXPECT_GT(response.step_by_direction[i][j], response.step_by_direction[i - 1][j]);
      EXPECT_GT(response.end_by_direction[i][j], response.end_by_direction[i - 1][j]);
    }
  }
}

TEST(PushResponse, DirectionsDifferWhereTheSupportDoes) {
  const PushResponse response = ComputePushResponse(SlidingModel());
  ASSERT_EQ(response.direction_deg, std::vector<double>({0.0, 45.0, 90.0, 135.0, 180.0}));
  const size_t at = 5;
  const std::vector<double>& end = response.end_by_direction[at];
  const std::vector<double>& steps = response.step_by_direction[at];
  EXPECT_GT(end[0], 0.05);
  for (double way : end) EXPECT_NEAR(way, end[0], 0.02 * end[0]);
  // The same margin in front and at the side; 0.7 s forwards is in both maps.
  EXPECT_NEAR(steps[2], steps[0], 0.01);
  EXPECT_GT(steps[4], steps[0] + 0.01);
  EXPECT_EQ(response.duration_s[4], 0.7);
  EXPECT_EQ(response.step_by_duration[at][4], steps[0]);
}

// A model that is the same in all directions knows none but that of the feet, which stand side by
// side: forwards is as backwards, and who is pushed to the side has the wider support.
TEST(PushResponse, AlikeInAllDirectionsButForTheFeet) {
  SyntheticOptions study;
  study.model.stance = Stance::kSteps;
  study.parameters = PublishedStanceParameters();
  IdentifiedModel model = SlidingModel();
  model.options = study.model;
  model.options.directions = Directions::kIsotropic;
  model.parameters = study.parameters;
  const PushResponse response = ComputePushResponse(model);
  double widest = 0.0;
  for (const std::vector<double>& steps : response.step_by_direction) {
    EXPECT_NEAR(steps[4], steps[0], 1e-6);
    EXPECT_NEAR(steps[3], steps[1], 1e-6);
    EXPECT_LE(steps[1], steps[0]);
    EXPECT_LE(steps[2], steps[1]);
    widest = std::max(widest, steps[0] - steps[2]);
  }
  EXPECT_GT(widest, 0.3);
  EXPECT_GT(response.step_by_direction.back()[0], response.step_by_direction[0][0] + 0.1);
}

TEST(PushResponse, WhoFallsEndsNowhere) {
  IdentifiedModel falling = SlidingModel();
  falling.parameters[kKpTheta] = falling.parameters[kKpPhi] = 0.0;
  falling.parameters[kAx] = falling.parameters[kAy] = 0.0;
  const PushResponse response = ComputePushResponse(falling);
  EXPECT_EQ(response.step_by_direction.back()[0], 1.0);
  EXPECT_TRUE(std::isnan(response.end_by_direction.back()[0]));
}

}  // namespace
}  // namespace pushid
