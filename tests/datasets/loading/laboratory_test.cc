// Ground that moves and force platforms: from files to recordings and back, and what is wrong with
// them.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "datasets/loading/load_recordings.h"
#include "datasets/loading/pendulum_recording.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "tests/simulators/platform_files.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

PlatformOptions OnPlatform(GroundKind ground) {
  PlatformOptions options;
  options.model.stance = Stance::kFixed;
  options.model.push_tail = PushTail::kNone;
  options.parameters = {};
  options.parameters[kKpTheta] = options.parameters[kKpPhi] = 1250.0;
  options.parameters[kKdTheta] = options.parameters[kKdPhi] = 300.0;
  options.parameters[kComHeight] = 1.09;
  options.subjects = 1;
  options.recordings_per_subject = 1;
  options.fps = 100.0;
  options.frames = 150;
  options.lean_sigma_rad = 0.0;
  options.pushes = false;
  options.kind = ground;
  options.plate_noise_m = options.plate_noise_n = 0.0;
  return options;
}

class LaboratoryTest : public TempDirTest {
 protected:
  // Writes the recording and what the manifest then says after `change`; loads it.
  Result<std::vector<Recording>> Load(const PlatformOptions& options,
                                      const std::function<void(Json*)>& change = nullptr) {
    made_ = MakeOnPlatforms(options).value();
    EXPECT_FALSE(WriteOnPlatforms(folder_.string(), options, made_));
    if (change) {
      Json json = Json::parse(ReadText(Path("manifest.json")));
      change(&json["recordings"][0]);
      WriteText("manifest.json", json.dump());
    }
    return LoadRecordings(Path("manifest.json"));
  }
  std::string Id() const { return made_[0].recording.id; }

  std::vector<SyntheticRecording> made_;
};

TEST_F(LaboratoryTest, WhatWasRolledOutComesBack) {
  PlatformOptions options = OnPlatform(GroundKind::kStep);
  const auto loaded = Unwrapped(Load(options));
  const PendulumRecording seen = MakePendulumRecording(loaded[0]);
  ASSERT_TRUE(seen.scene.ground.moves());
  ASSERT_TRUE(seen.HasPlates());
  double shear = 0.0;
  for (int t = 0; t < options.frames; ++t) {
    EXPECT_LT((seen.scene.ground.poses[t] - made_[0].scene.ground.poses[t]).norm(), 1e-12) << t;
    EXPECT_LT((seen.states[0][t].q - made_[0].path.At(t, 0).q).norm(), 1e-5) << t;
    shear = std::max(shear, std::abs(seen.plates[0][t].shear[0]));
  }
  EXPECT_GT(shear, 20.0);
  // Feet hold, and are seen to.
  EXPECT_LT(std::abs(seen.states[0].back().q[0] - seen.states[0][0].q[0]), 1e-5);
}

// One frame's noise would be in every frame of a rollout.
TEST_F(LaboratoryTest, WhoStandsQuietlyStartsFromTheMean) {
  PlatformOptions options = OnPlatform(GroundKind::kStep);
  options.joint_noise_m = 0.005;
  const PendulumRecording seen = MakePendulumRecording(Unwrapped(Load(options))[0]);
  const std::vector<GroundPose>& poses = seen.scene.ground.poses;
  int quiet = 0;
  while ((poses[quiet] - poses[0]).norm() < 1e-9) ++quiet;
  ASSERT_GT(quiet, 5);
  // The mean of at least half of the frames at rest, and of none in which the ground moves.
  double error = 1.0;
  Vector4<double> mean = Vector4<double>::Zero();
  for (int t = 0; t < quiet; ++t) {
    mean += (seen.states[0][t].q - mean) / (t + 1);
    if (t >= quiet / 2) error = std::min(error, (seen.scene.people[0].start.q - mean).norm());
  }
  EXPECT_LT(error, 1e-12);
  EXPECT_GT((seen.states[0][0].q - mean).norm(), 1e-4);
}

