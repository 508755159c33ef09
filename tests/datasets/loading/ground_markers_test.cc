// Ground that moves from markers on it: under the person, in the manifest's units and rate.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "datasets/files/number_text.h"
#include "datasets/files/random.h"
#include "datasets/loading/load_recordings.h"
#include "models/ground.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

// Someone who stands rigidly on ground that tilts and shifts, and markers on it far from the feet;
// in metres by the key beside `recordings`, at a rate that the manifest corrects.
class GroundMarkers : public TempDirTest {
 protected:
  static constexpr int kFrames = 150;
  static constexpr double kRate = 200.0;
  static GroundPose Pose(int t) {
    const double u = std::min(std::max(0.0, (t - 30) / 60.0), 1.0), s = u * u * (3.0 - 2.0 * u);
    return {0.03 * s, 0.0, 0.05 * s, -0.02 * s};
  }
  Result<std::vector<Recording>> LoadMarkers(const std::vector<Eigen::Vector3d>& marks,
                                             double noise, double slide = 0.0, int hidden = -1) {
    Random random(5);
    const Eigen::Vector3d ankles(0.0, 0.0, 0.09);
    const auto row = [&](const Eigen::Vector3d& point, int t, double sigma) {
      std::string text;
      const Eigen::Vector3d seen = PointInLaboratory(Pose(t), ankles, point);
      for (int i = 0; i < 3; ++i) text += "," + DoubleText(seen[i] + sigma * random.Normal());
      return text;
    };
    std::string text = "time";
    for (const char* name : {"hip", "left_ankle", "right_ankle", "p0", "p1", "p2"}) {
      for (const char* axis : {"_x", "_y", "_z"}) text += std::string(",") + name + axis;
    }
    text += "\n";
    for (int t = 0; t < kFrames; ++t) {
      text += DoubleText(t / 100.0);
      for (const Eigen::Vector3d& p :
           {Eigen::Vector3d(0.0, 0.0, 1.0), Eigen::Vector3d(0.0, 0.1, 0.09),
            Eigen::Vector3d(0.0, -0.1, 0.09)}) {
        text += row(p, t, 0.0);
      }
      for (const Eigen::Vector3d& p : marks) {
        const bool first = &p == marks.data();
        if (first && t == hidden) {
          text += ",,,";
          continue;
        }
        const double slid = first && t > kFrames / 2 ? slide : 0.0;
        text += row(p + Eigen::Vector3d(0.0, slid, 0.0), t, noise);
      }
      text += "\n";
    }
    WriteText("marked.csv", text);
    Json entry = {{"id", "a"}, {"setting", "single"}, {"pushed_person", 0}, {"fps", kRate}};
    entry["subjects"] = Json::array({{{"id", "S"}, {"mass_kg", 70}}});
    entry["csv"] = Json::array({"marked.csv"});
    entry["ground"]["markers"] = {"p0", "p1", "p2"};
    Json manifest;
    manifest["length_unit"] = "m";
    manifest["recordings"] = Json::array({entry});
    WriteText("marked.json", manifest.dump());
    warnings_.clear();
    return LoadRecordings(Path("marked.json"), {}, &warnings_);
  }
  Warnings warnings_;
};

TEST_F(GroundMarkers, GiveTheGroundUnderThePerson) {
  const auto loaded =
      Unwrapped(LoadMarkers({{0.9, 0.3, 0.0}, {0.9, -0.3, 0.0}, {0.5, 0.3, 0.0}}, 0.0));
  const Recording& recording = loaded[0];
  ASSERT_EQ(recording.num_frames(), kFrames);
  for (int t = 0; t < kFrames; ++t) {
    EXPECT_LT((recording.ground[t] - Pose(t)).norm(), 1e-9) << t;
  }
}

// 0.2 mm of noise is no motion.
TEST_F(GroundMarkers, MayBeNoisy) {
  const auto loaded =
      Unwrapped(LoadMarkers({{0.4, 0.3, 0.0}, {0.4, -0.3, 0.0}, {-0.4, 0.3, 0.0}}, 2e-4));
  EXPECT_LT((loaded[0].ground.back() - Pose(kFrames - 1)).norm(), 3e-3);
}

TEST_F(GroundMarkers, ThatAreNotRigidAreRefused) {
  const std::vector<Eigen::Vector3d> marks = {{0.4, 0.3, 0.0}, {0.4, -0.3, 0.0}, {-0.4, 0.3, 0.0}};
  const auto still = LoadMarkers(marks, 0.0, 0.015);
  EXPECT_TRUE(still.ok()) << still.error().ToString();
  const std::string slid = ProblemOf(LoadMarkers(marks, 0.0, 0.03));
  EXPECT_TRUE(Contains(slid, "the markers p0 and p1 of the ground are not rigid"));
  EXPECT_TRUE(Contains(slid, "may by 10 mm"));
}

TEST_F(GroundMarkers, FilledGapsAreTold) {
  const std::vector<Eigen::Vector3d> marks = {{0.4, 0.3, 0.0}, {0.4, -0.3, 0.0}, {-0.4, 0.3, 0.0}};
  const auto loaded = LoadMarkers(marks, 0.0, 0.0, 60);
  ASSERT_TRUE(loaded.ok()) << loaded.error().ToString();
  ASSERT_FALSE(warnings_.empty());  // the rate that the manifest corrects is told too
  EXPECT_TRUE(Contains(warnings_.back().text, "the marker p0 of the ground has 1 gap, 1 frames"));
}

TEST_F(GroundMarkers, OnALineLeaveATiltOpen) {
  EXPECT_TRUE(
      Contains(ProblemOf(LoadMarkers({{0.4, 0.3, 0.0}, {0.4, 0.0, 0.0}, {0.4, -0.3, 0.0}}, 0.0)),
               "lie on a line"));
}

}  // namespace
}  // namespace pushid
