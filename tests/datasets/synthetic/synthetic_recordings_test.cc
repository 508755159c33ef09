// Synthetic recordings: what is written is what was rolled out, noise is what was asked for, and a
// seed means the same bytes.
#include "datasets/synthetic/synthetic_recordings.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "datasets/formats/bvh.h"
#include "datasets/loading/load_recordings.h"
#include "datasets/loading/pendulum_recording.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

namespace fs = std::filesystem;

class SyntheticRecordings : public TempDirTest {
 protected:
  std::vector<SyntheticRecording> Make(const SyntheticOptions& options) {
    return Unwrapped(MakeSyntheticRecordings(options));
  }

  std::vector<Recording> WriteAndLoad(const SyntheticOptions& options,
                                      const std::vector<SyntheticRecording>& made) {
    EXPECT_EQ(ProblemOf(WriteSyntheticRecordings(folder_.string(), options, made)), "no error");
    Warnings warnings;
    std::vector<Recording> loaded = Unwrapped(LoadRecordings(Path("manifest.json"), {}, &warnings));
    for (const Warning& warning : warnings) ADD_FAILURE() << warning.text;
    return loaded;
  }

  // Every file's name and contents.
  static std::string Bytes(const std::string& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file()) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    std::ostringstream bytes;
    for (const fs::path& file : files) {
      bytes << fs::relative(file, folder) << '\n' << std::ifstream(file).rdbuf();
    }
    return bytes.str();
  }
};

void ExpectMotionOf(const SyntheticRecording& made, const Recording& observed, double tolerance) {
  const PendulumRecording pendulum = MakePendulumRecording(observed);
  ASSERT_EQ(pendulum.num_frames(), made.path.num_frames());
  EXPECT_EQ(pendulum.id, made.recording.id);
  EXPECT_EQ(pendulum.subject_ids[0], made.recording.people[0].subject_id);
  EXPECT_EQ(pendulum.labels.magnitude(), made.recording.labels.magnitude());
  const Body& body = pendulum.scene.people[0].body;
  EXPECT_EQ(body.mass, made.scene.people[0].body.mass);
  EXPECT_NEAR(body.cart_height, made.scene.people[0].body.cart_height, tolerance);
  for (int t = 0; t < pendulum.num_frames(); ++t) {
    const PendulumState<double>& truth = made.path.At(t, 0);
    EXPECT_LT((pendulum.states[0][t].q - truth.q).norm(), tolerance) << t;
    EXPECT_LT((pendulum.states[0][t].qd - truth.qd).norm(), 120 * tolerance) << t;
    EXPECT_NEAR(pendulum.rod_length[0][t], made.skeletons[0].rod_length(), tolerance) << t;
  }
  ASSERT_EQ(pendulum.scene.pushes.size(), 1u);
  EXPECT_EQ(pendulum.scene.pushes[0].kind, made.scene.pushes[0].kind);
  EXPECT_EQ(pendulum.scene.pushes[0].start_frame, made.scene.pushes[0].start_frame);
  EXPECT_EQ(pendulum.scene.pushes[0].force, made.scene.pushes[0].force);
}

TEST_F(SyntheticRecordings, WrittenFilesGiveBackTheRollout) {
  for (PushKind kind : {PushKind::kNet, PushKind::kNetWithoutFriction, PushKind::kExternal}) {
    for (PushUse use : {PushUse::kAdded, PushUse::kAsRecorded}) {
      SyntheticOptions options;
      options.push_kind = kind;
      options.model.push = use;
      options.subjects = 2;
      options.recordings_per_subject = 3;
      options.push_start_frame = kind == PushKind::kExternal ? 7 : 0;
      options.fps = kind == PushKind::kExternal ? 100.0 : 60.0;
      const std::vector<SyntheticRecording> made = Make(options);
      const std::vector<Recording> loaded = WriteAndLoad(options, made);
      ASSERT_EQ(made.size(), 6u);
      ASSERT_EQ(loaded.size(), made.size());
      for (size_t i = 0; i < made.size(); ++i) {
        ExpectMotionOf(made[i], made[i].recording, 1e-12);
        // Digits enough for recovering parameters to 1e-6.
        ExpectMotionOf(made[i], loaded[i], 1e-12);
        EXPECT_EQ(loaded[i].labels.setting(), "single");
        EXPECT_EQ(loaded[i].fps, options.fps);
      }
    }
  }
}

