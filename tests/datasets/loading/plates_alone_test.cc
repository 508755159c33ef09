// People whom force plates alone measured, platforms that give moments, and whose they are.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "datasets/files/number_text.h"
#include "datasets/inspection/inspection.h"
#include "datasets/loading/load_recordings.h"
#include "datasets/loading/pendulum_recording.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "tests/datasets/c3d_samples.h"
#include "tests/datasets/c3d_writer.h"
#include "tests/simulators/platform_files.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMass = 70.0, kRate = 100.0;
constexpr int kRows = 200;

// The measurements of a platform: force on the person and centre of pressure.
struct Pressed {
  Eigen::Vector3d force;
  Eigen::Vector2d centre;
};
Pressed At(int row) {
  const double phase = 2.0 * M_PI * 0.5 * row / kRate;
  return {{5.0 * std::sin(phase), -3.0 * std::sin(phase), kMass * kGravity},
          {0.31 + 0.01 * std::sin(phase), 0.12 + 0.02 * std::cos(phase)}};
}

class PlatesAlone : public TempDirTest {
 protected:
  Result<std::vector<Recording>> Load(const std::function<void(Json*)>& change = nullptr,
                                      bool allowed = true) {
    std::string text = "time,fx,fy,fz,px,py\n";
    for (int row = 0; row < kRows; ++row) {
      const Pressed at = At(row);
      text += DoubleText(2.0 + row / kRate);
      for (double value : at.force) text += "," + DoubleText(value);
      text += "," + DoubleText(at.centre[0]) + "," + DoubleText(at.centre[1]) + "\n";
    }
    WriteText("quiet.csv", text);
    Json entry = {{"id", "a"}, {"setting", "single"}, {"pushed_person", 0}, {"motion", "none"}};
    entry["subjects"] = Json::array({{{"id", "S"}, {"mass_kg", kMass}, {"rod_m", 0.9}}});
    entry["force_plates"] = {{"use", "measure"}, {"file", "quiet.csv"}, {"lowpass_hz", 45}};
    if (change) change(&entry);
    Json manifest;
    manifest["recordings"] = Json::array({entry});
    WriteText("manifest.json", manifest.dump(1));
    LoadOptions options;
    options.plates_alone = allowed;
    warnings_.clear();
    return LoadRecordings(Path("manifest.json"), options, &warnings_);
  }
  Warnings warnings_;
  std::string Problem(const std::function<void(Json*)>& change, bool allowed = true) {
    return ProblemOf(Load(change, allowed));
  }
};

TEST_F(PlatesAlone, StandForAsLongAsTheyMeasuredAndHaveNoWeight) {
  const auto loaded = Unwrapped(Load());
  const Recording& recording = loaded[0];
  EXPECT_DOUBLE_EQ(recording.fps, kRate);
  ASSERT_EQ(recording.num_frames(), kRows);
  const PendulumRecording seen = MakePendulumRecording(recording);
  EXPECT_NEAR(seen.scene.people[0].body.rod_length, 0.9, 1e-12);
  EXPECT_NEAR(seen.scene.people[0].body.cart_height, kUsualAnkleHeight, 1e-12);
  for (int t = 0; t < kRows; ++t) EXPECT_EQ(seen.Weight(0, t), 0.0) << t;
  ASSERT_TRUE(seen.HasPlates(0));
  const std::vector<PlateSample>& plates = recording.people[0].plates;
  for (int t = 10; t + 10 < kRows; ++t) {
    EXPECT_LT((plates[t].force - At(t).force).norm(), 0.05) << t;
    EXPECT_LT((plates[t].centre.head<2>() - At(t).centre).norm(), 1e-4) << t;
  }
}

// A platform that cannot be evaluated is left out, unless it is named; one that faces down too.
TEST_F(PlatesAlone, OfC3dFilesTheGoodOnesCount) {
  const auto load = [this](const C3dFile& file, const std::vector<std::string>& named = {}) {
    EXPECT_FALSE(WriteC3d(Path("t.c3d"), file));
    return Load([&named](Json* entry) {
      (*entry)["fps"] = 100;
      (*entry)["subjects"][0]["mass_kg"] = 700.0 / kGravity;
      (*entry)["force_plates"] = {{"use", "measure"}, {"file", "t.c3d"}};
      if (!named.empty()) (*entry)["force_plates"]["plates"] = named;
    });
  };
  C3dFile file = SampleC3d();
  file.platforms.push_back(file.platforms[0]);
  file.platforms[1].type = 5;
  const auto loaded = Unwrapped(load(file));
  EXPECT_NEAR(loaded[0].people[0].plates[5].force.z(), 700.0, 1e-2);
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_EQ(warnings_[0].text,
            "recording 'a': platform:2 has the TYPE 5; types 1 to 4 are known; it is left out");
  EXPECT_TRUE(Contains(ProblemOf(load(file, {"platform:2"})), "platform:2 has the TYPE 5"));
  file.platforms[1].type = 2;
  file.platforms[1].corners.rowwise().reverseInPlace();
  EXPECT_TRUE(load(file).ok());
  EXPECT_TRUE(Contains(warnings_.at(0).text, "platform:2 faces down"));
  file.platforms[0] = file.platforms[1];
  EXPECT_TRUE(Contains(ProblemOf(load(file)), "faces down: are up and forward right, and do COR"));
}

