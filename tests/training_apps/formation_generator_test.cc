// pushid-formation --generator, as a user runs it after pushid-train-generator, and what
// is said of pushes that a generator has not learned from.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/apps/app_fixture.h"

namespace pushid {
namespace {

class FormationGeneratorTest : public AppTest {
 protected:
  AppRun Train(std::vector<std::string> more) const {
    more.insert(more.end(), {"--dataset=pushes", Recordings(), "--steps=20", "--seeds=1",
                             "--batch=2", "--observed=1", "--quiet"});
    return RunApp("pushid-train-generator", more);
  }
  // Flags that are given later win.
  AppRun Simulate(const std::vector<std::string>& more) const {
    return RunApp("pushid-formation",
                  With({"--model=" + Path("model.json"), "--formation=diamond", "--people=5",
                        "--duration=1", "--generator=" + Path("g")},
                       more));
  }
};

const std::vector<std::string> kQuick = {"--averaged=1", "--sampling_steps=2"};

TEST_F(FormationGeneratorTest, GivesTheFormationBodies) {
  FitModel();
  Succeeded(Train({"--kind=diffusion", "--out=" + Path("g")}));
  std::vector<std::string> flags = kQuick;
  flags.insert(flags.end(), {"--blend=0.5", "--people_from=" + manifest_,
                             "--html_out=" + Path("p.html"), "--strip_out=" + Path("s.svg"),
                             "--joints_out=" + Path("j.csv"), "--bodies_out=" + Path("b.bvh")});
  const AppRun run = Succeeded(Simulate(flags));
  EXPECT_TRUE(Contains(run.err, "of kind net and is applied to pushes of kind external"));
  EXPECT_TRUE(Contains(run.out, "5 recorded people in a diamond"));
  const std::string page = ReadText(Path("p.html"));
  EXPECT_TRUE(Contains(page, "bodies by diffusion"));
  EXPECT_TRUE(Contains(ReadText(Path("s.svg")), "bodies by diffusion"));
  EXPECT_TRUE(Contains(ReadText(Path("j.csv")), "\n60,"));
  EXPECT_TRUE(Contains(ReadText(Path("b_4_p04.bvh")), "HIERARCHY"));
  // Another share of physics moves the bodies, and nothing else does.
  const std::string blended = ReadText(Path("j.csv"));
  flags.push_back("--blend=0.9");
  Succeeded(Simulate(flags));
  EXPECT_NE(ReadText(Path("j.csv")), blended);
  flags.back() = "--blend=0.5";
  Succeeded(Simulate(flags));
  EXPECT_EQ(ReadText(Path("j.csv")), blended);
}

// Of recordings too: it learned from net pushes, and that is told once.
TEST_F(FormationGeneratorTest, PushesOfAnotherKindAreToldOf) {
  Succeeded(Train({"--kind=diffusion", "--out=" + Path("g")}));
  const auto generate = [&](const std::string& recordings) {
    return RunApp("pushid-generate", {"--model=" + Path("g"), recordings, "--averaged=1",
                                      "--sampling_steps=2", "--quiet"});
  };
  EXPECT_EQ(generate(Recordings()).err, "");
  const AppRun other = generate(ChangedManifest([](nlohmann::ordered_json& json) {
    for (auto& recording : json["recordings"]) recording["push_kind"] = "external";
  }));
  EXPECT_EQ(other.exit_code, 0) << other.err;
  const size_t told = other.err.find("is applied to pushes of kind external");
  EXPECT_NE(told, std::string::npos) << other.err;
  EXPECT_EQ(other.err.find("is applied", told + 20), std::string::npos) << other.err;
}

TEST_F(FormationGeneratorTest, MistakesAreNamed) {
  FitModel();
  Succeeded(Train({"--kind=diffusion", "--out=" + Path("g")}));
  Succeeded(Train({"--noise_steps=5", "--out=" + Path("particles")}));
  EXPECT_TRUE(Refused(Simulate({"--restoration=rigid"}), {"--restoration and --generator"}));
  EXPECT_TRUE(Refused(Simulate({"--postprocess=none"}), {"--postprocess needs --restoration"}));
  EXPECT_TRUE(Refused(Simulate({"--generator=", "--blend=0.5"}), {"--blend needs --generator"}));
  EXPECT_TRUE(Refused(Simulate({"--generator=", "--joints_out=" + Path("p.csv")}),
                      {"--joints_out needs bodies", "--restoration", "--generator"}));
  EXPECT_TRUE(Refused(Simulate({"--blend=1.5"}), {"--blend is 1.5"}));
  EXPECT_TRUE(Refused(Simulate({"--fps=100"}), {"trained at 60", "has 100", "--fps=60"}));
  EXPECT_TRUE(Refused(Simulate({"--generator=" + Path("none")}),
                      {Path("none"), "--generator names the folder"}));
  EXPECT_TRUE(Refused(Simulate({"--generator=" + Path("particles")}),
                      {"a generator of particles", "--kind=diffusion"}));
  EXPECT_TRUE(Refused(RunApp("pushid-simulate", {"--out=" + Path("o"), "--generator=" + Path("g")}),
                      {"no flag --generator"}));
}

}  // namespace
}  // namespace pushid