// The recorded `net` rows are the whole force, so they move the person as the added push did.
TEST_F(SyntheticRecordings, AsRecordedPushMovesLikeTheAddedOneWhileItLasts) {
  SyntheticOptions options;
  options.parameters[kMu] = 60.0;
  const std::vector<SyntheticRecording> added = Make(options);
  for (PushKind kind : {PushKind::kNet, PushKind::kNetWithoutFriction}) {
    options.model.push = PushUse::kAsRecorded;
    options.push_kind = kind;
    const std::vector<SyntheticRecording> recorded = Make(options);
    for (size_t i = 0; i < added.size(); ++i) {
      const int end = added[i].scene.pushes[0].EndFrame();
      ASSERT_EQ(recorded[i].scene.pushes[0].EndFrame(), end);
      EXPECT_LT((recorded[i].path.At(end, 0).q - added[i].path.At(end, 0).q).norm(), 1e-12);
      EXPECT_GT((recorded[i].scene.pushes[0].mean - added[i].scene.pushes[0].mean).norm(), 1.0);
    }
  }
}

TEST_F(SyntheticRecordings, NoiseReachesHipAndAnklesAsAsked) {
  SyntheticOptions options;
  options.joint_noise_m = 0.002;
  options.subjects = 5;
  const std::vector<SyntheticRecording> made = Make(options);
  const std::vector<Recording> loaded = WriteAndLoad(options, made);
  options.joint_noise_m = 0.0;
  const std::vector<SyntheticRecording> clean = Make(options);
  ASSERT_EQ(loaded.size(), clean.size());

  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
  int count = 0;
  for (size_t i = 0; i < clean.size(); ++i) {
    EXPECT_EQ(clean[i].scene.pushes[0].force, made[i].scene.pushes[0].force);
    const RecordedPerson& noisy = loaded[i].people[0];
    const RecordedPerson& truth = clean[i].recording.people[0];
    for (int t = 0; t < options.frames; ++t, ++count) {
      Eigen::Matrix<double, 9, 1> error;
      error << noisy.hip[t] - truth.hip[t], noisy.left_ankle[t] - truth.left_ankle[t],
          noisy.right_ankle[t] - truth.right_ankle[t];
      covariance += error * error.transpose();
    }
  }
  covariance /= count;
  // 2700 frames: a standard deviation is known to 1.4 %, a correlation to 2 %.
  for (int a = 0; a < 9; ++a) {
    EXPECT_NEAR(std::sqrt(covariance(a, a)), 0.002, 0.002 * 0.06);
    for (int b = 0; b < a; ++b) EXPECT_NEAR(covariance(a, b), 0.0, 0.002 * 0.002 * 0.09);
  }
}

TEST_F(SyntheticRecordings, FirstFrameCanBeKeptExact) {
  SyntheticOptions options;
  options.joint_noise_m = 0.002;
  options.noise_at_first_frame = false;
  for (const SyntheticRecording& made : Make(options)) {
    const Body& body = made.scene.people[0].body;
    EXPECT_EQ(made.recording.people[0].hip[0], HipPosition(body, made.path.At(0, 0).q));
    EXPECT_NE(made.recording.people[0].hip[1], HipPosition(body, made.path.At(1, 0).q));
  }
}

TEST_F(SyntheticRecordings, SameSeedSameBytesOtherSeedOthers) {
  SyntheticOptions options;
  options.joint_noise_m = 0.002;
  options.recording_spread = 0.1;
  const auto bytes = [&](const std::string& name, const SyntheticOptions& o) {
    const std::string folder = Path(name);
    EXPECT_FALSE(WriteSyntheticRecordings(folder, o, Make(o)));
    return Bytes(folder);
  };
  const std::string first = bytes("a", options);
  EXPECT_GT(first.size(), 100000u);
  EXPECT_TRUE(first == bytes("b", options));
  options.noise_seed = 5;
  const std::string other_noise = bytes("c", options);
  EXPECT_FALSE(first == other_noise);
  options.noise_seed = 0;
  options.seed = 2;
  EXPECT_FALSE(first == bytes("d", options));
}

