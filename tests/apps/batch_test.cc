// pushid-batch: plans, ids, tables, what goes into a job.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "datasets/files/number_text.h"
#include "tests/apps/batch_fixture.h"

namespace pushid {
namespace {

namespace fs = std::filesystem;

using BatchTest = BatchFixture;

TEST_F(BatchTest, OneBadVariantCostsItsOwnJobsOnly) {
  const std::string plan =
      Plan("group_by = \"subject\"\nbootstrap = 1",
           {{"physics", "\"--self_force=none\""}, {"bad", "\"--lowpass_hz=1000\""}});
  const AppRun run = Batch(plan, {"--jobs=2"});
  EXPECT_EQ(run.exit_code, 2) << run.err;
  const std::vector<std::string> rows = Table("out");
  ASSERT_EQ(rows.size(), 1u + 8u);  // header; 2 subjects, 2 replicas, 2 variants
  int done = 0, failed = 0;
  for (const std::string& row : rows) {
    done += row.find(",physics,") != std::string::npos && row.find(",done,") != std::string::npos;
    failed += row.find(",bad,") != std::string::npos &&
              row.find("--lowpass_hz=1000 is too high") != std::string::npos;
  }
  EXPECT_EQ(done, 4);
  EXPECT_EQ(failed, 4);
  EXPECT_TRUE(Contains(run.out, "4 done, 4 failed, 0 done before"));
  EXPECT_EQ(Json(Path("out/summary.json"))["jobs"].size(), 8u);
  // Jobs that are done are not done again; failed ones are tried again.
  EXPECT_TRUE(Contains(Batch(plan).out, "0 done, 4 failed, 4 done before"));
  EXPECT_EQ(Table("out"), rows);
}

// A replica of a batch is the fit with --replica, and the bootstrap's, but for the weights of the
// data: the bootstrap keeps the fit's, a replica estimates its own.
TEST_F(BatchTest, ReplicasAreThoseOfTheBootstrap) {
  const std::string free = "--settling_weight=0";
  const std::string model = FitModel("model.json", {"--seed=7", free});
  Succeeded(
      RunApp("pushid-check", {"--model=" + model, Recordings(), "--bootstrap=2", "--seed=7"}));
  const nlohmann::ordered_json bootstrap = Json(model)["bootstrap"];
  size_t mu = 0;
  while (bootstrap["parameters"][mu]["name"] != "mu") ++mu;
  Batch(Plan("bootstrap = 2\nseed = 7", {{"physics", "\"" + free + "\""}}));
  const nlohmann::ordered_json summary = Json(Path("out/summary.json"));
  ASSERT_EQ(summary["jobs"].size(), 3u);
  for (int replica : {0, 1, 2}) {
    std::vector<std::string> flags = {"--seed=7", free};
    if (replica > 0) flags.push_back("--replica=" + std::to_string(replica));
    const double own = Json(FitModel("again.json", flags))["values"]["mu"].get<double>();
    EXPECT_NEAR(summary["jobs"][replica]["parameters"]["mu"]["value"].get<double>(), own,
                1e-9 * std::abs(own))
        << replica;
    bool found = replica == 0;
    for (const auto& row : bootstrap["values"]) {
      found = found || std::abs(row[mu].get<double>() / own - 1.0) < 0.01;
    }
    EXPECT_TRUE(found) << "replica " << replica << ": mu " << own;
  }
}

// Replicas are spread of the estimate they belong to, and no estimates of their own.
TEST_F(BatchTest, TheSpreadOverReplicasIsOfEachGroup) {
  const AppRun run =
      Succeeded(Batch(Plan("group_by = \"subject\"\nbootstrap = 3", {{"a", ""}}), {"--jobs=2"}));
  const nlohmann::ordered_json summary = Json(Path("out/summary.json"));
  std::map<std::string, std::vector<double>> mu;
  for (const auto& job : summary["jobs"]) {
    const double value = job["parameters"]["mu"]["value"];
    if (job["replica"] > 0) mu[job["group"]].push_back(value);
  }
  int found = 0;
  for (const auto& row : summary["bootstrap"]) {
    if (row["parameter"] != "mu") continue;
    ++found;
    const std::vector<double>& drawn = mu[row["group"]];
    ASSERT_EQ(drawn.size(), 3u);
    double mean = 0.0, squares = 0.0;
    for (double value : drawn) mean += value / 3.0;
    for (double value : drawn) squares += (value - mean) * (value - mean);
    EXPECT_NEAR(row["standard_error"].get<double>(), std::sqrt(squares / 2.0),
                1e-9 * std::abs(mean));
  }
  EXPECT_EQ(found, 2);
  EXPECT_TRUE(Contains(run.out, "bootstrap error"));
}

TEST_F(BatchTest, FoldsAreScoredOnWhatTheyHoldOut) {
  const AppRun run = Succeeded(Batch(Plan("folds = 3", {{"physics", ""}}), {"--jobs=2"}));
  const nlohmann::ordered_json jobs = Json(Path("out/summary.json"))["jobs"];
  ASSERT_EQ(jobs.size(), 3u);
  for (const auto& job : jobs) {
    EXPECT_GT(job["held_out"]["hipADE_m"].get<double>(), 0.0);
    EXPECT_LT(job["held_out"]["hipADE_m"].get<double>(), 0.1);
  }
  const std::string header = Lines(ReadText(Path("out/summary.csv")))[0];
  EXPECT_EQ(header.rfind("id,variant,group,replica,status,reason,", 0), 0u) << header;
  EXPECT_TRUE(Contains(header, "mu,"));
  EXPECT_TRUE(Contains(header, ",mu_se,"));
  EXPECT_TRUE(Contains(header,
                       ",cost,settles,held_out_hip_ade_m,held_out_hip_fde_m,warnings,"
                       "solve_s,seconds"));
  // A column is one row of the table: what the CSV has stands in the JSON.
  nlohmann::ordered_json job = jobs[0];
  job.erase("warnings");
  EXPECT_EQ(std::count(header.begin(), header.end(), ',') + 1, job.flatten().size() + 1);
  EXPECT_TRUE(Contains(run.out, "held-out hipFDE, m"));
  EXPECT_TRUE(Contains(run.out, "held-out hipADE, m"));
  EXPECT_TRUE(Contains(run.out, "3 of 3"));
}

// A variant that lost a fold is compared on the folds that both have.
TEST_F(BatchTest, FoldsAreComparedInPairs) {
  const std::string plan =
      Plan("folds = 3", {{"physics", ""}, {"linear", "\"--self_force=linear\""}});
  Succeeded(Batch(plan, {"--jobs=2"}));
  const auto jobs = Json(Path("out/summary.json"))["jobs"];
  std::map<std::string, std::vector<double>> ade;
  for (const auto& job : jobs) {
    ade[job["variant"]].push_back(job["held_out"]["hipADE_m"].get<double>());
  }
  std::filesystem::remove_all(Path("out/jobs/" + jobs.back()["id"].get<std::string>()));
  const AppRun gathered = Batch(plan, {"--gather"});
  EXPECT_TRUE(Contains(gathered.out, "2 of 3"));
  EXPECT_TRUE(Contains(gathered.out, "fold 3 of 3")) << gathered.out;
  for (const char* variant : {"physics", "linear"}) {
    const std::vector<double>& errors = ade[variant];
    EXPECT_TRUE(Contains(gathered.out, Rounded(0.5 * (errors[0] + errors[1]), 3))) << variant;
  }
}

// Held-out recordings are filtered and resampled as those that were fitted.
TEST_F(BatchTest, FoldsAreReadAlike) {
  const std::string plan = Plan(
      "folds = 2", {{"slow", "\"--lowpass_hz=6\", \"--resample_fps=30\", \"--length_unit=mm\""}});
  Succeeded(Batch(plan));
  const std::string folder = Path("out/jobs/" + *Ids(Batch(plan, {"--list"}).out).begin());
  const nlohmann::ordered_json fitted = Json(folder + "/model.json")["configuration"];
  const nlohmann::ordered_json scored = Json(folder + "/scores.json")["configuration"];
  for (const char* flag : {"lowpass_hz", "resample_fps", "length_unit", "max_gap_s"}) {
    EXPECT_EQ(fitted[flag], scored[flag]) << flag;
  }
  EXPECT_EQ(scored["resample_fps"], "30");
}

TEST_F(BatchTest, IdsFollowTheContent) {
  const std::string jobs = "group_by = \"recording\"";
  const std::string plan = Plan(jobs, {{"a", ""}, {"b", "\"--posture=upright\""}});
  const std::set<std::string> ids = Ids(Batch(plan, {"--list"}).out);
  EXPECT_EQ(ids.size(), 24u);
  // Another order, another folder: the same jobs.
  const std::string again =
      Plan(jobs, {{"b", "\"--posture=upright\""}, {"a", ""}}, "elsewhere", "again.toml");
  EXPECT_EQ(Ids(Batch(again, {"--list"}).out), ids);
  // Shards are parts of the whole, without overlap.
  std::set<std::string> parts;
  size_t total = 0;
  for (const char* shard : {"--shard=1/3", "--shard=2/3", "--shard=3/3"}) {
    const std::set<std::string> part = Ids(Batch(plan, {"--list", shard}).out);
    total += part.size();
    parts.insert(part.begin(), part.end());
  }
  EXPECT_EQ(parts, ids);
  EXPECT_EQ(total, ids.size());
  // Variants of the same flags share their jobs; no two shards do.
  const std::string twice = Plan(jobs, {{"a", ""}, {"again", ""}}, "twice", "twice.toml");
  std::set<std::string> seen;
  for (const char* shard :
       {"--shard=1/5", "--shard=2/5", "--shard=3/5", "--shard=4/5", "--shard=5/5"}) {
    for (const std::string& id : Ids(Batch(twice, {"--list", shard}).out)) {
      EXPECT_TRUE(seen.insert(id).second) << id;
    }
  }
  EXPECT_EQ(seen.size(), 12u);
  // A changed push makes new jobs of its recording, and of no other.
  const std::string push = Json(manifest_)["recordings"][0]["push_csv"];
  WriteText(push, ReadText(Path(push)) + "\n");
  const std::set<std::string> changed = Ids(Batch(plan, {"--list"}).out);
  size_t kept = 0;
  for (const std::string& id : changed) kept += ids.count(id);
  EXPECT_EQ(kept, 22u);
  // A change to what the manifest says of all its recordings makes all of them new.
  nlohmann::ordered_json json = Json(manifest_);
  json["length_unit"] = "cm";
  WriteText("manifest.json", json.dump(1));
  for (const std::string& id : Ids(Batch(plan, {"--list"}).out)) EXPECT_EQ(changed.count(id), 0u);
}

// The requests of the workflow of apps/workflow: where each job's files go, and the table alone.
TEST_F(BatchTest, ListedFoldersAreTheJobsAndGatheringRunsNothing) {
  const std::string plan = Plan("group_by = \"subject\"", {{"a, b", ""}});
  const std::vector<std::string> list = Lines(Batch(plan, {"--list"}).out);
  ASSERT_EQ(list.size(), 3u);
  EXPECT_EQ(list[0], "id,variant,group,replica,recordings,held_out,folder");
  const std::string id = list[1].substr(0, 32);
  EXPECT_EQ(list[1], id + ",\"a, b\",S01,0,6,0," + Path("out/jobs/" + id));
  EXPECT_TRUE(Refused(Batch(plan, {"--gather"}), {"out"}));  // nothing there yet
  Succeeded(Batch(plan, {"--job=" + id, "--summary=false"}));
  EXPECT_TRUE(fs::exists(Path("out/jobs/" + id + "/status.json")));
  EXPECT_FALSE(fs::exists(Path("out/summary.csv")));
  Succeeded(Batch(plan, {"--gather"}));
  const std::vector<std::string> rows = Table("out");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_TRUE(Contains(rows[1], ",done,"));
  EXPECT_TRUE(Contains(rows[2], ",open,"));
}

TEST_F(BatchTest, ADryRunIsWhatAShellTakes) {
  const std::string plan = Plan("", {{"a", ""}}, "it's out");
  const std::string command = Batch(plan, {"--dry_run"}).out;
  const std::string id = *Ids(Batch(plan, {"--list"}).out).begin();
  fs::create_directories(Path("it's out/jobs/" + id));
  Succeeded(RunProgram("/bin/sh", {"-c", command}));
  EXPECT_TRUE(fs::exists(Path("it's out/jobs/" + id + "/model.json")));
}

TEST_F(BatchTest, RecordingsMayBeLeftOut) {
  const std::string rest = "[[variant]]\nname = \"a\"\n[output]\ndir = \"out\"\n";
  const auto plan = [&](const std::string& data) {
    return "--plan=" +
           WriteText("plan.toml", "[data]\nrecordings = \"manifest.json\"\n" + data + "\n" + rest);
  };
  const std::string other = Json(manifest_)["recordings"][1]["id"];
  EXPECT_TRUE(
      Contains(Batch(plan("leave_out = [\"" + id_ + "\", \"" + other + "\"]"), {"--list"}).out,
               ",all,0,10,0,"));
  EXPECT_TRUE(Refused(Batch(plan("leave_out = [\"nobody\"]"), {"--list"}),
                      {"plan.toml:3: leave_out", "'nobody'"}));
  EXPECT_TRUE(
      Refused(Batch(plan("ids = [\"nobody\"]"), {"--list"}), {"plan.toml:3: ids", "'nobody'"}));
}

TEST_F(BatchTest, WarningsOfAFitAreInTheTable) {
  nlohmann::ordered_json json = Json(manifest_);
  json["recordings"][0]["fps"] = 61;
  WriteText("manifest.json", json.dump(1));
  Succeeded(Batch(Plan("group_by = \"subject\"", {{"a", ""}})));
  EXPECT_TRUE(Contains(Table("out")[1], "has a frame time of"));
  EXPECT_FALSE(Contains(Table("out")[2], "has a frame time of"));
  EXPECT_TRUE(Contains(Json(Path("out/summary.json"))["jobs"][0]["warnings"].dump(), "frame time"));
}

}  // namespace
}  // namespace pushid
