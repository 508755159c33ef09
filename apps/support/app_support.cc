// apps: exit codes, errors and warnings, progress.
#include "apps/support/app_support.h"

#include <dlfcn.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include "datasets/files/json_file.h"
#include "datasets/loading/load_recordings.h"
#include "ident/model/model_json.h"

namespace pushid {
namespace {

std::string g_program = "pushid";
bool g_show_progress = true;

}  // namespace

void SetProgramName(const std::string& path) {
  g_program = path.substr(path.find_last_of('/') + 1);
}

const std::string& ProgramName() { return g_program; }

int Fail(const Error& error) { return Fail(error.ToString()); }

int Fail(const std::string& message) {
  std::fprintf(stderr, "%s: error: %s\n", g_program.c_str(), message.c_str());
  return kBadInput;
}

void Warn(const std::string& message) {
  std::fprintf(stderr, "%s: warning: %s\n", g_program.c_str(), message.c_str());
}

void WarnGrouped(const Warnings& warnings) {
  for (const std::string& message : GroupedWarnings(warnings)) Warn(message);
}

std::string Version() { return PUSHID_VERSION; }

MaybeError WriteModelFile(const std::string& path, const FittedModel& model, int num_threads,
                          double begin) {
  RunInfo run;
  char date[32];
  const std::time_t now = std::time(nullptr);
  std::strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
  run.date = date;
  char host[256] = "";
  if (gethostname(host, sizeof host - 1) == 0) run.host = host;
  run.model_path = path;
  run.num_threads = num_threads;
  run.total_seconds = Now() - begin;
  return WriteJson(path, ToJson(model, run));
}

void HideProgress() { g_show_progress = false; }

ProgressLine::~ProgressLine() { Finish(); }

void ProgressLine::Show(const std::string& text) {
  if (!g_show_progress) return;
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const double now = Now();
  if (last_shown_ >= 0.0 && now - last_shown_ < (terminal ? 0.05 : 1.0)) return;
  last_shown_ = now;
  if (!terminal) {
    std::fprintf(stderr, "%s\n", text.c_str());
    return;
  }
  const std::string padding(width_ > text.size() ? width_ - text.size() : 0, ' ');
  std::fprintf(stderr, "\r%s%s", text.c_str(), padding.c_str());
  std::fflush(stderr);
  width_ = text.size();
}

JobProgress ProgressLine::OfJobs(const std::string& what) {
  return [this, what](int done, int total) {
    Show(what + " " + std::to_string(done) + " of " + std::to_string(total));
  };
}

void ProgressLine::Finish() {
  if (width_ > 0) std::fprintf(stderr, "\r%s\r", std::string(width_, ' ').c_str());
  width_ = 0;
}

namespace {

// A handler may neither allocate nor lock: the message stands ready. Old ones are kept, as the
// signal may come while one is replaced; there are three at most.
std::atomic<const char*> g_message{nullptr};

void End(int) {
  const char* message = g_message.load();
  const ssize_t ignored = write(STDERR_FILENO, message, std::strlen(message));
  static_cast<void>(ignored);
  _exit(kInterrupted);
}

}  // namespace

void SayWhenInterrupted(const std::string& what) {
  const auto* text = new std::string("\n" + ProgramName() + ": interrupted; " + what + "\n");
  g_message.store(text->c_str());
  struct sigaction ending = {};
  ending.sa_handler = End;
  sigaction(SIGINT, &ending, nullptr);
}

namespace {

template <typename Function>
Function* Loaded(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

}  // namespace

void SetBlasThreads(int num_threads) {
  auto* const set = Loaded<void(int)>("openblas_set_num_threads");
  if (set == nullptr || std::getenv("OPENBLAS_NUM_THREADS") != nullptr) return;
  set(num_threads);
  // Ends those that look for work; the next product that wants them starts them again.
  auto* const end_threads = Loaded<int()>("blas_thread_shutdown_");
  if (num_threads == 1 && end_threads != nullptr) end_threads();
}

std::string KeptCheckpoints(const std::string& folder) {
  return "the last checkpoint is in " + folder + ", and the same command continues from there";
}

TrainingLine::TrainingLine() : made_(Now()) {}

double TrainingLine::Seconds() const { return Now() - made_; }

void TrainingLine::Show(const std::string& step, double done) {
  const std::string name = step.substr(0, step.rfind(' '));
  if (name != step_) step_ = name, start_ = Now(), done_at_start_ = done;
  std::string text =
      step + ": " + std::to_string(static_cast<int>(std::lround(100.0 * done))) + " %";
  const double gained = done - done_at_start_;
  if (gained > 0.0) {
    const double left = (Now() - start_) / gained * (1.0 - done);
    text += ", " + std::to_string(static_cast<int>(std::lround(left))) + " s left";
  }
  line_.Show(text);
}

}  // namespace pushid
