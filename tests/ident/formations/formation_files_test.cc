// Files of a formation read back: BVH to the pendulum, forces to their sum.
#include "ident/formations/formation_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "datasets/files/number_text.h"
#include "datasets/loading/load_recordings.h"
#include "ident/prediction/predicted_steps.h"
#include "tests/ident/formation_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

class FormationFilesTest : public TempDirTest {
 protected:
  void SetUp() override {
    TempDirTest::SetUp();
    const Scene scene = SampleFormation(FormationShape::kDiamond, 13, {0, 1, 3},
                                        {{80.0, 0.0, 0.2}, {60.0, 0.5, 0.2}});
    run_ = RunFormation(ContactModel(), scene, 150);
    ASSERT_TRUE(run_.prediction.status.ok);
  }

  FormationRun run_;
};

TEST_F(FormationFilesTest, TheManifestsPendulumsAreThoseRolledOut) {
  ASSERT_EQ(ProblemOf(WriteFormationRecording(Path("out"), run_)), "no error");
  EXPECT_EQ(CountFiles(), 13 + 6 + 1);
  const auto loaded = Unwrapped(LoadRecordings(Path("out/manifest.json")));
  const PendulumRecording read = MakePendulumRecording(loaded.front());
  ASSERT_EQ(read.num_people(), 13);
  ASSERT_EQ(read.num_frames(), 150);
  EXPECT_EQ(read.scene.pushes.size(), 6u);
  EXPECT_EQ(read.subject_ids, run_.recording.subject_ids);
  for (int n = 0; n < 13; ++n) {
    for (int t = 0; t < 150; ++t) {
      ASSERT_LT((read.hip[n][t] - run_.prediction.hip[n][t]).norm(), 1e-12) << n << ", " << t;
      ASSERT_LT((read.states[n][t].q - run_.prediction.path.At(t, n).q).norm(), 1e-12);
    }
  }
}

// One person who steps, pushed to the left: a map in true proportions with the landings' times, and
// the numbers behind it. A model whose feet slide has none.
TEST_F(FormationFilesTest, FeetFromAbove) {
  EXPECT_FALSE(FeetFigure(run_));
  EXPECT_TRUE(FeetSvg(run_).empty());
  IdentifiedModel model = ContactModel();
  model.options.stance = Stance::kSteps;
  model.parameters = PublishedStanceParameters();
  const FormationRun run =
      RunFormation(model, SampleFormation(FormationShape::kLine, 1, {0}, {{70.0, 0.0, 0.7}}), 240);
  ASSERT_TRUE(run.prediction.status.ok);
  const std::vector<FootStep> steps = PredictedSteps(run.prediction.path, 0);
  ASSERT_FALSE(steps.empty());
  const std::optional<Figure> figure = FeetFigure(run);
  ASSERT_TRUE(figure);
  const Chart& chart = figure->panels.front();
  ASSERT_EQ(chart.labels.size(), steps.size());
  EXPECT_EQ(chart.labels[0].text, Rounded(run.Seconds(steps[0].landing), 3) + " s");
  const double wide = *chart.x_to - *chart.x_from, high = *chart.y_to - *chart.y_from;
  Chart twice = chart;  // as wide, and twice as much to be seen upwards
  twice.y_to = *chart.y_from + 2.0 * high;
  const double metre = (HeightOf(twice, 1000) - HeightOf(chart, 1000)) / high;
  EXPECT_NEAR(metre * wide, 1000 - 44 - 12, 1e-6) << "across, less the margins";
  EXPECT_TRUE(Contains(FeetSvg(run).front(), chart.labels[0].text));
  const auto rows = FeetNumbers(run).rows();
  EXPECT_EQ(rows.size(), 1 + 2 + steps.size() + 240) << "two feet at the start, and the paths";
  EXPECT_EQ(rows[1][1], "predicted");
}

TEST_F(FormationFilesTest, AFolderThatCannotBeMadeIsAnError) {
  const std::string file = WriteText("file", "");
  EXPECT_TRUE(WriteFormationRecording(file, run_).has_value());
  EXPECT_EQ(CountFiles(), 1);
}

}  // namespace
}  // namespace pushid
