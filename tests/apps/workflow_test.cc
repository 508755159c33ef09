// apps/workflow: the jobs of a plan under Snakemake, on this machine and on Slurm, end in the table
// of pushid-batch.
#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "tests/apps/batch_fixture.h"

namespace pushid {
namespace {

namespace fs = std::filesystem;

bool Installed(const std::vector<std::string>& programs) {
  for (const std::string& program : programs) {
    const AppRun run = RunProgram("/bin/sh", {"-c", "command -v " + program});
    if (run.exit_code != 0) return false;
  }
  return true;
}

bool Within(double seconds, const std::function<bool()>& holds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return true;
}

class WorkflowTest : public BatchFixture {
 protected:
  // In the test's folder, where Snakemake keeps its own files too.
  AppRun Shell(const std::string& command) const {
    return RunProgram("/bin/bash", {"-c", "cd '" + folder_.string() + "' && " + command});
  }

  static std::string Workflow() { return std::string(PUSHID_SOURCE_DIR) + "/apps/workflow"; }

  std::string Snakemake(const std::string& plan, const std::string& more) const {
    return "exec snakemake -s '" + Workflow() + "/Snakefile' --quiet --nocolor " + more +
           " --config bin='" + PUSHID_BIN_DIR + "' " + plan.substr(2);
  }

  int Finished(const std::string& dir) const {
    int finished = 0;
    std::error_code ignored;
    for (const auto& job : fs::directory_iterator(Path(dir + "/jobs"), ignored)) {
      finished += fs::exists(job.path() / "status.json");
    }
    return finished;
  }
};

TEST_F(WorkflowTest, LocallyTheSameTable) {
  if (!Installed({"snakemake"})) GTEST_SKIP() << "snakemake is not installed";
  const std::string jobs = "group_by = \"subject\"";
  const std::vector<std::pair<std::string, std::string>> variants = {
      {"a", ""}, {"same jobs", ""}, {"bad", "\"--lowpass_hz=1000\""}};
  ASSERT_EQ(Batch(Plan(jobs, variants, "whole", "whole.toml"), {"--jobs=2"}).exit_code, 2);
  const std::string plan = Plan(jobs, variants, "flow");
  Succeeded(Shell(Snakemake(plan, "-j2")));
  EXPECT_EQ(Table("flow"), Table("whole"));
  EXPECT_EQ(Table("flow").size(), 1u + 6u);
  // Its jobs are pushid-batch's: nothing that is done is done again.
  EXPECT_TRUE(Contains(Batch(plan).out, "0 done, 2 failed, 2 done before"));

  const AppRun wrong = Shell(Snakemake("--plan=none.toml", "-j1"));
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_TRUE(Contains(wrong.err, "none.toml: there is no such file"));
}

// A cluster of one node for this test alone; see slurm_node.sh.
class SlurmTest : public WorkflowTest {
 protected:
  void SetUp() override {
    if (geteuid() != 0 ||
        !Installed({"snakemake", "slurmctld", "slurmd", "sbatch", "munged", "python3"})) {
      GTEST_SKIP() << "needs root, snakemake, slurmctld, slurmd, slurm-client and munge";
    }
    WorkflowTest::SetUp();
    setenv("SLURM_CONF", Path("slurm/slurm.conf").c_str(), 1);
    node_ = std::thread([this] {
      node_run_ =
          RunProgram("/bin/bash", {std::string(PUSHID_SOURCE_DIR) + "/tests/apps/slurm_node.sh",
                                   Path("slurm"), std::to_string(getpid())});
      node_ended_ = true;
    });
    ASSERT_TRUE(Within(30.0 * kSlowdown,
                       [this] { return fs::exists(Path("slurm/ready")) || node_ended_; }));
    ASSERT_FALSE(node_ended_) << node_run_.err;
  }

  void TearDown() override {
    if (node_.joinable()) {
      WriteText("slurm/stop", "");
      node_.join();
      // Every daemon carries the folder in its arguments.
      EXPECT_NE(RunProgram("/usr/bin/pgrep",
                           {"-f", "^(/usr/sbin/)?(munged|slurmctld|slurmd|slurmstepd).*" +
                                      folder_.string()})
                    .exit_code,
                0);
    }
    WorkflowTest::TearDown();
  }

  AppRun node_run_;
  std::atomic<bool> node_ended_{false};
  std::thread node_;
};

TEST_F(SlurmTest, AKilledJobIsDoneWhenResumed) {
  // The slow one is there to be killed, a quick one runs beside it. Snakemake asks for their states
  // every ten seconds, which is most of what this test takes.
  const std::vector<std::pair<std::string, std::string>> variants = {
      {"a", ""}, {"slow", "\"--self_force=mlp:4\""}};
  const std::string plan = Plan("", variants, "flow");
  const std::vector<std::string> list = Lines(Batch(plan, {"--list"}).out);
  ASSERT_EQ(list.size(), 1u + 2u);
  const std::string slow = list[2].substr(0, 32);
  const std::string run_all = Snakemake(plan, "--profile='" + Workflow() + "/profiles/slurm'");

  AppRun broken;
  std::thread first([&] { broken = Shell(run_all); });
  const bool started = Within(
      30.0 * kSlowdown, [&] { return fs::exists(Path("flow/jobs/" + slow + "/stderr.txt")); });
  const AppRun cancelled = Shell("scancel --name=pushid-" + slow);
  first.join();
  ASSERT_TRUE(started) << broken.out << broken.err;
  EXPECT_EQ(cancelled.exit_code, 0) << cancelled.err;
  EXPECT_NE(broken.exit_code, 0) << broken.out << broken.err;
  EXPECT_FALSE(fs::exists(Path("flow/jobs/" + slow + "/status.json")));
  EXPECT_FALSE(fs::exists(Path("flow/summary.csv")));
  EXPECT_EQ(Finished("flow"), 1);  // the other did not suffer

  Succeeded(Shell(run_all));
  Succeeded(Batch(Plan("", variants, "whole", "whole.toml"), {"--jobs=2"}));
  EXPECT_EQ(Table("flow"), Table("whole"));
}

}  // namespace
}  // namespace pushid
