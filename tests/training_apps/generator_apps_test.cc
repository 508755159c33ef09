// pushid-train-generator and pushid-generate, as a user runs them.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/apps/app_fixture.h"
#include "tests/apps/browser.h"
#include "tests/mocap_support.h"

namespace pushid {
namespace {

class GeneratorAppTest : public TempDirTest {
 protected:
  void SetUp() override {
    TempDirTest::SetUp();
    WriteText("clips/skeleton.json", kSmallSkeleton);
    for (const char* action : {"sway", "bend"}) {
      for (int i = 1; i <= 3; ++i) {
        WriteText(
            std::string("clips/train/") + action + "/" + action + "_" + std::to_string(i) + ".txt",
            SmallClip(170, action[0] == 's' ? 0.3 : 0.6, i));
      }
    }
  }
  // Flags that are given later win.
  std::vector<std::string> Quick(const std::string& out,
                                 const std::vector<std::string>& more = {}) const {
    return With({"--folder=" + Path("clips"), "--out=" + Path(out), "--seeds=2", "--steps=20",
                 "--noise_steps=10", "--simlpe_steps=10", "--batch=8", "--quiet"},
                more);
  }
  AppRun Train(const std::string& out, const std::vector<std::string>& more = {}) const {
    return RunApp("pushid-train-generator", Quick(out, more));
  }
  AppRun Generate(std::vector<std::string> more) const {
    more.insert(more.end(), {"--model=" + Path("g"), "--folder=" + Path("clips"), "--quiet"});
    return RunApp("pushid-generate", more);
  }
  nlohmann::ordered_json Json(const std::string& name) const {
    return nlohmann::ordered_json::parse(ReadText(Path(name)));
  }
};

TEST_F(GeneratorAppTest, TrainsForecastsSamplesAndShows) {
  Succeeded(Train("g"));
  EXPECT_GT(Json("g/generator.json")["training"]["curve"].size(), 0u);
  const AppRun run = Succeeded(
      Generate({"--samples=19", "--json_out=" + Path("e.json"), "--action=sway", "--window=1",
                "--poses_out=" + Path("p.csv"), "--html_out=" + Path("p.html")}));
  EXPECT_TRUE(Contains(run.out, "mean of actions"));
  const auto json = Json("e.json");
  for (const char* horizon : {"80", "160", "320", "400", "1000"}) {
    EXPECT_GT(json["mean"]["MPJPE_mm"][horizon].get<double>(), 0.0);
    EXPECT_TRUE(json["actions"]["bend"]["coverage_90"].contains(horizon));
  }
  EXPECT_LT(json["mean"]["MPJPE_mm"]["80"].get<double>(),
            json["baselines"]["zero_velocity"]["mean"]["MPJPE_mm"]["80"].get<double>());
  EXPECT_TRUE(Contains(ReadText(Path("p.csv")), ",future,19,"));
  EXPECT_TRUE(Contains(ReadText(Path("p.html")), "sway, window 1"));
  EXPECT_TRUE(Contains(ReadText(Path("p.html")), "</html>"));
}

// Clips that simulate-others makes, SDE's settings, and the windows of the tables.
TEST_F(GeneratorAppTest, SdeAsPublishedOnSyntheticClips) {
  Succeeded(RunApp("simulate-others", {"--clips=2", "--frames=220", "--out=" + Path("made")}));
  for (const char* without : {"--without=", "--without=draw,protocol", "--without=gru,operator"}) {
    Succeeded(
        RunApp("pushid-train-generator", {"--published=sde", "--folder=" + Path("made"), without,
                                          "--out=" + Path("s"), "--steps=10", "--quiet"}));
    const auto settings = Json("s/generator.json")["settings"];
    EXPECT_EQ(settings["poses"], false);
    EXPECT_EQ(settings["noisy_input"], true);
    EXPECT_EQ(settings["lstm"], settings["summed"] == false);
    EXPECT_EQ(settings["members"], 1);
    EXPECT_EQ(settings["simlpe_share"], 0.0);
    const std::vector<std::string> generate = {"--published=sde", "--folder=" + Path("made"),
                                               "--model=" + Path("s"), "--samples=19",
                                               "--json_out=" + Path("e.json")};
    Succeeded(RunApp("pushid-generate", generate));
    const auto errors = Json("e.json");
    EXPECT_EQ(errors["configuration"]["published"], "sde");
    EXPECT_EQ(errors["actions"].size(), 4u);
    EXPECT_GT(errors["actions"]["walking"]["MPJPE_mm"]["1000"].get<double>(), 0.0);
  }
  std::filesystem::remove_all(Path("made/test"));
  EXPECT_TRUE(Refused(RunApp("pushid-generate", {"--published=sde", "--folder=" + Path("made"),
                                                 "--model=" + Path("s")}),
                      {"no clip of --protocol=test"}));
  Succeeded(Train("g", {"--published=sde", "--without=noise,particles,critic"}));
  EXPECT_EQ(Json("g/generator.json")["settings"]["particles"], false);
  EXPECT_TRUE(Refused(Train("g", {"--published=ode"}), {"--published is 'ode'", "sde"}));
  EXPECT_TRUE(Refused(Train("g", {"--without=bones"}), {"--without needs --published=sde"}));
  EXPECT_TRUE(Refused(Train("g", {"--published=sde", "--without=legs"}), {"names 'legs'"}));
}

// Particles hold siMLPe beside them.
TEST_F(GeneratorAppTest, SimlpeIsBlendedWith) {
  Succeeded(Train("g"));
  const auto settings = Json("g/generator.json")["settings"];
  EXPECT_EQ(settings["simlpe"]["members"], 1);
  const auto errors = [&](const std::vector<std::string>& flags) {
    Succeeded(Generate(With({"--json_out=" + Path("e.json")}, flags)));
    return Json("e.json")["mean"]["MPJPE_mm"];
  };
  const auto all = errors({}), without = errors({"--without=simlpe"});
  EXPECT_NE(all, without);
  EXPECT_NE(errors({"--without=simlpe,ridge,bones"}), without);
  EXPECT_TRUE(Refused(Generate({"--without=legs"}), {"names 'legs'"}));
  EXPECT_TRUE(Refused(Train("g", {"--simlpe_steps=0"}), {"--simlpe_steps is 0"}));
}

TEST_F(GeneratorAppTest, TheSameSeedGivesTheSameBits) {
  Succeeded(Train("g"));
  Succeeded(Train("h"));
  EXPECT_EQ(ReadText(Path("g/weights.npy")), ReadText(Path("h/weights.npy")));
  Succeeded(Generate({"--samples=19", "--json_out=" + Path("a.json")}));
  Succeeded(Generate({"--samples=19", "--json_out=" + Path("b.json")}));
  auto a = Json("a.json"), b = Json("b.json");
  a.erase("run"), b.erase("run");
  EXPECT_EQ(a, b);
}

// Moves the time, and looks whether other pixels are drawn.
constexpr char kProbe[] = R"js(  const picture = () => document.getElementById('view').toDataURL();
  const time = document.getElementById('time');
  const at = frame => { time.value = frame; time.dispatchEvent(new Event('input')); return picture(); };
  said.push('time ' + (at(10) !== at(40) ? 'moves' : 'is dead'));
  const with_futures = at(40), box =
    [...document.querySelectorAll('label')].find(l => l.textContent.includes('sampled futures')).querySelector('input');
  box.checked = false;
  box.dispatchEvent(new Event('change'));
  said.push('futures ' + (picture() !== with_futures ? 'go' : 'stay'));
  said.push('clock ' + document.getElementById('clock').textContent);
  said.push('wide ' + (document.documentElement.scrollWidth > window.innerWidth));
)js";

TEST_F(GeneratorAppTest, ThePageWorksInABrowser) {
  if (Browser().empty()) GTEST_SKIP() << "chromium is not installed";
  Succeeded(Train("g"));
  Succeeded(Generate({"--samples=19", "--html_out=" + Path("fan.html")}));
  std::string page = ReadText(Path("fan.html"));
  EXPECT_FALSE(Contains(page, "http")) << "opens from disk";
  const AppRun seen =
      Succeeded(Browse(Path("browser"), WriteText("probed.html", Probed(page, kProbe))));
  EXPECT_FALSE(Contains(seen.err, "CONSOLE")) << seen.err;
  for (const char* expected : {"time moves", "futures go", "s, frame 40", "wide false"}) {
    EXPECT_TRUE(Contains(seen.out, expected));
  }
}

TEST_F(GeneratorAppTest, SearchesAPathToAPose) {
  Succeeded(Train("g"));
  const AppRun run = Generate({"--samples=50", "--target_window=3"});
  EXPECT_TRUE(run.exit_code == 0 ? Contains(run.out, "futures end near window 3")
                                 : Contains(run.err, "raise --samples"));
}

TEST_F(GeneratorAppTest, MistakesAreNamed) {
  EXPECT_TRUE(Refused(RunApp("pushid-train-generator", {"--out=" + Path("g")}), {"--folder"}));
  EXPECT_TRUE(Refused(Train("g", {"--kind=waves"}), {"--kind is 'waves'"}));
  for (const char* flag : {"--crossvalidate=4", "--observed=2", "--pooling=none"}) {
    EXPECT_TRUE(Refused(Train("g", {flag}), {"needs --kind=diffusion"})) << flag;
  }
  WriteText("clips/train/sway/sway_2.txt", "1,2\n");
  EXPECT_TRUE(Refused(Train("g"), {"sway_2.txt:1:3", "21 numbers"}));
  EXPECT_TRUE(Refused(Generate({}), {"pushid-train-generator --out"}));
  EXPECT_TRUE(Refused(Generate({"--samples=5"}), {"--samples is 5"}));
  EXPECT_TRUE(Refused(Generate({"--target_window=3"}), {"--target_window needs --samples"}));
}

TEST_F(GeneratorAppTest, AnotherSkeletonIsRefused) {
  Succeeded(Train("g"));
  std::string skeleton = kSmallSkeleton;
  const std::string used = "\"used\": [1, 2, 3, 4]";
  WriteText("clips/skeleton.json",
            skeleton.replace(skeleton.find(used), used.size(), "\"used\": [1, 3, 4]"));
  EXPECT_TRUE(Refused(Generate({}), {"3 particles", "the 4 particles of the generator"}));
  EXPECT_TRUE(Refused(Generate({"--poses_out=" + Path("x.bvh")}), {"must end in .csv"}));
  EXPECT_TRUE(Refused(Generate({"--id=a"}), {"--id has no effect on a generator of particles"}));
}

}  // namespace
}  // namespace pushid