TEST_F(SyntheticRecordings, SpreadMultipliesTheTruth) {
  SyntheticOptions options;
  options.recording_spread = 0.2;
  options.subjects = 20;
  options.recordings_per_subject = 10;
  options.strengths = {{"weak", 1.0}};
  double sum = 0.0, squares = 0.0;
  const std::vector<SyntheticRecording> many = Make(options);
  for (const SyntheticRecording& made : many) {
    const double factor = std::log(made.parameters[0][kMu] / options.parameters[kMu]);
    sum += factor;
    squares += factor * factor;
    EXPECT_EQ(made.parameters[0][kAy], 0.0);  // absent terms stay absent
  }
  EXPECT_NEAR(sum / many.size(), 0.0, 0.05);
  EXPECT_NEAR(std::sqrt(squares / many.size()), 0.2, 0.03);

  options.recording_spread = 0.0;
  options.subject_spread = 0.2;
  const std::vector<SyntheticRecording> by_subject = Make(options);
  EXPECT_EQ(by_subject[0].parameters, by_subject[9].parameters);
  EXPECT_NE(by_subject[0].parameters, by_subject[10].parameters);
}

TEST_F(SyntheticRecordings, PushesExciteBothAxes) {
  for (const SyntheticRecording& made : Make({})) {
    double forward = 0.0, sideways = 0.0;
    for (int t = 0; t < made.path.num_frames(); ++t) {
      forward = std::max(forward, std::abs(made.path.At(t, 0).qd[0]));
      sideways = std::max(sideways, std::abs(made.path.At(t, 0).qd[1]));
    }
    EXPECT_GT(forward, 0.1) << made.recording.id;
    EXPECT_GT(sideways, 1e-3) << made.recording.id;
  }
}

// Posed from the truth with noise-free hip and ankles, all 22 bones keep their lengths and the feet
// stay level.
TEST_F(SyntheticRecordings, SkeletonIsRigid) {
  const std::vector<SyntheticRecording> made = Make({});
  const SyntheticSkeleton& skeleton = made[0].skeletons[0];
  const BvhSkeleton bvh = skeleton.Bvh(LengthUnit::kMetre);
  ASSERT_EQ(bvh.joints.size(), static_cast<size_t>(kSkeletonJoints));
  EXPECT_EQ(bvh.Find("LeftAnkle"), kLeftAnkleJoint);
  EXPECT_EQ(bvh.Find("RightAnkle"), kRightAnkleJoint);
  std::vector<int> all(kSkeletonJoints);
  for (int j = 0; j < kSkeletonJoints; ++j) all[j] = j;
  BvhKinematics kinematics(bvh, 1.0, all);
  for (int t : {0, 20, 60}) {
    const Vector4<double>& q = made[0].path.At(t, 0).q;
    const RecordedPerson& person = made[0].recording.people[0];
    std::vector<double> row;
    skeleton.AppendFrame({q[2], q[3], person.hip[t], person.left_ankle[t], person.right_ankle[t]},
                         LengthUnit::kMetre, &row);
    ASSERT_EQ(row.size(), static_cast<size_t>(bvh.num_channels()));
    std::vector<Eigen::Vector3d> p(kSkeletonJoints);
    kinematics.Positions(row.data(), p.data());
    for (int j = 1; j < kSkeletonJoints; ++j) {
      const BvhJoint& joint = bvh.joints[j];
      EXPECT_NEAR((p[j] - p[joint.parent]).norm(), joint.offset.norm(), 1e-13) << joint.name;
    }
    EXPECT_LT((p[kLeftAnkleJoint] - person.left_ankle[t]).norm(), 1e-14);
    EXPECT_LT((p[kRightAnkleJoint] - person.right_ankle[t]).norm(), 1e-14);
    for (int toe : {17, 21}) {
      EXPECT_LT((p[toe] - p[toe - 1] - bvh.joints[toe].offset).norm(), 1e-13);
      EXPECT_GT(p[toe].z(), 0.0);
    }
  }
}

TEST_F(SyntheticRecordings, FallsAreErrors) {
  SyntheticOptions options;
  options.push_kind = PushKind::kExternal;
  options.min_push_s = options.max_push_s = 0.8;
  options.strengths = {{"hurricane", 90.0}};
  const std::string fall = ProblemOf(MakeSyntheticRecordings(options));
  EXPECT_TRUE(Contains(fall, "S01_00_hurricane"));
  EXPECT_TRUE(Contains(fall, "theta"));
}

TEST_F(SyntheticRecordings, UnwritableFolderIsAnError) {
  WriteText("file", "x");
  EXPECT_TRUE(
      Contains(ProblemOf(WriteSyntheticRecordings(Path("file"), {}, Make({}))), folder_.string()));
}

}  // namespace
}  // namespace pushid
