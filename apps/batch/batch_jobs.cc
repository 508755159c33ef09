// apps: expanding plans, running jobs, and reading what they left.
#include <csignal>
#include <fstream>
#include <set>

#include "apps/batch/batch.h"
#include "apps/flags/recording_flags.h"
#include "apps/support/processes.h"
#include "datasets/files/input_file.h"
#include "ident/model/model_json.h"
#include "ident/validation/crossvalidation.h"
#include "ident/validation/scores_report.h"

namespace pushid {
namespace {

// A separator that no id holds, so that "ab","c" and "a","bc" differ.
void AddPiece(const std::string& text, ContentHash* hash) {
  hash->Add(text);
  hash->Add(std::string_view("\0", 1));
}

// Adds the contents of every file that a manifest's entry names. Every text that is a file's name
// counts, whatever its key.
void HashFiles(const nlohmann::ordered_json& json, const std::string& manifest, ContentHash* hash) {
  if (json.is_structured()) {
    for (const auto& part : json) HashFiles(part, manifest, hash);
  }
  if (!json.is_string()) return;
  const std::string path = ResolvePath(manifest, json.get<std::string>());
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) AddPiece(OrFail(HashFile(path)), hash);
}

// Hash of what a manifest says about all its recordings, or about one.
std::string HashOf(const nlohmann::ordered_json& json, const std::string& manifest) {
  ContentHash hash;
  AddPiece(json.dump(), &hash);
  HashFiles(json, manifest, &hash);
  return hash.Hex();
}

std::string FlagsHash(const BatchVariant& variant) {
  ContentHash hash;
  for (const std::string& flag : variant.flags) AddPiece(flag, &hash);
  if (variant.restoration) AddPiece("restoration", &hash);
  for (const std::string& flag : variant.restoration.value_or(std::vector<std::string>{})) {
    AddPiece(flag, &hash);
  }
  return hash.Hex();
}

std::string GroupOf(const std::string& by, const ManifestRecording& entry) {
  if (by == "none") return "all";
  if (by == "recording") return entry.id;
  if (by == "subject") return entry.subjects[entry.pushed_person].id;
  return entry.labels.Of(by);
}

// A recording with all that MakeFolds looks at.
PendulumRecording AsKnown(const ManifestRecording& entry) {
  PendulumRecording recording;
  recording.id = entry.id;
  recording.labels = entry.labels;
  recording.pushed_person = entry.pushed_person;
  for (const ManifestSubject& subject : entry.subjects) {
    recording.subject_ids.push_back(subject.id);
  }
  return recording;
}

// A group's jobs as far as their recordings go: one of all, or one for each fold.
std::vector<BatchJob> FoldsOf(const BatchPlan& plan, const std::string& group,
                              const std::vector<const ManifestRecording*>& members) {
  std::vector<Fold> folds(1);
  if (plan.folds > 0) {
    std::vector<PendulumRecording> known;
    for (const ManifestRecording* entry : members) known.push_back(AsKnown(*entry));
    const auto made = MakeFolds(known, FoldScheme::kStratified, plan.folds, 1, plan.seed);
    if (!made.ok()) {
      throw plan.ErrorAt("folds", Error{"group '" + group + "' in " + std::to_string(plan.folds) +
                                        " folds: " + made.error().message});
    }
    folds = made.value();
  }
  std::vector<BatchJob> jobs;
  for (const Fold& fold : folds) {
    BatchJob& job = jobs.emplace_back();
    job.group = job.folded = group;
    if (plan.folds > 0) {
      job.group += " fold " + std::to_string(jobs.size()) + " of " + std::to_string(plan.folds);
    }
    for (int k = 0; k < static_cast<int>(members.size()); ++k) {
      const bool held =
          std::find(fold.held_out.begin(), fold.held_out.end(), k) != fold.held_out.end();
      (held ? job.held_out : job.recordings).push_back(members[k]->id);
    }
  }
  return jobs;
}

// The flags of these names.
std::vector<std::string> FlagsNamed(const std::vector<const char*>& names,
                                    const std::vector<std::string>& flags) {
  std::vector<std::string> those;
  for (const std::string& flag : flags) {
    for (const char* name : names) {
      if (flag.rfind("--" + std::string(name) + "=", 0) == 0) those.push_back(flag);
    }
  }
  return those;
}

using Command = std::vector<std::string>;

void Append(const Command& more, Command* command) {
  command->insert(command->end(), more.begin(), more.end());
}

// The flags of every program after the fit: recordings are read as the fitted ones were.
Command AfterFit(const std::string& program, const BatchJob& job, const BatchPlan& plan,
                 const std::vector<std::string>& ids, const std::string& model) {
  Command command = {program, "--model=" + model, "--recordings=" + plan.manifest,
                     "--ids=" + Joined(ids, ","), "--quiet"};
  Append(FlagsNamed({std::begin(kLoadFlags), std::end(kLoadFlags)}, job.fit_flags), &command);
  return command;
}

// The plan's recordings. Its keys are checked one by one, so that the wrong one can be named.
std::vector<int> ChosenRecordings(const BatchPlan& plan, const Manifest& manifest) {
  const auto by = [&](const char* key, const std::vector<std::string>& ids,
                      const std::vector<std::string>& leave_out) {
    const auto selected = SelectRecordings(manifest, plan.setting, ids, leave_out);
    if (!selected.ok()) throw plan.ErrorAt(key, selected.error());
    return selected.value();
  };
  by("setting", {}, {});
  by("ids", plan.ids, {});
  return by("leave_out", plan.ids, plan.leave_out);
}

}  // namespace