// A person who steps onto the platform when it moves already has no rest there: centres count from
// their mean.
TEST_F(LaboratoryTest, CentresOfWhoPressedNothingBeforeCountFromTheirMean) {
  const auto loaded = Unwrapped(Load(OnPlatform(GroundKind::kStep)));
  Recording recording = loaded[0];
  std::vector<PlateSample>& plates = recording.people[0].plates;
  for (size_t t = 0; t < plates.size(); ++t) {
    plates[t].centre.x() += 7.0;
    if (t < plates.size() / 2) plates[t].weight = 0.0;
  }
  const PendulumRecording seen = MakePendulumRecording(recording);
  double sum = 0.0;
  for (const PlateFrame& frame : seen.plates[0]) sum += frame.weight > 0.0 ? frame.centre.x() : 0.0;
  EXPECT_NEAR(sum, 0.0, 1e-9);
}

TEST_F(LaboratoryTest, RatesAreSummedUpToWhatTheyWere) {
  const PlatformOptions options = OnPlatform(GroundKind::kSine);
  for (const std::string quantity : {"velocity", "acceleration"}) {
    const auto loaded = Load(options, [&](Json* entry) {
      std::string text = "time,x\n";
      const std::vector<GroundPose>& poses = made_[0].scene.ground.poses;
      for (int t = 0; t < options.frames; ++t) {
        const int next = std::min(t + 1, options.frames - 1);
        const double rate = (poses[next][0] - poses[t][0]) * options.fps;
        const double value =
            quantity == "velocity" ? rate : made_[0].scene.ground.steps[t].acceleration[0];
        text += std::to_string(t / options.fps) + "," + std::to_string(value) + "\n";
      }
      WriteText("rates.csv", text);
      (*entry)["ground"] = {{"csv", "rates.csv"}, {"quantity", quantity}};
    });
    ASSERT_TRUE(loaded.ok()) << loaded.error().ToString();
    for (int t = 0; t + 1 < options.frames; ++t) {
      EXPECT_NEAR(loaded.value()[0].ground[t][0], made_[0].scene.ground.poses[t][0], 1e-4)
          << quantity << " " << t;
    }
  }
}

// Another rate, another clock.
TEST_F(LaboratoryTest, FilesHaveTheirOwnClocks) {
  const PlatformOptions options = OnPlatform(GroundKind::kSine);
  const auto loaded = Load(options, [&](Json* entry) {
    std::string text = "time,x,theta\n";
    const auto poses = SyntheticGround(GroundKind::kSine, options.size_m, 400, 1.0 / 250.0);
    for (int i = -50; i < 400; ++i) {
      const double x = i < 0 ? 0.0 : poses[i][0];
      text += std::to_string(3.0 + i / 250.0) + "," + std::to_string(x) + ",0\n";
    }
    WriteText("own.csv", text);
    (*entry)["ground"] = {{"csv", "own.csv"}, {"start", 3.0}};
  });
  ASSERT_TRUE(loaded.ok()) << loaded.error().ToString();
  for (int t = 0; t < options.frames; ++t) {
    EXPECT_NEAR(loaded.value()[0].ground[t][0], made_[0].scene.ground.poses[t][0], 3e-5) << t;
  }
}

std::string Plates(double vertical, double x, int frames) {
  std::string text = "time,fx,fy,fz,px,py\n";
  for (int t = 0; t < frames; ++t) {
    text += std::to_string(t / 100.0) + ",0,0," + std::to_string(vertical) + "," +
            std::to_string(x) + ",0.001\n";
  }
  return text;
}

class WrongLaboratory : public LaboratoryTest,
                        public ::testing::WithParamInterface<
                            std::tuple<std::string, std::string, std::string, std::string>> {};

TEST_P(WrongLaboratory, IsToldOf) {
  const auto& [name, entry_text, file, said] = GetParam();
  PlatformOptions options = OnPlatform(GroundKind::kStep);
  const auto loaded = Load(options, [&, this](Json* entry) {
    if (!file.empty()) WriteText("wrong.csv", file);
    entry->update(Json::parse(entry_text));
  });
  ASSERT_FALSE(loaded.ok()) << name;
  EXPECT_TRUE(Contains(loaded.error().ToString(), said));
  EXPECT_TRUE(Contains(loaded.error().ToString(), Id()));
}

