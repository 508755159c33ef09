// Restorations and bodies as files: round trips, and errors that say what is wrong.
#include "ident/bodies/restoration_files.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "ident/bodies/body_recording.h"
#include "models/restoration/body.h"
#include "tests/datasets/raw_bvh.h"
#include "tests/models/body_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

class RestorationFilesTest : public TempDirTest {
 protected:
  std::string WriteWindow() {
    TensorFolder content;
    content.kind = "window";
    const WindowWeights weights = RandomWindow();
    AddTensors("", weights, &content.tensors);
    EXPECT_EQ(ProblemOf(WriteTensorFolder(kRestorationFolder, Path("r"), content)), "no error");
    return Path("r");
  }
  std::string ErrorOf(const std::string& folder) { return ProblemOf(LoadRestoration(folder)); }
  void Replace(const std::string& from, const std::string& to) {
    std::string text = ReadText(Path("r/restoration.json"));
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    WriteText("r/restoration.json", text);
  }
};

TEST_F(RestorationFilesTest, AWindowComesBackToTheLastBit) {
  const RestorationInput person = MovingPerson(StandingPose(), 80, 30);
  const BodyMotion before = WindowRestoration(RandomWindow()).Restore({person})[0];
  const auto loaded = Unwrapped(LoadRestoration(WriteWindow()));
  const BodyMotion after = loaded->Restore({person})[0];
  for (int t = 0; t < 30; ++t) EXPECT_EQ(before[t], after[t]);
}

TEST_F(RestorationFilesTest, ACvaeComesBackToTheLastBit) {
  TensorFolder content;
  content.kind = "cvae";
  (*content.settings)["coordinates"] = "ldp";
  AddTensors("", RandomCvae(), &content.tensors);
  ASSERT_FALSE(WriteTensorFolder(kRestorationFolder, Path("c"), content));
  const auto loaded = Unwrapped(LoadRestoration(Path("c")));
  const RestorationInput person = MovingPerson(StandingPose(), 80, 20);
  const BodyMotion before =
      CvaeRestoration(RandomCvae(1, {CvaeCoordinates::kLdp})).Restore({person})[0];
  const BodyMotion after = loaded->Restore({person})[0];
  for (int t = 0; t < 20; ++t) EXPECT_EQ(before[t], after[t]);
}

TEST_F(RestorationFilesTest, TheLatentVariableIsDrawn) {
  const RestorationInput person = MovingPerson(StandingPose(), 80, 20);
  TensorFolder content;
  content.kind = "cvae";
  AddTensors("", RandomCvae(), &content.tensors);
  ASSERT_FALSE(WriteTensorFolder(kRestorationFolder, Path("c"), content));
  const auto cvae = Unwrapped(LoadRestoration(Path("c")));
  const Pose mean = cvae->Restore({person})[0][19];
  ASSERT_FALSE(ChooseLatent({CvaeLatent::kDraw, 7}, cvae.get()));
  const Pose drawn = cvae->Restore({person})[0][19];
  EXPECT_NE(drawn, mean);
  EXPECT_EQ(drawn, cvae->Restore({person})[0][19]) << "a seed's draws repeat";
  ASSERT_FALSE(ChooseLatent({CvaeLatent::kDraw, 8}, cvae.get()));
  EXPECT_NE(drawn, cvae->Restore({person})[0][19]);
  const auto rigid = LoadRestoration("rigid");
  EXPECT_TRUE(ChooseLatent({CvaeLatent::kDraw, 7}, rigid.value().get()));
}

// What a restoration sees and how it is made stand in its settings; files without them are as
// before.
TEST_F(RestorationFilesTest, ViewsAndLayoutsComeBack) {
  const std::vector<RestorationInput> people = {
      MovingPerson(StandingPose(), 80, 20),
      MovingPerson(Placed(StandingPose(), 0.0, {0.6, 0.0, 0.0}), 70, 20)};
  for (const RestorationView view : {RestorationView::kNeighbours, RestorationView::kPose}) {
    const WindowWeights weights = RandomWindow(1, view);
    TensorFolder content;
    content.kind = "window";
    (*content.settings)["sees"] = NameOf(view);
    AddTensors("", weights, &content.tensors);
    ASSERT_FALSE(WriteTensorFolder(kRestorationFolder, Path("v"), content));
    const auto loaded = Unwrapped(LoadRestoration(Path("v")));
    EXPECT_EQ(loaded->Restore(people)[1][19], WindowRestoration(weights).Restore(people)[1][19]);
  }
  TensorFolder content;
  content.kind = "cvae";
  *content.settings = {{"sees", "pose"}, {"coordinates", "tip"}, {"halves", false}};
  AddTensors("", RandomCvae(1, {CvaeCoordinates::kTip, false, false}), &content.tensors);
  ASSERT_FALSE(WriteTensorFolder(kRestorationFolder, Path("c"), content));
  const auto loaded = Unwrapped(LoadRestoration(Path("c")));
  EXPECT_EQ(loaded->Restore(people)[1][19], loaded->Restore(people)[1][19]) << "draws repeat";
  WriteWindow();
  Replace("\"settings\": {", "\"settings\": {\"sees\": \"people\"");
  EXPECT_TRUE(Contains(ErrorOf(Path("r")), "must be pendulum, neighbours or pose"));
}

TEST_F(RestorationFilesTest, RigidNeedsNoFolder) {
  const auto loaded = Unwrapped(LoadRestoration("rigid"));
  EXPECT_EQ(loaded->kind(), "rigid");
}

