// apps: pushid-batch: many fits from one plan, each in a process of its own.
#include <cstdio>
#include <filesystem>
#include <map>

#include "apps/batch/batch_run.h"
#include "apps/batch/batch_summary.h"
#include "apps/batch/variant_check.h"
#include "apps/flags/batch_flags.h"
#include "apps/flags/command_line.h"
#include "apps/support/child_process.h"
#include "datasets/manifest/select_recordings.h"
#include "ident/figures/text_table.h"
#include "ident/report/page/document.h"

namespace {

using namespace pushid;

constexpr int kInterrupted = 130;  // as a shell has it

Result<std::vector<BatchJob>> ChosenJobs(const BatchFlags& flags,
                                         const std::vector<BatchJob>& all) {
  const std::vector<BatchJob> jobs = Shard(all, flags.shard, flags.shards);
  if (flags.job.empty()) return jobs;
  std::vector<BatchJob> named;
  for (const BatchJob& job : jobs) {
    if (job.id.rfind(flags.job, 0) == 0) named.push_back(job);
  }
  if (named.empty()) return Error{"--job: the plan has no job '" + flags.job + "' (see --list)"};
  return named;
}

int List(const BatchPlan& plan, const std::vector<BatchJob>& jobs) {
  TextTable table({"id", "variant", "group", "replica", "recordings", "held_out", "folder"},
                  {true, true, true, false, false, false, true});
  for (const BatchJob& job : jobs) {
    table.Add({job.id, job.variant, job.group, std::to_string(job.replica),
               std::to_string(job.recordings.size()), std::to_string(job.held_out.size()),
               JobFolder(plan, job)});
  }
  std::fputs(CsvOf(table).c_str(), stdout);
  return kDone;
}

int PrintCommands(const BatchFlags& flags, const BatchPlan& plan,
                  const std::vector<BatchJob>& jobs) {
  for (const BatchJob& job : jobs) {
    if (flags.resume && ReadResult(plan, job).done()) continue;
    const std::string folder = JobFolder(plan, job);
    std::string before = ShellText({"mkdir", "-p", folder}) + " && ";
    for (const auto& command : JobCommands(job, plan, folder, OwnFolder())) {
      std::printf("%s%s\n", before.c_str(), ShellText(command).c_str());
      before.clear();
    }
  }
  return kDone;
}

std::string TimeText(double seconds) {
  const int s = static_cast<int>(seconds + 0.5);
  if (s < 100) return std::to_string(s) + " s";
  return std::to_string(s / 60) + " min " + std::to_string(s % 60) + " s";
}

// Of all jobs of the plan, whichever of them ran now.
MaybeError ShowSummary(const BatchPlan& plan, const std::vector<BatchJob>& all) {
  const std::vector<JobResult> rows = ReadResults(plan, all);
  if (MaybeError error = WriteSummary(plan, rows)) return error;
  std::printf("%s", SummaryText(rows).c_str());
  return std::nullopt;
}

int Gather(const BatchPlan& plan, const std::vector<BatchJob>& all) {
  if (MaybeError error = ShowSummary(plan, all)) return Fail(*error);
  std::map<std::string, int> rows;
  for (const JobResult& row : ReadResults(plan, all)) ++rows[NameOf(row.status.state)];
  std::printf("%d done, %d failed, %d open; results in %s\n", rows["done"], rows["failed"],
              rows["open"], plan.dir.c_str());
  return kDone;
}

int RunJobs(const BatchFlags& flags, const BatchPlan& plan, const std::vector<BatchJob>& all,
            const std::vector<BatchJob>& jobs) {
  BatchRunOptions options;
  options.jobs = flags.jobs;
  options.resume = flags.resume;
  options.keep_going = flags.keep_going;
  options.time_limit_s = flags.time_limit_s.value_or(plan.time_limit_s);
  options.memory_limit_mb = flags.memory_limit_mb.value_or(plan.memory_limit_mb);
  options.bin = OwnFolder();
  ProgressLine line;
  const Result<BatchOutcome> outcome =
      RunBatch(plan, jobs, options, [&line](const BatchProgress& p) {
        line.Show(std::to_string(p.done) + " done, " + std::to_string(p.failed) + " failed, " +
                  std::to_string(p.left) + " left" +
                  (p.done + p.failed > 0 ? ", about " + TimeText(p.seconds_left) : ""));
      });
  line.Finish();
  if (!outcome.ok()) return Fail(outcome.error());
  const BatchOutcome& o = outcome.value();
  if (flags.summary) {
    if (MaybeError error = ShowSummary(plan, all)) return Fail(*error);
  }
  std::printf("%d done, %d failed, %d done before; results in %s\n", o.done, o.failed, o.skipped,
              plan.dir.c_str());
  if (o.elsewhere > 0) {
    Warn("left to another pushid-batch that is running them: " + std::to_string(o.elsewhere) +
         (o.elsewhere == 1 ? " job" : " jobs") +
         "; when it has finished, --gather writes the complete table");
  }
  for (const std::string& reason : o.unrecorded) Warn("a job failed: " + reason);
  if (o.interrupted) {
    std::fprintf(stderr, "pushid-batch: interrupted; run the same command to continue\n");
    return kInterrupted;
  }
  return o.failed > 0 ? kFitFailed : kDone;
}

int Run() {
  const Result<BatchFlags> read = BatchFlagsFromCommandLine();
  if (!read.ok()) return Fail(read.error());
  const BatchFlags& flags = read.value();
  const Result<BatchPlan> plan = ReadPlan(flags.plan);
  if (!plan.ok()) return Fail(plan.error());
  const Result<Manifest> manifest = ReadManifests(plan.value().manifest);
  if (!manifest.ok()) return Fail(plan.value().ErrorAt("recordings", manifest.error()));
  const Result<std::vector<BatchJob>> all = ExpandPlan(plan.value(), manifest.value());
  if (!all.ok()) return Fail(all.error());
  const Result<std::vector<BatchJob>> jobs = ChosenJobs(flags, all.value());
  if (!jobs.ok()) return Fail(jobs.error());
  if (flags.action != BatchAction::kGather) {
    const MaybeError wrong = CheckVariants(plan.value(), jobs.value(), OwnFolder());
    if (wrong) return Fail(*wrong);
  }
  switch (flags.action) {
    case BatchAction::kList:
      return List(plan.value(), jobs.value());
    case BatchAction::kPrintCommands:
      return PrintCommands(flags, plan.value(), jobs.value());
    case BatchAction::kGather:
      return Gather(plan.value(), all.value());
    case BatchAction::kRun:
      break;
  }
  return RunJobs(flags, plan.value(), all.value(), jobs.value());
}

}  // namespace

int main(int argc, char** argv) {
  return RunApp(argc, argv,
                "pushid-batch runs the fits of a plan and gathers them in one table.\n\n"
                "  pushid-batch --plan=plan.toml --jobs=2",
                Run);
}