std::string Moving(int frames, double speed) {
  std::string text = "time,x\n";
  for (int t = 0; t < frames; ++t) {
    text += std::to_string(t / 100.0) + "," + std::to_string(speed * t / 100.0) + "\n";
  }
  return text;
}

constexpr char kGround[] = R"({"ground": {"csv": "wrong.csv"}})";
constexpr char kPlates[] = R"({"force_plates": {"file": "wrong.csv"}})";

INSTANTIATE_TEST_SUITE_P(
    Table, WrongLaboratory,
    ::testing::Values(
        std::tuple("ends_early", kGround, Moving(40, 0.0),
                   "the record of the ground lasts from 0 to 0.39 s"),
        std::tuple("moves_at_first", kGround, Moving(400, 0.3), "at frame 0, where people are"),
        std::tuple("no_columns", kGround, "time,a\n0,1\n0.01,2\n0.02,3\n",
                   "none of the columns x, y, theta, phi"),
        std::tuple(
            "misspelt", kGround, "time,x,tehta\n0,0,0\n0.01,0,0\n0.02,0,0\n",
            "wrong.csv:1: recording 'S01_00_weak': the column 'tehta' is not known, and would "
            "be read as none; did you mean theta?"),
        std::tuple("no_time", kGround, "x,y\n0,1\n1,2\n2,3\n", "no column called time"),
        std::tuple("no_file", R"({"ground": {"start": 1}})", "", "csv is missing"),
        std::tuple("quantity", R"({"ground": {"csv": "wrong.csv", "quantity": "jerk"}})", "",
                   "quantity"),
        std::tuple("unknown_key", R"({"ground": {"csv": "wrong.csv", "star": 1}})", "", "star"),
        std::tuple("use", R"({"force_plates": {"use": "guess"}})", "", "use"),
        std::tuple("not_the_weight", kPlates, Plates(3000.0, 0.0, 200),
                   "correct mass_kg, the platform's gain or axes"),
        std::tuple("not_pressed", kPlates, Plates(1.0, 0.0, 200), "pressed with less than"),
        std::tuple("plates_end_early", kPlates, Plates(800.0, 0.0, 60),
                   "the platforms were recorded from 0 to 0.59 s"),
        std::tuple("no_centres", kPlates,
                   "time,fx,fy,fz,px,py\n0,0,0,700,nan,nan\n0.01,0,0,700,0,0\n0.02,0,0,700,,\n",
                   "wrong.csv:2: recording 'S01_00_weak': platform 1 is pressed and has no centre"),
        std::tuple("no_plate_columns", kPlates, "time,a\n0,1\n0.01,2\n0.02,3\n",
                   "no columns of a force platform"),
        std::tuple("plates_in_bvh", R"({"force_plates": {"use": "measure"}})", "",
                   "BVH file holds no force platforms"),
        std::tuple("only_lifted", R"({"ground": {"csv": "wrong.csv", "up": "y", "forward": "x"}})",
                   "time,y\n0,0\n0.01,0\n0.02,0\n", "none of the columns x, z, theta, phi"),
        std::tuple("no_centre", kPlates, "time,fx,fy,fz\n0,1,2,3\n0.01,1,2,3\n0.02,1,2,3\n",
                   "no columns of a force platform")),
    [](const auto& test) { return std::get<0>(test.param); });

