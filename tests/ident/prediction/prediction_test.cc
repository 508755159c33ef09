// Predictions, what-ifs and the trajectory CSV.
#include "ident/prediction/prediction.h"

#include <gtest/gtest.h>

#include <sstream>

#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

std::vector<std::string> Split(const std::string& line) {
  std::vector<std::string> parts;
  std::stringstream stream(line);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

TEST(Prediction, TheTruthReproducesTheRecording) {
  const SyntheticOptions study = SmallStudy();
  for (const PendulumRecording& recording : MakePendulums(study)) {
    const Prediction p = Predict(TruthOf(study), recording);
    ASSERT_TRUE(p.status.ok);
    ASSERT_EQ(p.hip.size(), 1u);
    ASSERT_EQ(p.hip[0].size(), 70u);
    for (int t = 0; t < 70; ++t) {
      EXPECT_LT((p.hip[0][t] - recording.hip[0][t]).norm(), 1e-9) << recording.id << " " << t;
    }
  }
}

TEST(Prediction, AnyNumberOfFrames) {
  const SyntheticOptions study = TinyStudy();
  const PendulumRecording recording = MakePendulums(study)[0];
  EXPECT_EQ(Predict(TruthOf(study), recording, 200).hip[0].size(), 200u);
  const Prediction few = Predict(TruthOf(study), recording, 10),
                   all = Predict(TruthOf(study), recording);
  EXPECT_EQ(few.hip[0].size(), 10u);
  EXPECT_EQ(few.hip[0][9], all.hip[0][9]);
}

TEST(Prediction, ASubjectsOwnParameters) {
  const SyntheticOptions study = TinyStudy();
  const PendulumRecording recording = MakePendulums(study)[0];
  IdentifiedModel model = TruthOf(study);
  const auto shared = Predict(model, recording).hip[0].back();
  model.by_unit["someone else"] = model.parameters;
  model.by_unit["someone else"][kMu] = 300.0;
  EXPECT_EQ(Predict(model, recording).hip[0].back(), shared);
  model.by_unit[recording.subject_ids[0]] = model.by_unit["someone else"];
  EXPECT_LT(Predict(model, recording).hip[0].back()[0], shared[0] - 0.01);
}

TEST(Prediction, WhatIf) {
  const SyntheticOptions study = TinyStudy();
  const PendulumRecording recording = MakePendulums(study)[0];
  IdentifiedModel model = TruthOf(study);
  model.by_unit["S01"] = model.parameters;
  ASSERT_FALSE(SetValues("mu=200,Kp_phi=900", &model));
  EXPECT_EQ(model.parameters[kMu], 200.0);
  EXPECT_EQ(model.by_unit["S01"][kMu], 200.0);
  EXPECT_EQ(model.by_unit["S01"][kKpPhi], 900.0);
  EXPECT_EQ(model.parameters[kAx], study.parameters[kAx]);
  const double rough = Predict(model, recording).hip[0].back()[0];
  ASSERT_FALSE(SetValues("mu=5", &model));
  EXPECT_GT(Predict(model, recording).hip[0].back()[0], rough);

  // What differs by setting can be set too.
  model.options.interaction.spring = true;
  model.table[kContactDistance].free = model.table[kContactDistance].pooled = true;
  EXPECT_FALSE(SetValues("mu=6,contact_distance=0.5", &model));
  EXPECT_EQ(model.by_unit["S01"][kContactDistance], 0.5);

  const ParameterSet<double> before = model.parameters;
  for (const char* bad :
       {"nu=3", "mu", "mu=abc", "Kp_theta=-10", "mu=7,Kp_theta=1e9", "support_front=0.1"}) {
    EXPECT_TRUE(Contains(ProblemOf(SetValues(bad, &model)), "--set")) << bad;
    EXPECT_EQ(model.parameters, before) << bad;
  }
}

class TrajectoryCsv : public TempDirTest {};

TEST_F(TrajectoryCsv, ColumnsAndValues) {
  const SyntheticOptions study = TinyStudy();
  const PendulumRecording recording = MakePendulums(study)[0];
  const IdentifiedModel model = TruthOf(study);
  const Prediction p = Predict(model, recording);
  ASSERT_FALSE(WriteTrajectoryCsv(Path("t.csv"), recording, p));
  std::istringstream file(ReadText(Path("t.csv")));
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> header = Split(line);
  ASSERT_EQ(header.size(), 43u);
  EXPECT_EQ(line.find("frame,time_s,person,subject,x_m,y_m,theta_rad,phi_rad,xd_m_s"), 0u);
  EXPECT_EQ(header[15], "friction_x_N");
  EXPECT_EQ(header.back(), "network_phi_Nm");
  int t = 0;
  for (; std::getline(file, line); ++t) {
    const std::vector<std::string> row = Split(line);
    ASSERT_EQ(row.size(), header.size()) << line;
    EXPECT_EQ(row[0], std::to_string(t));
    EXPECT_NEAR(std::stod(row[1]), t / 60.0, 1e-8);
    EXPECT_EQ(row[3], recording.subject_ids[0]);
    EXPECT_NEAR(std::stod(row[4]), p.path.At(t, 0).q[0], 1e-8);
    EXPECT_NEAR(std::stod(row[8]), p.path.At(t, 0).qd[0], 1e-8);
    EXPECT_NEAR(std::stod(row[12]), p.hip[0][t][0], 1e-8);
    // The force drives the step to the next frame.
    if (t + 1 == 45) continue;
    Vector4<double> force = Vector4<double>::Zero();
    for (int part = 0; part < 5; ++part) {
      for (int i = 0; i < 4; ++i) force[i] += std::stod(row[15 + 4 * part + i]);
    }
    const auto next =
        Step(p.path.At(t, 0), Acceleration(recording.scene.people[0].body, p.path.At(t, 0), force),
             recording.scene.dt);
    EXPECT_LT((next.q - p.path.At(t + 1, 0).q).norm(), 1e-7) << t;
  }
  EXPECT_EQ(t, 45);
}

// The hip hangs on the predicted rod and on the cart's height, which the file holds too.
TEST_F(TrajectoryCsv, ARodThatMoves) {
  const SyntheticOptions study = TinyStudy();
  const PendulumRecording recording = MakePendulums(study)[0];
  IdentifiedModel model = TruthOf(study);
  LearnedTerms network;
  network.rod = {RodKind::kLdp, {1}};
  network.weights = {0, 0, -0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 20, 1, -20};
  model.options.learned = std::make_shared<LearnedTerms>(network);
  const Prediction p = Predict(model, recording);
  ASSERT_TRUE(p.status.ok);
  ASSERT_FALSE(WriteTrajectoryCsv(Path("t.csv"), recording, p));
  std::istringstream file(ReadText(Path("t.csv")));
  std::string line;
  std::getline(file, line);
  EXPECT_TRUE(Contains(line, ",network_phi_Nm,rod_length_m,cart_height_m"));
  const Body& body = recording.scene.people[0].body;
  double shortest = body.rod_length;
  for (int t = 0; std::getline(file, line); ++t) {
    const std::vector<std::string> row = Split(line);
    ASSERT_EQ(row.size(), 45u);
    const double rod = std::stod(row[43]), height = std::stod(row[44]);
    const Vector4<double>& q = p.path.At(t, 0).q;
    EXPECT_NEAR(rod, body.rod_length + p.path.At(t, 0).rod, 1e-8);
    EXPECT_NEAR(height, body.cart_height, 1e-8);
    EXPECT_NEAR(p.hip[0][t][2], height + rod * std::cos(q[2]) * std::cos(q[3]), 1e-8);
    EXPECT_NEAR(std::stod(row[14]), p.hip[0][t][2], 1e-8);
    shortest = std::min(shortest, rod);
  }
  EXPECT_LT(shortest, body.rod_length - 1e-3);
}

TEST_F(TrajectoryCsv, UnwritablePathIsAnError) {
  const SyntheticOptions study = TinyStudy();
  const PendulumRecording recording = MakePendulums(study)[0];
  const IdentifiedModel model = TruthOf(study);
  EXPECT_TRUE(Contains(
      ProblemOf(WriteTrajectoryCsv(Path("none/t.csv"), recording, Predict(model, recording))),
      "t.csv"));
}

// After a failure only the frames before it are there; the file holds those.
TEST_F(TrajectoryCsv, AFallenPrediction) {
  const SyntheticOptions study = TinyStudy();
  PendulumRecording recording = MakePendulums(study)[0];
  recording.scene = ScalePushes(recording.scene, 120.0);
  const Prediction p = Predict(TruthOf(study), recording);
  ASSERT_FALSE(p.status.ok);
  EXPECT_GT(p.status.frame, 0);
  EXPECT_FALSE(p.status.quantity.empty());
  EXPECT_TRUE(p.hip.empty());
  ASSERT_FALSE(WriteTrajectoryCsv(Path("t.csv"), recording, p));
  std::istringstream file(ReadText(Path("t.csv")));
  int lines = 0;
  for (std::string line; std::getline(file, line);) ++lines;
  EXPECT_EQ(lines, 1 + p.status.frame);
}

}  // namespace
}  // namespace pushid