std::vector<BatchJob> ExpandPlan(const BatchPlan& plan, const Manifest& manifest) {
  const std::string common_hash = HashOf(*manifest.json, manifest.path);
  const std::string seed = std::to_string(plan.seed);
  std::map<std::string, std::string> hashes;  // of recordings, by id
  std::vector<std::pair<std::string, std::vector<const ManifestRecording*>>> groups;
  for (int i : ChosenRecordings(plan, manifest)) {
    const ManifestRecording& entry = manifest.recordings[i];
    hashes[entry.id] = HashOf(*entry.json, entry.manifest);
    const std::string name = GroupOf(plan.group_by, entry);
    if (name.empty()) {
      throw plan.ErrorAt("group_by",
                         Error{"must be none, recording, subject or a label; recording " +
                               Quoted(entry.id) + " has no label " + Quoted(plan.group_by)});
    }
    ValueOf(name, &groups).push_back(&entry);
  }
  std::vector<BatchJob> jobs;
  for (const BatchVariant& variant : plan.variants) {
    const std::string flags_hash = FlagsHash(variant);
    for (const auto& [name, members] : groups) {
      for (BatchJob job : FoldsOf(plan, name, members)) {
        job.variant = variant.name;
        job.restoration_flags = variant.restoration;
        if (job.restoration_flags) job.restoration_flags->push_back("--seed=" + seed);
        for (job.replica = 0; job.replica <= plan.bootstrap; ++job.replica) {
          const std::string replica = std::to_string(job.replica);
          job.fit_flags = variant.flags;
          job.fit_flags.push_back("--seed=" + seed);
          if (job.replica > 0) job.fit_flags.push_back("--replica=" + replica);
          ContentHash hash;
          for (const std::string& piece :
               {Version(), flags_hash, common_hash, seed + "/" + replica}) {
            AddPiece(piece, &hash);
          }
          for (const std::string& id : job.recordings) AddPiece(hashes[id], &hash);
          AddPiece("held out", &hash);
          for (const std::string& id : job.held_out) AddPiece(hashes[id], &hash);
          job.id = hash.Hex();
          jobs.push_back(job);
        }
      }
    }
  }
  return jobs;
}

std::string JobFolder(const BatchPlan& plan, const BatchJob& job) {
  return plan.dir + "/jobs/" + job.id;
}