// y up and z forward, as laboratories of gait have it: x is to the left.
TEST_F(LaboratoryTest, FilesHaveTheirOwnAxes) {
  const PlatformOptions options = OnPlatform(GroundKind::kStep);
  const auto loaded = Load(options, [&](Json* entry) {
    std::string ground = "time,x,z\n", plates = "time,fx,fy,fz,px,pz\n";
    for (int t = 0; t < options.frames; ++t) {
      const std::string time = std::to_string(t / options.fps);
      const PlateSample& s = made_[0].recording.people[0].plates[t];
      ground += time + ",0," + std::to_string(made_[0].scene.ground.poses[t][0]) + "\n";
      plates += time;
      for (double value : {s.force[1], s.force[2], s.force[0], s.centre[1], s.centre[0]}) {
        plates += "," + std::to_string(value);
      }
      plates += "\n";
    }
    WriteText("ground.csv", ground);
    WriteText("plates.csv", plates);
    const Json axes = {{"up", "y"}, {"forward", "z"}};
    (*entry)["ground"] = axes;
    (*entry)["ground"]["csv"] = "ground.csv";
    (*entry)["force_plates"] = axes;
    (*entry)["force_plates"].update({{"file", "plates.csv"}, {"lowpass_hz", 45}});
  });
  ASSERT_TRUE(loaded.ok()) << loaded.error().ToString();
  const Recording& recording = loaded.value()[0];
  for (int t = 5; t + 5 < options.frames; ++t) {
    const PlateSample& s = made_[0].recording.people[0].plates[t];
    EXPECT_NEAR(recording.ground[t][0], made_[0].scene.ground.poses[t][0], 1e-6) << t;
    EXPECT_LT((recording.people[0].plates[t].force - s.force).norm(), 1.0) << t;
    EXPECT_LT((recording.people[0].plates[t].centre - s.centre).norm(), 1e-3) << t;
  }
}

// Far from the feet of someone who stands at the origin, on ground that does not move.
TEST_F(LaboratoryTest, CentresFarFromTheFeetAreRefused) {
  PlatformOptions options = OnPlatform(GroundKind::kNone);
  options.pushes = true;
  options.push_kind = PushKind::kExternal;
  options.strengths = {{"weak", 0.3}};
  const auto loaded = Load(options, [&, this](Json* entry) {
    const double weight = made_[0].recording.people[0].mass_kg * kGravity;
    WriteText("far.csv", Plates(weight, 2.0, 200));
    (*entry)["force_plates"] = {{"file", "far.csv"}};
  });
  ASSERT_FALSE(loaded.ok());
  EXPECT_TRUE(Contains(loaded.error().ToString(), "2 m from the ankles on average"));
}

// Two platforms, one foot each, are one.
TEST_F(LaboratoryTest, PlatformsAddUp) {
  PlatformOptions options = OnPlatform(GroundKind::kStep);
  const auto loaded = Load(options, [&, this](Json* entry) {
    std::string text = "time,l_fx,l_fy,l_fz,l_px,l_py,r_fx,r_fy,r_fz,r_px,r_py\n";
    for (int t = 0; t < options.frames; ++t) {
      const PlateSample& s = made_[0].recording.people[0].plates[t];
      text += std::to_string(t / 100.0);
      for (const auto& [share, side] : {std::pair(0.25, 0.3), std::pair(0.75, -0.1)}) {
        for (double f : s.force) text += "," + std::to_string(share * f);
        text += "," + std::to_string(s.centre[0]) + "," + std::to_string(s.centre[1] + side);
      }
      text += "\n";
    }
    WriteText("two.csv", text);
    (*entry)["force_plates"] = {{"file", "two.csv"}, {"plates", {"l", "r"}}, {"lowpass_hz", 45}};
  });
  ASSERT_TRUE(loaded.ok()) << loaded.error().ToString();
  const std::vector<PlateSample>& plates = loaded.value()[0].people[0].plates;
  for (int t = 5; t + 5 < options.frames; ++t) {
    const PlateSample& s = made_[0].recording.people[0].plates[t];
    EXPECT_LT((plates[t].force - s.force).norm(), 1.0) << t;
    EXPECT_LT((plates[t].centre - s.centre).norm(), 1e-3) << t;
  }
}

