// pushid-batch: limits, damaged results, two batches at once, kills and interruptions cost nothing
// but what they hit.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "apps/support/processes.h"
#include "tests/apps/batch_fixture.h"

namespace pushid {
namespace {

namespace fs = std::filesystem;

using BatchFaultTest = BatchFixture;

TEST_F(BatchFaultTest, ATimeLimitEndsAJobAndSaysSo) {
  const std::string endless = "\"--self_force=mlp:64\"";
  const AppRun slow = Batch(Plan("time_limit_s = 0.5", {{"slow", endless}}, "slow"));
  EXPECT_EQ(slow.exit_code, 2) << slow.err;
  EXPECT_TRUE(Contains(slow.out, "timed out after 0.5 s"));
}

TEST_F(BatchFaultTest, OneFolderThatCannotBeUsedCostsItsOwnJob) {
  const std::string good = Plan("group_by = \"subject\"", {{"a", ""}});
  const std::string id = Lines(Batch(good, {"--list"}).out)[1].substr(0, 32);  // the first job
  fs::create_directories(Path("out/jobs"));
  WriteText("out/jobs/" + id, "no folder");
  const AppRun run = Batch(good);
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_TRUE(Contains(run.out, "1 done, 1 failed, 0 done before")) << run.out;
  EXPECT_TRUE(Contains(run.err, "a job failed: " + Path("out/jobs/" + id))) << run.err;
}

TEST_F(BatchFaultTest, AWarningIsNoReason) {
  nlohmann::ordered_json json = Json(manifest_);
  json["recordings"][0]["fps"] = 61;  // warned of
  WriteText("manifest.json", json.dump(1));
  ASSERT_EQ(Batch(Plan("", {{"a", "\"--max_iterations=1\""}})).exit_code, 2);
  EXPECT_TRUE(Contains(Table("out")[1], "the fit did not converge")) << Table("out")[1];
}

// A list of recordings longer than Linux takes in one argument.
TEST_F(BatchFaultTest, LongListsOfRecordingsReachTheFit) {
  nlohmann::ordered_json json = Json(manifest_);
  const nlohmann::ordered_json one = json["recordings"][0];
  for (int i = 0; i < 600; ++i) {
    json["recordings"].push_back(one);
    json["recordings"].back()["id"] = std::string(230, 'x') + std::to_string(i);
  }
  WriteText("manifest.json", json.dump(1));
  const AppRun run = Batch(Plan("", {{"a", "\"--max_iterations=1\""}}));
  EXPECT_TRUE(Contains(run.out, "the fit did not converge")) << run.out << run.err;
}

// A job that is listed as failed is done by the next run; nothing but that job is lost.
TEST_F(BatchFaultTest, DamagedResultsCostTheirOwnJobsOnly) {
  const std::string plan = Plan("group_by = \"subject\"\nfolds = 2", {{"a", ""}});
  Succeeded(Batch(plan, {"--jobs=2"}));
  const std::vector<std::string> rows = Table("out");
  ASSERT_EQ(rows.size(), 1u + 4u);
  const auto folder = [&rows](int job) { return "out/jobs/" + rows[job].substr(0, 32); };
  const std::string model = ReadText(Path(folder(1) + "/model.json"));
  WriteText(folder(1) + "/model.json", model.substr(0, model.size() / 2));
  fs::remove(Path(folder(2) + "/scores.json"));
  WriteText(folder(3) + "/status.json", "");
  Succeeded(Batch(plan, {"--gather"}));
  EXPECT_TRUE(Contains(Table("out")[1], ",failed,"));
  EXPECT_TRUE(Contains(Table("out")[3], ",failed,"));
  EXPECT_TRUE(Contains(Table("out")[1], "model.json:"));
  EXPECT_TRUE(Contains(Table("out")[2], "scores.json: there is no such file"));
  EXPECT_TRUE(Contains(Table("out")[3], "status.json: the file is empty"));
  EXPECT_EQ(Lines(Batch(plan, {"--dry_run"}).out).size(), 2u * 3u);
  const AppRun again = Succeeded(Batch(plan));
  EXPECT_TRUE(Contains(again.out, "3 done, 0 failed, 1 done before")) << again.out;
  EXPECT_EQ(Table("out"), rows);
}

TEST_F(BatchFaultTest, TwoAtOnceInOneFolderShareTheWork) {
  const std::string plan = Plan("group_by = \"recording\"\nbootstrap = 2", {{"a", ""}});
  const std::string batch =
      "'" + std::string(PUSHID_BIN_DIR) + "/pushid-batch' '" + plan + "' --quiet --jobs=2";
  const AppRun both = RunProgram(
      "/bin/sh", {"-c", batch + " > /dev/null & " + batch + "; one=$?; wait $! && exit $one"});
  EXPECT_EQ(both.exit_code, 0) << both.out << both.err;
  const AppRun last = Batch(plan);
  EXPECT_TRUE(Contains(last.out, "0 done, 0 failed, 36 done before")) << last.out << both.err;
}

TEST_F(BatchFaultTest, AJobThatAnotherProcessHoldsIsLeftToIt) {
  const std::string plan = Plan("group_by = \"subject\"", {{"a", ""}});
  const std::string id = *Ids(Batch(plan, {"--list"}).out).begin();
  fs::create_directories(Path("out/jobs/" + id));
  const int held = open(Path("out/jobs/" + id).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  ASSERT_EQ(flock(held, LOCK_EX), 0);
  const AppRun run = Succeeded(Batch(plan));
  EXPECT_TRUE(Contains(run.out, "1 done, 0 failed, 0 done before"));
  EXPECT_TRUE(Contains(run.err, "left to another pushid-batch that is running them: 1 job;"));
  close(held);
  EXPECT_TRUE(Contains(Batch(plan).out, "1 done, 0 failed, 1 done before"));
}

// Killed outright at random moments, the batch ends with exactly the table of an unbroken run.
// PUSHID_BATCH_KILLS=100 does it a hundred times.
TEST_F(BatchFaultTest, KillsCostNothing) {
  const char* wanted = std::getenv("PUSHID_BATCH_KILLS");
  const int kills = wanted != nullptr ? std::atoi(wanted) : 5;
  const std::string jobs = "group_by = \"recording\"";
  const std::vector<std::pair<std::string, std::string>> variants = {{"a", ""}};
  Succeeded(Batch(Plan(jobs, variants, "whole", "whole.toml")));
  const std::string plan = Plan(jobs, variants, "broken", "broken.toml");
  std::mt19937 random(1);
  std::uniform_real_distribution<double> moment(0.01, 0.3);
  for (int k = 0; k < kills; ++k) {
    // Out of time: RunApp kills it.
    RunApp("pushid-batch", {plan, "--jobs=2", "--quiet"}, moment(random));
    if (k % 10 == 9) fs::remove_all(Path("broken"));  // so that there is something left to break
  }
  Succeeded(Batch(plan, {"--jobs=2"}));
  EXPECT_EQ(Table("broken"), Table("whole"));
}

TEST_F(BatchFaultTest, InterruptedItGoesOnLater) {
  const std::string plan = Plan("bootstrap = 30", {{"a", ""}});
  // "timeout -s INT" sends what Ctrl-C sends.
  const AppRun run = RunProgram("/usr/bin/timeout",
                                {"-s", "INT", std::to_string(0.5 * kSlowdown),
                                 std::string(PUSHID_BIN_DIR) + "/pushid-batch", plan, "--quiet"});
  EXPECT_EQ(run.exit_code, 124) << run.err;  // timeout's own
  EXPECT_TRUE(Contains(run.err, "run the same command to continue"));
  EXPECT_TRUE(Contains(run.out, " done, 0 failed, 0 done before"));
  EXPECT_TRUE(fs::exists(Path("out/summary.csv")));
  const int done = std::atoi(run.out.c_str() + run.out.rfind('\n', run.out.size() - 2) + 1);
  const AppRun rest = Succeeded(Batch(plan, {"--jobs=2"}));
  EXPECT_TRUE(Contains(rest.out, std::to_string(done) + " done before")) << run.out << rest.out;
  Succeeded(Batch(Plan("bootstrap = 30", {{"a", ""}}, "whole", "whole.toml"), {"--jobs=2"}));
  EXPECT_EQ(Table("out"), Table("whole"));
}

// SIGINT as "timeout -s INT" sends it, to the process and then to its group.
TEST(SignalReader, AnInterruptThatComesTwiceIsRead) {
  {
    SignalReader reader;
    raise(SIGINT);
    reader.Wait(0);
    EXPECT_TRUE(reader.interrupted());
    raise(SIGINT);
  }
  SUCCEED() << "the process is still there";
}

// Killed outright, it leaves no fit running.
TEST_F(BatchFaultTest, ChildrenDieWithTheBatch) {
  const std::string plan = Plan("", {{"endless", "\"--self_force=mlp:64\""}});
  RunApp("pushid-batch", {plan, "--quiet"}, 1.5);
  ASSERT_TRUE(fs::exists(Path("out/jobs")));
  const auto running = [this] {
    std::error_code gone;
    for (const auto& process : fs::directory_iterator("/proc", gone)) {
      const std::string command = ReadText(process.path().string() + "/cmdline");
      if (Contains(command, "--model_out=" + Path("out"))) return true;
    }
    return false;
  };
  for (int i = 0; i < 20 && running(); ++i) usleep(100000);
  EXPECT_FALSE(running());
}

}  // namespace
}  // namespace pushid
