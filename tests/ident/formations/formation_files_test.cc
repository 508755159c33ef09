// Files of a formation read back: BVH to the pendulum, forces to their sum.
#include "ident/formations/formation_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "datasets/loading/load_recordings.h"
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
  const MaybeError failed = WriteFormationRecording(Path("out"), run_);
  ASSERT_FALSE(failed) << failed->ToString();
  EXPECT_EQ(CountFiles(), 13 + 6 + 1);
  const auto loaded = LoadRecordings(Path("out/manifest.json"));
  ASSERT_TRUE(loaded.ok()) << loaded.error().ToString();
  const PendulumRecording read =
      MakePendulumRecording(loaded.value().front(), SkeletonMapping::kExact);
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

TEST_F(FormationFilesTest, PartsAddUpToTheNetForce) {
  const MaybeError failed = WriteForcesCsv(Path("forces.csv"), run_);
  ASSERT_FALSE(failed) << failed->ToString();
  std::istringstream lines(ReadText(Path("forces.csv")));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "frame,time_s,person,part,fx_N,fy_N,ftheta_Nm,fphi_Nm");
  Vector4<double> sum = Vector4<double>::Zero();
  int nets = 0;
  while (std::getline(lines, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    double frame, time, person;
    std::string part;
    Vector4<double> force;
    ASSERT_TRUE(words >> frame >> time >> person >> part >> force[0] >> force[1] >> force[2] >>
                force[3])
        << line;
    if (part != "net") {
      sum += force;
      continue;
    }
    EXPECT_LT((sum - force).norm(), 1e-5) << line;
    sum.setZero();
    ++nets;
  }
  EXPECT_EQ(nets, 13 * 150);
}

TEST_F(FormationFilesTest, AFolderThatCannotBeMadeIsAnError) {
  const std::string file = WriteText("file", "");
  EXPECT_TRUE(WriteFormationRecording(file, run_).has_value());
  EXPECT_TRUE(WriteForcesCsv(Path("none/forces.csv"), run_).has_value());
  EXPECT_EQ(CountFiles(), 1);
}

}  // namespace
}  // namespace pushid
