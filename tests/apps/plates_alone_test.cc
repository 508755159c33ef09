// Somebody who stands on force plates and is seen by nothing else: a fit finds the gains.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "datasets/loading/load_recordings.h"
#include "ident/fit/fit_setup.h"
#include "tests/apps/app_fixture.h"
#include "tests/simulators/platform_files.h"

namespace pushid {
namespace {

class PlatesAloneApp : public AppTest {
 protected:
  // Three people on ground that sways, whom plates alone measure.
  std::string Simulated() {
    PlatformOptions options;
    options.subjects = 3;
    options.recordings_per_subject = 2;
    options.model.stance = Stance::kFixed;
    options.kind = GroundKind::kSumOfSines;
    options.size_m = 0.0036;
    options.pushes = false;
    options.push_kind = PushKind::kExternal;
    options.frames = 1000;
    options.fps = 50.0;
    options.joint_noise_m = 0.002;
    const auto truth = Unwrapped(SyntheticTruth(options, "Kp_theta=1600,Kd_theta=400"));
    options.model = truth.options;  // off the priors
    options.parameters = truth.parameters;
    const auto made = Unwrapped(MakeOnPlatforms(options));
    EXPECT_FALSE(WriteOnPlatforms(Path("swaying"), options, made));
    nlohmann::ordered_json json = Json(Path("swaying/manifest.json"));
    truth_ = json["synthetic"]["truth"];
    for (auto& entry : json["recordings"]) {
      for (const char* key : {"bvh", "joints", "frames", "fps"}) entry.erase(key);
      entry["motion"] = "none";
      // Joints are those of the simulation's skeletons.
      entry["subjects"][0]["rod_m"] = RodOf(entry["id"]);
    }
    return "--recordings=" + WriteText("swaying/plates.json", json.dump(1));
  }
  double RodOf(const std::string& id) {
    if (rods_.empty()) {
      const auto loaded = Unwrapped(LoadRecordings(Path("swaying/manifest.json")));
      for (const Recording& r : loaded) {
        const RecordedPerson& p = r.people[0];
        rods_[r.id] = (p.hip[0] - 0.5 * (p.left_ankle[0] + p.right_ankle[0])).norm();
      }
    }
    return rods_[id];
  }
  nlohmann::ordered_json truth_;
  std::map<std::string, double> rods_;
};

TEST_F(PlatesAloneApp, AreFittedWhereFeetStand) {
  const std::string recordings = Simulated();
  const AppRun fit = Succeeded(
      RunApp("pushid-fit", {recordings, "--stance=fixed", "--details", "--fix=Kp_phi,Kd_phi",
                            "--model_out=" + Path("plates_fit.json")}));
  EXPECT_FALSE(Contains(fit.out, "nan"));
  EXPECT_FALSE(Contains(fit.out, "The model does not fit"));
  EXPECT_FALSE(Contains(fit.out, "lag-1"));
  const auto model = Json(Path("plates_fit.json"));
  for (const char* name : {"Kp_theta", "Kd_theta"}) {
    const double truth = truth_[name], found = model["values"][name];
    EXPECT_NEAR(found / truth, 1.0, 0.1) << name;
  }
}

TEST_F(PlatesAloneApp, AreRefusedElsewhere) {
  const std::string recordings = Simulated();
  const auto told = [&](const std::string& program, const std::vector<std::string>& flags) {
    const AppRun run = RunApp(program, With({recordings}, flags));
    EXPECT_EQ(run.exit_code, 1) << program;
    return run.err;
  };
  EXPECT_TRUE(Contains(told("pushid-fit", {"--stance=slide"}), "add --stance=fixed"));
  EXPECT_TRUE(Contains(told("pushid-fit", {"--stance=fixed", "--likelihood=innovation"}),
                       "set \"use\": \"none\" there"));
  EXPECT_TRUE(Contains(told("pushid-crossvalidate", {}), "was measured by force plates alone"));
}

}  // namespace
}  // namespace pushid