TEST_F(PlatesAlone, MayHaveAnotherRateAndStart) {
  const auto loaded = Load([](Json* entry) {
    (*entry)["fps"] = 50;
    (*entry)["force_plates"]["start"] = 2.5;
  });
  ASSERT_TRUE(loaded.ok()) << loaded.error().ToString();
  EXPECT_EQ(loaded.value()[0].num_frames(), 75);
  EXPECT_LT((loaded.value()[0].people[0].plates[20].centre.head<2>() - At(90).centre).norm(), 2e-4);
}

TEST_F(PlatesAlone, AreRefusedWhereTheyAreNotUnderstood) {
  EXPECT_TRUE(Contains(Problem(nullptr, false), "force plates alone (\"motion\": \"none\")"));
  EXPECT_TRUE(Contains(Problem(nullptr, false), "manifest.json:3"));
  const std::string missing = Problem([](Json* entry) {
    (*entry)["subjects"][0].erase("rod_m");
    (*entry)["subjects"][0].erase("mass_kg");
  });
  EXPECT_TRUE(Contains(missing, "rod_m"));
  EXPECT_TRUE(Contains(missing, "mass_kg"));
  EXPECT_TRUE(Contains(Problem([](Json* entry) { entry->erase("force_plates"); }), "force_plates"));
  EXPECT_TRUE(Contains(Problem([](Json* entry) { (*entry)["force_plates"]["use"] = "none"; }),
                       "needs \"use\": \"measure\""));
  EXPECT_TRUE(Contains(Problem([](Json* entry) {
                         (*entry)["motion"] = "some";
                         (*entry)["bvh"] = Json::array({"m.bvh"});
                       }),
                       "it may be \"none\""));
  EXPECT_TRUE(Contains(Problem([](Json* entry) { (*entry)["push_csv"] = "p.csv"; }),
                       "push_csv is given together with"));
  EXPECT_TRUE(Contains(Problem([](Json* entry) { (*entry)["bvh"] = Json::array({"m.bvh"}); }),
                       "bvh is given together with"));
  EXPECT_TRUE(
      Contains(Problem([](Json* entry) { (*entry)["subjects"][0]["rod_m"] = 9.0; }), "quiet.csv"));
  EXPECT_TRUE(Contains(Problem([](Json* entry) { (*entry)["force_plates"]["start"] = 9.0; }),
                       "leaves nothing after"));
}

TEST_F(PlatesAlone, AreWrittenAgain) {
  ASSERT_TRUE(Load().ok());
  const Manifest manifest = Unwrapped(ReadManifest(Path("manifest.json")));
  ASSERT_FALSE(WriteManifest(Path("again.json"), manifest));
  const Manifest again = Unwrapped(ReadManifest(Path("again.json")));
  EXPECT_TRUE(again.recordings[0].plates_alone);
  EXPECT_DOUBLE_EQ(again.recordings[0].subjects[0].rod_m, 0.9);
}

// Moments about a point below the surface, of the force on the person or on the platform.
class Moments : public PlatesAlone, public ::testing::WithParamInterface<double> {};

TEST_P(Moments, GiveTheCentreOfPressure) {
  const Eigen::Vector3d origin(0.2, -0.1, -0.04);
  std::string text = "time,l_fx,l_fy,l_fz,l_mx,l_my,l_mz\n";
  for (int row = 0; row < kRows; ++row) {
    const Pressed at = At(row);
    const Eigen::Vector3d arm = Eigen::Vector3d(at.centre[0], at.centre[1], 0.0) - origin;
    const Eigen::Vector3d moment = arm.cross(at.force) + Eigen::Vector3d(0.0, 0.0, 1.5);
    text += DoubleText(2.0 + row / kRate);
    for (double value : at.force) text += "," + DoubleText(GetParam() * value);
    for (double value : moment) text += "," + DoubleText(GetParam() * value);
    text += "\n";
  }
  WriteText("wrench.csv", text);
  const auto named = [](bool with_origin) {
    return [with_origin](Json* entry) {
      (*entry)["force_plates"]["file"] = "wrench.csv";
      if (with_origin) (*entry)["force_plates"]["origin"] = {0.2, -0.1, -0.04};
    };
  };
  const auto loaded = Unwrapped(Load(named(true)));
  const std::vector<PlateSample>& plates = loaded[0].people[0].plates;
  for (int t = 10; t + 10 < kRows; ++t) {
    EXPECT_LT((plates[t].force - At(t).force).norm(), 0.05) << t;
    EXPECT_LT((plates[t].centre.head<2>() - At(t).centre).norm(), 1e-4) << t;
  }
  EXPECT_TRUE(Contains(Problem(named(false)), "as \"origin\" of force_plates"));
  EXPECT_TRUE(Contains(Problem([&](Json* entry) {
                         named(true)(entry);
                         (*entry)["force_plates"]["origin"] = {1, 2};
                       }),
                       "origin must be three numbers"));
}
INSTANTIATE_TEST_SUITE_P(OnPersonOrPlatform, Moments, ::testing::Values(1.0, -1.0));