TEST_F(RestorationFilesTest, WhatIsWrongIsNamed) {
  EXPECT_TRUE(Contains(ErrorOf(Path("nowhere")), "pushid-train-restoration"));
  WriteWindow();
  Replace("\"window\"", "\"wndow\"");
  EXPECT_TRUE(Contains(ErrorOf(Path("r")), "'wndow'; it must be window or cvae"));
  WriteWindow();
  Replace("\"format\": 1", "\"format\": 9");
  EXPECT_TRUE(Contains(ErrorOf(Path("r")), "format 9"));
  WriteWindow();
  Replace("network.1.bias", "network.7.bias");
  EXPECT_TRUE(Contains(ErrorOf(Path("r")), "network.1.bias is missing"));
  WriteWindow();
  Replace("\"rows\": 107", "\"rows\": 106");
  EXPECT_TRUE(Contains(ErrorOf(Path("r")), "do not fit"));
  WriteWindow();
  WriteText("r/restoration.json", "{\"format\": 1");
  EXPECT_TRUE(Contains(ErrorOf(Path("r")), "restoration.json:1"));
  WriteWindow();
  std::filesystem::remove(Path("r/weights.npy"));
  EXPECT_TRUE(Contains(ErrorOf(Path("r")), "weights.npy"));
}

TEST_F(RestorationFilesTest, DamagedOrExchangedWeightsAreRefused) {
  WriteWindow();
  std::string bytes = ReadText(Path("r/weights.npy"));
  WriteText("r/weights.npy", bytes.substr(0, bytes.size() / 2));
  EXPECT_TRUE(Contains(ErrorOf(Path("r")), "declares"));
  bytes[bytes.size() - 3] ^= 0x10;
  WriteText("r/weights.npy", bytes);
  EXPECT_TRUE(Contains(ErrorOf(Path("r")), "weights_hash"));
  WriteText("r/weights.npy", "not a file of numbers");
  EXPECT_TRUE(Contains(ErrorOf(Path("r")), "not a .npy file"));
}

TEST_F(RestorationFilesTest, NumbersThatAreNoneAreRefused) {
  TensorFolder content;
  content.kind = "window";
  WindowWeights weights = RandomWindow();
  weights.network.layers[1].weights(3, 4) = std::numeric_limits<float>::quiet_NaN();
  AddTensors("", weights, &content.tensors);
  ASSERT_FALSE(WriteTensorFolder(kRestorationFolder, Path("r"), content));
  EXPECT_TRUE(Contains(ErrorOf(Path("r")), "network.1.weights has entries that are not numbers"));
}

using NpyTest = TempDirTest;

TEST_F(NpyTest, ThereAndBack) {
  const std::vector<float> values = {1.5f, -0.25f, 3e-30f, 7.0f};
  ASSERT_FALSE(WriteNpy(Path("a.npy"), values));
  const auto read = Unwrapped(ReadNpy(Path("a.npy")));
  EXPECT_EQ(read, values);
  const std::string bytes = ReadText(Path("a.npy"));
  EXPECT_EQ((bytes.size() - 4 * sizeof(float)) % 64, 0u) << "numpy aligns the numbers";
  EXPECT_TRUE(Contains(bytes, "'shape': (4,)"));
}

using BodyFilesTest = TempDirTest;

TEST_F(BodyFilesTest, BvhHoldsTheMotion) {
  const RestorationInput person =
      MovingPerson(Placed(StandingPose(), 0.9, {0.2, -0.4, 0.0}), 80, 12);
  BodyMotion motion = WindowRestoration(RandomWindow()).Restore({person})[0];
  motion[0] = person.first_pose;
  for (size_t t = 1; t < motion.size(); ++t) {
    // Only what the skeleton can do.
    motion[t] = (TurnAboutZ(0.05 * static_cast<double>(t)) * motion[t]).eval();
  }
  BodyScene scene;
  scene.id = "x";
  scene.subject_ids = {"s"};
  scene.bodies = {motion};
  const auto files = Unwrapped(WriteBodyBvh(Path("m.bvh"), scene));
  EXPECT_EQ(files, std::vector<std::string>{Path("m.bvh")});
  const auto read = BvhInMetres(Path("m.bvh"));
  ASSERT_EQ(read.num_frames(), 12);
  for (int t = 0; t < 12; ++t) {
    const Pose carried = FitSkeleton(motion[0], motion[t]).positions;
    for (int j = 0; j < kBodyJoints; ++j) {
      EXPECT_LT((read.positions[j][t] - carried.col(j)).norm(), 1e-9) << t << " " << j;
    }
  }
}

TEST_F(BodyFilesTest, AFilePerPersonAndRows) {
  BodyScene scene;
  scene.id = "x";
  scene.subject_ids = {"s", "t/u"};
  scene.bodies = {BodyMotion(3, StandingPose()),
                  BodyMotion(3, Placed(StandingPose(), 1.0, {1, 0, 0}))};
  const auto files = Unwrapped(WriteBodyBvh(Path("m.bvh"), scene));
  EXPECT_EQ(files, (std::vector<std::string>{Path("m_0_s.bvh"), Path("m_1_t_u.bvh")}));
  ASSERT_FALSE(WriteJointsCsv(Path("j.csv"), scene));
  const std::string csv = ReadText(Path("j.csv"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 3 * 2 * 22);
  EXPECT_TRUE(Contains(csv, "\n0,0,0,s,Hips,0.020000,0.000000,1.000000\n"));
  EXPECT_TRUE(Contains(csv, "\n2,0.0333333333,1,t/u,Hips,"));
}

}  // namespace
}  // namespace pushid
