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

TEST_F(FormationFilesTest, AFolderThatCannotBeMadeIsAnError) {
  const std::string file = WriteText("file", "");
  EXPECT_TRUE(WriteFormationRecording(file, run_).has_value());
  EXPECT_EQ(CountFiles(), 1);
}

}  // namespace
}  // namespace pushid