std::vector<std::vector<std::string>> JobCommands(const BatchPlan& plan, const BatchJob& job) {
  const std::string folder = JobFolder(plan, job), bin = OwnFolder();
  const std::string model = folder + "/model.json", restoration = folder + "/restoration";
  Command fit = {bin + "/pushid-fit", "--recordings=" + plan.manifest,
                 "--ids=" + Joined(job.recordings, ","), "--model_out=" + model, "--quiet"};
  Append(job.fit_flags, &fit);
  std::vector<Command> commands = {fit};
  if (job.restoration_flags) {
    Command train = AfterFit(bin + "/pushid-train-restoration", job, plan, job.recordings, model);
    train.push_back("--out=" + restoration);
    Append(*job.restoration_flags, &train);
    commands.push_back(train);
  }
  if (job.held_out.empty()) return commands;
  Command evaluate = AfterFit(bin + "/pushid-evaluate", job, plan, job.held_out, model);
  evaluate.push_back("--json_out=" + folder + "/scores.json");
  if (job.restoration_flags) {
    evaluate.push_back("--restoration=" + restoration);
    Append(FlagsNamed({"postprocess"}, *job.restoration_flags), &evaluate);
  }
  commands.push_back(evaluate);
  return commands;
}

std::vector<BatchJob> Shard(const std::vector<BatchJob>& jobs, int i, int n) {
  std::vector<BatchJob> part;
  std::map<std::string, size_t> order;  // of first appearance
  for (const BatchJob& job : jobs) {
    const size_t k = order.emplace(job.id, order.size()).first->second;
    if (k % static_cast<size_t>(n) + 1 == static_cast<size_t>(i)) part.push_back(job);
  }
  return part;
}

namespace {

namespace fs = std::filesystem;

std::string StatusFile(const std::string& folder) { return folder + "/status.json"; }

// Reads how a job ended from its status.json, which is written last and whole; without one it is
// open.
//
//   {"id": "...", "variant": "physics", "group": "X05", "replica": 0, "status": "failed",
//    "reason": "...", "commands": [["pushid-fit", ...], ...], "run": {"seconds": 1.5}}
void ReadStatus(const std::string& file, JobResult* result) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return;
  const JsonDocument document = OrFail(ReadJsonDocument(file));
  JsonFields fields(document, document.content, "", "status");
  fields.Require("status", "done or failed");
  result->state = fields.Choice("status", JobState::kFailed);
  result->reason = fields.Text("reason", "why the job failed");
  if (fields.Require("run", "an object with the seconds")) {
    JsonFields run(document, fields.At("run"), fields.Pointer("run"), "status, run");
    result->seconds = run.Number("seconds", "how long the job took");
    fields.Add(run);
  }
  OrFail(fields.error());
}

void AddModel(const FitResult& fit, JobResult* result) {
  for (const Estimate& estimate : fit.estimates) {
    if (estimate.status != EstimateStatus::kFixed) result->parameters[estimate.name] = estimate;
  }
  result->cost = fit.cost;
  for (const Warning& warning : fit.warnings) result->warnings.push_back(warning.text);
  result->settles = fit.behaviour.settles;
  result->solve_s = fit.solve_seconds;
}

}  // namespace

const double* JobResult::HeldOut(MetricId metric) const {
  const auto at = std::find_if(held_out.begin(), held_out.end(),
                               [metric](const auto& score) { return score.first == metric; });
  return at == held_out.end() ? nullptr : &at->second;
}

JobResult ReadResult(const BatchPlan& plan, const BatchJob& job) {
  const std::string folder = JobFolder(plan, job), scores = folder + "/scores.json";
  JobResult result;
  result.job = &job;
  try {
    ReadStatus(StatusFile(folder), &result);
    if (!result.done()) return result;
    AddModel(OrFail(ReadFittedModel(folder + "/model.json")).fit, &result);
    if (job.held_out.empty()) return result;
    const MetricList metrics = job.restoration_flags ? kBodyMetrics : TableMetrics(0);
    const JsonDocument document = OrFail(ReadJsonDocument(scores));
    const Metrics means = OrFail(MeanMetrics(document.content, metrics, scores));
    for (MetricId m : metrics) result.held_out.emplace_back(m, means[m]);
    return result;
  } catch (const Error& error) {
    // The table shows nothing of a job whose files are not whole.
    JobResult failed;
    failed.job = &job;
    failed.state = JobState::kFailed;
    failed.reason = error.ToString();
    failed.seconds = result.seconds;
    return failed;
  }
}

