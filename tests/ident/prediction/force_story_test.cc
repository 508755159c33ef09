// What happens to a bystander, in words.
#include <gtest/gtest.h>

#include <algorithm>

#include "ident/formations/formation_run.h"
#include "ident/prediction/propagation.h"
#include "tests/ident/formation_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

Scene LineOf(int people, double impulse) {
  return SampleFormation(FormationShape::kLine, people, {0}, {{impulse, 0.5, 0.2}});
}

bool Has(const ForceStory& story, Cause cause) {
  return std::any_of(story.moments.begin(), story.moments.end(),
                     [cause](const StoryMoment& moment) { return moment.cause == cause; });
}

// First still, then pushed by the one behind, then held up by the one in front.
TEST(ForceStoryTest, OfTheOneInTheMiddle) {
  const FormationRun run = RunFormation(ContactModel(), LineOf(3, 120.0), 200);
  ASSERT_TRUE(run.prediction.status.ok);
  const ForceStory story = StoryOf(run.recording, run.prediction, 1);
  ASSERT_GE(story.moments.size(), 3u);
  EXPECT_EQ(story.moments[0].cause, Cause::kNothing);
  EXPECT_EQ(story.moments[0].text, "still");
  EXPECT_GE(story.moments[0].to, 30) << "before the push";
  const StoryMoment& second = story.moments[1];
  EXPECT_EQ(second.cause, Cause::kFromBehind);
  EXPECT_TRUE(Contains(second.text, "pushed from behind by p00, up to "));
  EXPECT_GT(second.impulse, 0.0);
  // Whole, without gaps, as the forces say.
  EXPECT_EQ(story.moments.back().to, 200);
  for (size_t i = 1; i < story.moments.size(); ++i) {
    EXPECT_EQ(story.moments[i].from, story.moments[i - 1].to);
    EXPECT_NE(story.moments[i].cause, story.moments[i - 1].cause);
    EXPECT_GE((story.moments[i].to - story.moments[i].from) / 60.0, 0.1 - 1e-9);
  }
  double impulse = 0.0;  // N s, by the ones behind
  for (int t = second.from; t < second.to; ++t) {
    impulse += run.recording.scene.dt * run.Force(1, t)[ForcePart::kInteraction][0];
  }
  EXPECT_NEAR(second.impulse, impulse, 1e-9);
  const std::string text = StoryText(run.recording, story);
  EXPECT_EQ(text.find("p01: 0 s still; "), 0u) << text;
}

TEST(ForceStoryTest, AShortPushIsTold) {
  Scene scene = SampleFormation(FormationShape::kLine, 1, {0}, {{60.0, 0.5, 0.06}});
  const FormationRun run = RunFormation(ContactModel(), scene, 120);
  const ForceStory story = StoryOf(run.recording, run.prediction, 0);
  EXPECT_TRUE(Has(story, Cause::kPush));
  EXPECT_EQ(story.moments.back().to, 120);
}

TEST(ForceStoryTest, ThePushedAndTheRichest) {
  const FormationRun run = RunFormation(ContactModel(), LineOf(3, 120.0), 200);
  const ForceStory pushed = StoryOf(run.recording, run.prediction, 0);
  EXPECT_TRUE(Has(pushed, Cause::kPush));
  EXPECT_FALSE(Has(pushed, Cause::kFromBehind)) << "nobody stands there";
  const ForceStory richest = RichestStory(run.recording, run.prediction);
  EXPECT_EQ(richest.person, 1) << "the last has nobody in front";
  const FormationRun alone = RunFormation(ContactModel(), LineOf(1, 120.0), 60);
  EXPECT_EQ(RichestStory(alone.recording, alone.prediction).person, -1);
  EXPECT_EQ(StoryText(alone.recording, {}), "");
}

}  // namespace
}  // namespace pushid