// Two people, each on a platform of their own.
class PlatesOfPeople : public TempDirTest {
 protected:
  Result<std::vector<Recording>> Load(const std::function<void(Json*)>& change = nullptr) {
    PlatformOptions options;
    options.model.stance = Stance::kFixed;
    options.model.push_tail = PushTail::kNone;
    options.parameters = {};
    options.parameters[kKpTheta] = options.parameters[kKpPhi] = 1250.0;
    options.parameters[kKdTheta] = options.parameters[kKdPhi] = 300.0;
    options.parameters[kComHeight] = 1.09;
    options.subjects = options.people_in_row = 2;
    options.recordings_per_subject = 1;
    options.frames = 120;
    options.lean_sigma_rad = 0.0;
    options.pushes = false;
    options.kind = GroundKind::kStep;
    options.plate_noise_m = options.plate_noise_n = 0.0;
    made_ = MakeOnPlatforms(options).value();
    EXPECT_FALSE(WriteOnPlatforms(folder_.string(), options, made_));
    Json json = Json::parse(ReadText(Path("manifest.json")));
    if (change) change(&json["recordings"][0]);
    WriteText("manifest.json", json.dump());
    return LoadRecordings(Path("manifest.json"));
  }
  std::vector<SyntheticRecording> made_;
};

TEST_F(PlatesOfPeople, GoToWhoStandsOnThem) {
  const auto loaded = Unwrapped(Load());
  for (size_t n = 0; n < 2; ++n) {
    const RecordedPerson& person = loaded[0].people[n];
    ASSERT_FALSE(person.plates.empty());
    const PlateSample& truth = made_[0].recording.people[n].plates[0];
    EXPECT_LT((person.plates[0].centre - truth.centre).norm(), 1e-3);
  }
}

// With people of one weight nothing but the place tells.
TEST_F(PlatesOfPeople, OfSomebodyElseAreRefused) {
  const auto loaded = Load([](Json* entry) {
    for (int n = 0; n < 2; ++n) (*entry)["force_plates"][n]["person"] = 1 - n;
    const double first = (*entry)["subjects"][0]["mass_kg"];
    (*entry)["subjects"][0]["mass_kg"] = (*entry)["subjects"][1]["mass_kg"];
    (*entry)["subjects"][1]["mass_kg"] = first;
  });
  ASSERT_FALSE(loaded.ok());
  EXPECT_TRUE(Contains(loaded.error().ToString(), "give force_plates the right \"person\""));
  const auto twice = Load([](Json* entry) { (*entry)["force_plates"][1].erase("person"); });
  ASSERT_FALSE(twice.ok());
  EXPECT_TRUE(Contains(twice.error().ToString(), "names person 0 twice"));
}

// The ground carries the weight on average, and no constant where somebody sways.
TEST_F(PlatesOfPeople, OfSyntheticPeopleCarryTheirWeight) {
  ASSERT_TRUE(Load().ok());
  for (const RecordedPerson& person : made_[0].recording.people) {
    double sum = 0.0, least = 1e9, most = 0.0;
    for (const PlateSample& sample : person.plates) {
      sum += sample.force.z();
      least = std::min(least, sample.force.z());
      most = std::max(most, sample.force.z());
    }
    const double weight = person.mass_kg * kGravity;
    EXPECT_NEAR(sum / static_cast<double>(person.plates.size()) / weight, 1.0, 5e-3);
    EXPECT_GT(most - least, 1e-3 * weight);
  }
}

TEST_F(PlatesOfPeople, AreInspected) {
  ASSERT_TRUE(Load().ok());
  const Inspection found = Unwrapped(Inspect(Path("manifest.json")));
  ASSERT_FALSE(found.ground.empty());
  EXPECT_EQ(found.ground[0]["kind"], "displacement");
  EXPECT_NEAR(found.ground[0]["rate_hz"].get<double>(), 60.0, 1e-6);
  EXPECT_NEAR(found.ground[0]["farthest_m"].get<double>(), 0.03, 1e-6);
  ASSERT_GE(found.plates.size(), 2u);
  EXPECT_NEAR(found.plates[1]["weight_ratio"].get<double>(), 1.0, 5e-3);
  EXPECT_EQ(found.plates[1]["platforms"], 1);
  const std::string text = InspectionText(found);
  EXPECT_TRUE(Contains(text, "displacement at 60 per second, up to 30 mm"));
  EXPECT_TRUE(Contains(text, "1 at 60 per second, measured: mean vertical force"));
  const Json json = InspectionJson(found);
  EXPECT_EQ(json["ground"][0]["kind"], "displacement");
  EXPECT_EQ(json["plates"][1]["use"], "measure");
}

}  // namespace
}  // namespace pushid