namespace {

// The last line of a log that gives a reason; warnings do not count.
std::string LastLine(const std::string& path) {
  std::ifstream file(path);
  std::string last;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line.find(": warning: ") == std::string::npos) last = line;
  }
  constexpr size_t kMost = 400;
  return last.size() <= kMost ? last : last.substr(0, kMost) + "...";
}

struct Running {
  const BatchJob* job = nullptr;
  std::string folder;
  std::vector<std::vector<std::string>> commands;
  size_t step = 0;
  pid_t pid = 0;
  double begin = 0.0;  // of Now()
  bool out_of_time = false;
  FolderLock lock;
};

class Pool {
 public:
  Pool(const BatchPlan& plan, int at_once, const std::function<void(const BatchOutcome&)>& progress)
      : plan_(plan), at_once_(at_once), progress_(progress), begin_(Now()) {}

  Result<BatchOutcome> Run(const std::vector<const BatchJob*>& waiting, int skipped) {
    outcome_.skipped = skipped;
    size_t next = 0;
    while (!error_) {
      while (!signals_.interrupted() && !error_ && next < waiting.size() &&
             static_cast<int>(running_.size()) < at_once_) {
        Begin(*waiting[next++]);
      }
      outcome_.left = static_cast<int>(waiting.size() - next + running_.size());
      const int finished = outcome_.done + outcome_.failed;
      outcome_.seconds_left = finished > 0 ? (Now() - begin_) / finished * outcome_.left : 0.0;
      progress_(outcome_);
      if (signals_.interrupted() || running_.empty()) break;
      signals_.Wait(plan_.time_limit_s > 0.0 ? 50 : 500);  // ms
      Collect();
    }
    outcome_.interrupted = signals_.interrupted();
    EndAll();
    if (error_) return *error_;
    return outcome_;
  }

 private:
  void Begin(const BatchJob& job) {
    Running running;
    running.job = &job;
    running.folder = JobFolder(plan_, job);
    if (MaybeError error = MakeFolder(running.folder)) return Fail(running, error->ToString());
    const Result<bool> mine = running.lock.Take(running.folder);
    if (!mine.ok()) return Fail(running, mine.error().ToString());
    if (!mine.value()) {
      ++outcome_.elsewhere;
      return;
    }
    // Another process may have done it since this one began.
    if (ReadResult(plan_, job).done()) {
      ++outcome_.skipped;
      return;
    }
    // A job that is half-written or failed is cleared; its folder stays, because it is what is
    // locked.
    if (const MaybeError stuck = Empty(running.folder)) return Fail(running, stuck->ToString());
    running.commands = JobCommands(plan_, job);
    running.begin = Now();
    if (const MaybeError failed = Start(&running)) return Fail(running, failed->ToString());
    running_.push_back(std::move(running));
  }

  static MaybeError Empty(const std::string& folder) {
    try {
      for (const auto& entry : fs::directory_iterator(folder)) fs::remove_all(entry.path());
    } catch (const fs::filesystem_error& error) {
      return Error{"cannot be removed: " + error.code().message(), error.path1().string()};
    }
    return std::nullopt;
  }

  // Starts the job's next command.
  MaybeError Start(Running* running) {
    const ChildSpec spec{running->commands[running->step], running->folder + "/stdout.txt",
                         running->folder + "/stderr.txt"};
    const Result<pid_t> child = StartChild(spec);
    if (!child.ok()) return child.error();
    running->pid = child.value();
    return std::nullopt;
  }

  void Collect() {
    for (ChildEnd end = NextEnded(); end.pid != 0; end = NextEnded()) {
      const auto at = std::find_if(running_.begin(), running_.end(),
                                   [&end](const Running& r) { return r.pid == end.pid; });
      if (at == running_.end()) continue;
      MaybeError failed;
      if (end.exit_code == 0 && !at->out_of_time && ++at->step < at->commands.size()) {
        failed = Start(&*at);
        if (!failed) continue;
      }
      if (failed) {
        Fail(*at, failed->ToString());
      } else {
        Finish(*at, end);
      }
      running_.erase(at);
    }
    if (plan_.time_limit_s <= 0.0) return;
    for (Running& running : running_) {
      if (running.out_of_time || Now() - running.begin < plan_.time_limit_s) continue;
      running.out_of_time = true;
      KillChild(running.pid, SIGKILL);
    }
  }

