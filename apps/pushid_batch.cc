// apps: pushid-batch: the fits of a plan, each in its own process.
#include <map>

#include "apps/batch/batch.h"
#include "apps/flags/command_line.h"
#include "apps/support/processes.h"
#include "datasets/manifest/manifest.h"
#include "ident/figures/text_table.h"
#include "ident/report/document.h"

DEFINE_string(plan, "", "the plan (TOML); apps/README.md gives its keys");
DEFINE_bool(
    list, false,
    "only list the jobs (CSV): id, variant, group, replica, numbers of recordings fitted and "
    "held out, folder");
DEFINE_bool(dry_run, false, "only print the commands of the unfinished jobs");
DEFINE_int32(jobs, 1, "number of jobs run in parallel");
DEFINE_string(shard, "", "i/n: only every n-th job, starting with the i-th (from 1)");
DEFINE_string(job, "", "only the job with this id (or the start of its id)");
DEFINE_bool(summary, true,
            "write summary.csv and summary.json; set to false for shards that run at "
            "the same time");
DEFINE_bool(gather, false, "run nothing; only write the summary of existing results");

namespace {

using namespace pushid;

// The last line on stderr of a command that fails, without the program's name; empty if it
// succeeds.
std::string ComplaintOf(const std::vector<std::string>& command) {
  std::FILE* pipe = popen((ShellText(command) + " 2>&1 >/dev/null").c_str(), "r");
  if (pipe == nullptr) return command[0] + " cannot be started";
  std::string last = command[0] + " fails", text;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  if (pclose(pipe) == 0) return "";
  for (const std::string& line : SplitList(text, '\n')) {
    if (!line.empty()) last = line;
  }
  const std::string program = std::filesystem::path(command[0]).filename().string();
  for (const std::string& who : {program + ": error: ", std::string("ERROR: ")}) {
    if (last.rfind(who, 0) == 0) return last.substr(who.size());
  }
  return last;
}

// Checks the flags of the jobs' variants with the programs' --check before any job starts, because
// a misspelt flag would fail in every job. Errors: the program's message with the plan's line; a
// missing training program.
void CheckVariants(const BatchPlan& plan, const std::vector<BatchJob>& jobs,
                   const std::string& bin) {
  using Flags = std::vector<std::string>;
  for (const BatchVariant& variant : plan.variants) {
    const bool wanted = std::any_of(jobs.begin(), jobs.end(), [&variant](const BatchJob& job) {
      return job.variant == variant.name;
    });
    if (!wanted) continue;
    const auto wrong = [&](const std::string& what, int line) {
      return Error{"variant '" + variant.name + "': " + what, plan.path, line};
    };
    const auto check = [&](Flags command, const Flags& flags, int line) {
      command.insert(command.end(), flags.begin(), flags.end());
      const std::string complaint = ComplaintOf(command);
      if (!complaint.empty()) throw wrong(complaint, line);
    };
    check({bin + "/pushid-fit", "--check"}, variant.flags, variant.line);
    if (!variant.restoration) continue;
    const std::string trainer = bin + "/pushid-train-restoration";
    std::error_code ignored;
    if (!std::filesystem::exists(trainer, ignored)) {
      throw wrong("a restoration needs " + trainer + ", which is only built with LibTorch",
                  variant.restoration_line);
    }
    // Placeholders: each job has its own --model and --out.
    check({trainer, "--check", "--model=model.json", "--out=restoration"}, *variant.restoration,
          variant.restoration_line);
  }
}

int List(const BatchPlan& plan, const std::vector<BatchJob>& jobs) {
  TextTable table({"id", "variant", "group", ">replica", ">recordings", ">held_out", "folder"});
  for (const BatchJob& job : jobs) {
    table.Add({job.id, job.variant, job.group, std::to_string(job.replica),
               std::to_string(job.recordings.size()), std::to_string(job.held_out.size()),
               JobFolder(plan, job)});
  }
  std::fputs(CsvOf(table).c_str(), stdout);
  return kDone;
}

int PrintCommands(const BatchPlan& plan, const std::vector<BatchJob>& jobs) {
  for (const BatchJob& job : jobs) {
    if (ReadResult(plan, job).done()) continue;
    std::string before = ShellText({"mkdir", "-p", JobFolder(plan, job)}) + " && ";
    for (const auto& command : JobCommands(plan, job)) {
      std::printf("%s%s\n", before.c_str(), ShellText(command).c_str());
      before.clear();
    }
  }
  return kDone;
}

// Writes and prints the summary of all jobs of the plan.
std::vector<JobResult> ShowSummary(const BatchPlan& plan, const std::vector<BatchJob>& all) {
  std::vector<JobResult> rows = ReadResults(plan, all);
  WriteSummary(plan, rows);
  std::printf("%s", SummaryText(rows).c_str());
  return rows;
}

int Gather(const BatchPlan& plan, const std::vector<BatchJob>& all) {
  std::map<JobState, int> rows;
  for (const JobResult& row : ShowSummary(plan, all)) ++rows[row.state];
  std::printf("%d done, %d failed, %d open; results in %s\n", rows[JobState::kDone],
              rows[JobState::kFailed], rows[JobState::kOpen], plan.dir.c_str());
  return kDone;
}

int RunJobs(const BatchPlan& plan, const std::vector<BatchJob>& all,
            const std::vector<BatchJob>& jobs) {
  ProgressLine line;
  const BatchOutcome o = OrFail(RunBatch(plan, jobs, FLAGS_jobs, [&line](const BatchOutcome& p) {
    line.Show(
        std::to_string(p.done) + " done, " + std::to_string(p.failed) + " failed, " +
            std::to_string(p.left) + " left" +
            (p.done + p.failed > 0 ? ", about " + std::to_string(std::lround(p.seconds_left)) + " s"
                                   : ""),
        static_cast<double>(p.done + p.failed) / std::max(1, p.done + p.failed + p.left));
  }));
  line.Finish();
  if (FLAGS_summary) ShowSummary(plan, all);
  std::printf("%d done, %d failed, %d done before; results in %s\n", o.done, o.failed, o.skipped,
              plan.dir.c_str());
  if (o.elsewhere > 0) {
    LOG(WARNING) << "left to another pushid-batch that is running them: "
                 << CountText(o.elsewhere, "job")
                 << "; when it has finished, --gather writes the complete table";
  }
  for (const std::string& reason : o.unrecorded) LOG(WARNING) << "a job failed: " << reason;
  if (o.interrupted) return Fail("interrupted; run the same command to continue", kInterrupted);
  return o.failed > 0 ? kFitFailed : kDone;
}

int Run() {
  Require("plan", FLAGS_plan, "name the TOML file of the batch");
  int shard = 1, shards = 1;  // only every `shards`-th job, starting with number `shard`
  char rest = 0;
  if (!FLAGS_shard.empty() &&
      (std::sscanf(FLAGS_shard.c_str(), "%d/%d%c", &shard, &shards, &rest) != 2 || shard < 1 ||
       shard > shards)) {
    throw Error{"--shard is '" + FLAGS_shard + "'; write i/n with 1 <= i <= n, as in 2/4"};
  }
  if (FLAGS_jobs < 1) throw Error{"--jobs must be at least 1"};
  const BatchPlan plan = OrFail(ReadPlan(FLAGS_plan));
  const Result<Manifest> manifest = ReadManifests(plan.manifest);
  if (!manifest.ok()) return Fail(plan.ErrorAt("recordings", manifest.error()));
  const std::vector<BatchJob> all = ExpandPlan(plan, manifest.value());
  std::vector<BatchJob> jobs;
  for (const BatchJob& job : Shard(all, shard, shards)) {
    if (job.id.rfind(FLAGS_job, 0) == 0) jobs.push_back(job);
  }
  if (jobs.empty() && !FLAGS_job.empty()) {
    throw Error{"--job: the plan has no job '" + FLAGS_job + "' (see --list)"};
  }
  if (!FLAGS_gather || FLAGS_list || FLAGS_dry_run) CheckVariants(plan, jobs, OwnFolder());
  if (FLAGS_list) return List(plan, jobs);
  if (FLAGS_dry_run) return PrintCommands(plan, jobs);
  if (FLAGS_gather) return Gather(plan, all);
  return RunJobs(plan, all, jobs);
}

}  // namespace

int main(int argc, char** argv) {
  return RunApp(argc, argv,
                "pushid-batch runs the fits of a plan and collects their results in one table.\n"
                "  pushid-batch --plan=plan.toml --jobs=2",
                Run);
}
