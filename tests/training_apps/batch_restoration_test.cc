// pushid-batch: variants that restore bodies.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/apps/batch_fixture.h"

namespace pushid {
namespace {

namespace fs = std::filesystem;

class BatchRestorationTest : public BatchFixture {
 protected:
  // Two folds; `variants` in TOML.
  std::string Plan(const std::string& variants) const {
    return "--plan=" +
           WriteText("plan.toml", "[data]\nrecordings = \"manifest.json\"\n[jobs]\nfolds = 2\n" +
                                      variants + "[output]\ndir = \"out\"\n");
  }
};

constexpr char kPhysics[] = "[[variant]]\nname = \"physics\"\nflags = []\n";
constexpr char kBodies[] =
    "[[variant]]\nname = \"bodies\"\nflags = [\"--lowpass_hz=6\"]\n"
    "restoration = [\"--kind=window\", \"--effort=0.05\", \"--postprocess=bones\"]\n";

TEST_F(BatchRestorationTest, FoldsAreScoredOnRestoredBodies) {
  const AppRun run = Succeeded(Batch(Plan(std::string(kPhysics) + kBodies), {"--jobs=2"}));
  const nlohmann::ordered_json jobs = Json(Path("out/summary.json"))["jobs"];
  ASSERT_EQ(jobs.size(), 4u);
  for (const auto& job : jobs) {
    const bool restored = job["variant"] == "bodies";
    EXPECT_EQ(job["held_out"].contains("MPJPE_m"), restored);
    EXPECT_GT(job["held_out"]["hipADE_m"].get<double>(), 0.0);
    if (!restored) continue;
    const std::string folder = Path("out/jobs/" + job["id"].get<std::string>());
    const nlohmann::ordered_json scored = Json(folder + "/scores.json");
    EXPECT_EQ(job["held_out"]["MPJPE_m"], scored["mean"]["MPJPE_m"]);
    EXPECT_EQ(scored["configuration"]["postprocess"], "bones");
    const nlohmann::ordered_json trained = Json(folder + "/restoration/restoration.json");
    EXPECT_EQ(trained["training"]["configuration"]["effort"], "0.05");
    EXPECT_EQ(trained["training"]["configuration"]["lowpass_hz"], "6");
    // What was held out was not learnt from.
    for (const auto& learnt : trained["training"]["recordings"]) {
      for (const auto& held : scored["recordings"]) EXPECT_NE(learnt["id"], held["id"]);
    }
  }
  const std::string header = Lines(ReadText(Path("out/summary.csv")))[0];
  EXPECT_TRUE(Contains(header, ",held_out_mpjpe_m,")) << header;
  EXPECT_TRUE(Contains(header, ",held_out_relative_mpjpe_m,")) << header;
  EXPECT_TRUE(Contains(run.out, "held-out MPJPE, m"));
  // The hips of both, paired; bodies of one alone.
  EXPECT_TRUE(Contains(run.out, "held-out MBLE, m"));
}

TEST_F(BatchRestorationTest, IdsFollowTheFlags) {
  const std::set<std::string> plain = Ids(Batch(Plan(kPhysics), {"--list"}).out);
  const std::string bare = "[[variant]]\nname = \"b\"\nflags = []\nrestoration = []\n";
  const std::string seeing =
      "[[variant]]\nname = \"b\"\nflags = []\nrestoration = [\"--sees=pose\"]\n";
  const std::set<std::string> window = Ids(Batch(Plan(bare), {"--list"}).out);
  const std::set<std::string> pose = Ids(Batch(Plan(seeing), {"--list"}).out);
  EXPECT_NE(plain, window);
  EXPECT_NE(window, pose);
}

TEST_F(BatchRestorationTest, WrongFlagsAreToldBeforeAnyJob) {
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"\"--knid=window\"", "there is no flag --knid"},
      {"\"--kind=bogus\"", "--kind is 'bogus'"},
      {"\"--effort=0\"", "--effort must lie above 0"},
      {"\"--postprocess=glue\"", "--postprocess names 'glue'"},
      {"\"--observed=12\"", "--observed needs --crossvalidate"},
      {"\"--crossvalidate=4\"", "--crossvalidate is set by the batch itself: set folds in [jobs]"},
      {"\"--out=here\"", "--out would be overwritten by every job"},
      {"\"window\"", "'window' is not a flag"},
      {"3", "restoration must be a list of strings"},
  };
  for (const auto& [flag, says] : wrong) {
    SCOPED_TRACE(flag);
    const AppRun run =
        Batch(Plan(std::string(kPhysics) +
                   "[[variant]]\nname = \"b\"\nflags = []\nrestoration = [" + flag + "]\n"),
              {"--list"});
    EXPECT_TRUE(Refused(run, {"plan.toml:11: ", says}));
  }
  EXPECT_FALSE(fs::exists(Path("out")));
}

TEST_F(BatchRestorationTest, AProgramThatIsNotBuiltIsNamed) {
  const fs::path bin = Path("bin");
  fs::create_directory(bin);
  fs::create_directory_symlink(fs::path(PUSHID_BIN_DIR) / "../ident",
                               Path("ident"));  // the library
  for (const char* program : {"pushid-batch", "pushid-fit"}) {
    fs::copy(fs::path(PUSHID_BIN_DIR) / program, bin / program);
  }
  const AppRun run = RunProgram((bin / "pushid-batch").string(), {Plan(kBodies), "--list"});
  EXPECT_TRUE(Refused(run, {"plan.toml:", "only built with LibTorch"}));
}

}  // namespace
}  // namespace pushid