  std::string ReasonOf(const Running& running, const ChildEnd& end) const {
    if (running.out_of_time) {
      return "timed out after " + DoubleText(plan_.time_limit_s) + " s";
    }
    const std::string last = LastLine(running.folder + "/stderr.txt");
    if (end.signal != 0) {
      return std::string("killed by signal ") + strsignal(end.signal) +
             (last.empty() ? "" : "; last message: " + last);
    }
    if (!last.empty()) return last;
    if (end.exit_code == 0) return running.commands[0][0] + " wrote no model.json";
    return end.exit_code == kFitFailed ? "the fit did not converge"
                                       : "exit code " + std::to_string(end.exit_code);
  }

  void Finish(const Running& running, const ChildEnd& end) {
    std::error_code ignored;
    const bool written = fs::exists(running.folder + "/model.json", ignored);
    const bool done = end.exit_code == 0 && !running.out_of_time && written;
    if (!done) return Fail(running, ReasonOf(running, end));
    if (MaybeError error = WriteStatus(running, "")) return Fail(running, error->ToString());
    ++outcome_.done;
  }

  // A failure here costs this job only, unless nothing can be written at all.
  void Fail(const Running& running, const std::string& reason) {
    ++outcome_.failed;
    if (!WriteStatus(running, reason)) return;
    outcome_.unrecorded.push_back(reason);
    CheckOutput(reason);
  }

  // Ends the batch where the failure in one job's folder would hit all of them.
  void CheckOutput(const std::string& reason) {
    const std::string probe = plan_.dir + "/jobs/.probe";
    const MaybeError nowhere = WriteFileAtomically(probe, "x");
    if (nowhere) error_ = Error{reason + "; " + nowhere->ToString()};
    std::error_code ignored;
    fs::remove(probe, ignored);
  }

  // reason: empty when it is done.
  static MaybeError WriteStatus(const Running& running, const std::string& reason) {
    const BatchJob& job = *running.job;
    const double seconds = running.commands.empty() ? 0.0 : Now() - running.begin;
    const nlohmann::ordered_json json = {
        {"schema", "pushid-job/1"},
        {"id", job.id},
        {"variant", job.variant},
        {"group", job.group},
        {"replica", job.replica},
        {"status", NameOf(reason.empty() ? JobState::kDone : JobState::kFailed)},
        {"reason", reason},
        {"commands", running.commands},
        {"run", {{"seconds", seconds}}}};
    return WriteJson(StatusFile(running.folder), json);
  }

  // Ends the running jobs, which have no status yet and will be redone.
  void EndAll() {
    for (const Running& running : running_) KillChild(running.pid, SIGKILL);
    const double begin = Now();
    while (!running_.empty() && Now() - begin < 10.0) {
      signals_.Wait(100);
      for (ChildEnd end = NextEnded(); end.pid != 0; end = NextEnded()) {
        running_.erase(std::remove_if(running_.begin(), running_.end(),
                                      [&end](const Running& r) { return r.pid == end.pid; }),
                       running_.end());
      }
    }
  }

  const BatchPlan& plan_;
  const int at_once_;
  const std::function<void(const BatchOutcome&)>& progress_;
  const double begin_;
  SignalReader signals_;
  std::vector<Running> running_;
  BatchOutcome outcome_;
  MaybeError error_;
};

}  // namespace

Result<BatchOutcome> RunBatch(const BatchPlan& plan, const std::vector<BatchJob>& jobs, int at_once,
                              const std::function<void(const BatchOutcome&)>& progress) {
  std::vector<const BatchJob*> waiting;
  std::set<std::string> seen;  // variants of the same flags share their jobs
  int skipped = 0;
  for (const BatchJob& job : jobs) {
    if (!seen.insert(job.id).second) continue;
    const bool done = ReadResult(plan, job).done();
    skipped += done;
    if (!done) waiting.push_back(&job);
  }
  return Pool(plan, at_once, progress).Run(waiting, skipped);
}

}  // namespace pushid