// One foot on each of two platforms, 0.4 m apart. Where one lacks its centre under load, the frames
// have no weight and the others are as they were; an unloaded one needs none.
TEST_F(LaboratoryTest, CentresThatAreMissingUnderLoad) {
  const PlatformOptions options = OnPlatform(GroundKind::kStep);
  struct Gap {
    std::string cells;
    int from, to;
    double left = 0.5;  // its share of the load
    bool counts = false;
  };
  for (const Gap& gap : {Gap{"nan,nan", 60, 80}, Gap{"0,0", 60, 80}, Gap{",", 60, 80},
                         Gap{"nan,0.1", 60, 80}, Gap{"nan,nan", 0, 20}, Gap{"0,0", 130, 150},
                         Gap{"nan,nan", 70, 71}, Gap{"0.0,-0.0", 10, 140}, Gap{"0,0", 0, 140},
                         Gap{"nan,nan", 0, 150, 0.0, true}, Gap{"0,0", 0, 150, 0.0, true}}) {
    Warnings warnings;
    Load(options, [&, this](Json* entry) {
      std::string text = "time,l_fx,l_fy,l_fz,l_px,l_py,r_fx,r_fy,r_fz,r_px,r_py\n";
      for (int t = 0; t < options.frames; ++t) {
        const PlateSample& s = made_[0].recording.people[0].plates[t];
        text += std::to_string(t / 100.0);
        for (const auto& [share, side] :
             {std::pair(gap.left, 0.2), std::pair(1 - gap.left, -0.2)}) {
          for (double f : s.force) text += "," + std::to_string(share * f);
          const bool lost = side > 0.0 && t >= gap.from && t < gap.to;
          const double y = s.centre[1] + (gap.left > 0.0 ? side : 0.0);
          text += "," + (lost ? gap.cells : std::to_string(s.centre[0]) + "," + std::to_string(y));
        }
        text += "\n";
      }
      WriteText("two.csv", text);
      (*entry)["force_plates"] = {{"file", "two.csv"}, {"plates", {"l", "r"}}, {"lowpass_hz", 45}};
    }).ok();
    const auto loaded = Unwrapped(LoadRecordings(Path("manifest.json"), LoadOptions(), &warnings));
    EXPECT_EQ(warnings.size(), gap.counts ? 0u : 1u) << gap.cells << " " << gap.from;
    if (!gap.counts) {
      EXPECT_TRUE(Contains(warnings.at(0).text,
                           "platform 1 is pressed and has no centre of "
                           "pressure (empty, nan or zeros) in " +
                               std::to_string(gap.to - gap.from) + " rows, from line " +
                               std::to_string(gap.from + 2)));
    }
    const std::vector<PlateSample>& plates = loaded[0].people[0].plates;
    for (int t = 0; t < options.frames; ++t) {
      const PlateSample& s = made_[0].recording.people[0].plates[t];
      const bool lost = !gap.counts && t >= gap.from && t < gap.to;
      EXPECT_TRUE(!lost || plates[t].weight == 0.0) << gap.cells << " " << t;
      EXPECT_TRUE(plates[t].weight > 0.0 || (t > gap.from - 4 && t < gap.to + 4)) << t;
      if (t < 5 || t + 5 >= options.frames || plates[t].weight == 0.0) continue;
      EXPECT_LT((plates[t].centre - s.centre).norm(), 2e-3) << gap.cells << " " << t;
    }
  }
}

// The force on the platform, as some laboratories store it.
TEST_F(LaboratoryTest, ForcesOfTheOtherSign) {
  const PlatformOptions options = OnPlatform(GroundKind::kStep);
  Load(options, [&, this](Json* entry) {
    std::string text = "time,fx,fy,fz,px,py\n";
    for (int t = 0; t < options.frames; ++t) {
      const PlateSample& s = made_[0].recording.people[0].plates[t];
      text += std::to_string(t / 100.0);
      for (double f : s.force) text += "," + std::to_string(-f);
      text += "," + std::to_string(s.centre[0]) + "," + std::to_string(s.centre[1]) + "\n";
    }
    WriteText("other.csv", text);
    (*entry)["force_plates"] = {{"file", "other.csv"}, {"lowpass_hz", 45}};
  }).ok();
  Warnings warnings;
  const auto loaded = Unwrapped(LoadRecordings(Path("manifest.json"), LoadOptions(), &warnings));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(Contains(warnings[0].text, "taken as that on the platform; is \"up\" right?"));
  for (int t = 5; t + 5 < options.frames; ++t) {
    const PlateSample& s = made_[0].recording.people[0].plates[t];
    EXPECT_LT((loaded[0].people[0].plates[t].force - s.force).norm(), 1.0) << t;
    EXPECT_LT((loaded[0].people[0].plates[t].centre - s.centre).norm(), 1e-3) << t;
  }
}

}  // namespace
}  // namespace pushid
