// apps: what programs say on stderr.
#include "apps/support/log.h"

#include <unistd.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "datasets/loading/load_recordings.h"

namespace pushid {
namespace {

std::string g_program = "pushid";

class Stderr : public google::LogSink {
 public:
  using google::LogSink::send;
  void send(google::LogSeverity severity, const char* file, const char*, int,
            const google::LogMessageTime&, const char* message, size_t length) override {
    constexpr const char* kSeverities[] = {"", ": warning: ", ": error: ", ": fatal: "};
    if (!VLOG_IS_ON(1) && std::strstr(file, "apps/") == nullptr) return;
    const std::string who = severity == google::GLOG_INFO ? "" : g_program + kSeverities[severity];
    std::fprintf(stderr, "%s%.*s\n", who.c_str(), static_cast<int>(length), message);
  }
};

}  // namespace

void StartLog(const char* path) {
  g_program = path;
  g_program.erase(0, g_program.find_last_of('/') + 1);
  google::InitGoogleLogging(path);
  for (const google::LogSeverity severity :
       {google::GLOG_INFO, google::GLOG_WARNING, google::GLOG_ERROR, google::GLOG_FATAL}) {
    google::SetLogDestination(severity, "");  // no files
  }
  FLAGS_stderrthreshold = google::GLOG_FATAL;
  static Stderr sink;
  google::AddLogSink(&sink);
}

const std::string& ProgramName() { return g_program; }

int Fail(const std::string& message, int code) {
  LOG(ERROR) << message;
  return code;
}

int Fail(const Error& error) { return Fail(error.ToString()); }

void WarnGrouped(const Warnings& warnings) {
  for (const std::string& message : GroupedWarnings(warnings)) LOG(WARNING) << message;
}

ProgressLine::~ProgressLine() { Finish(); }

void ProgressLine::Show(const std::string& text) {
  if (FLAGS_minloglevel > google::GLOG_INFO) return;
  const bool all = VLOG_IS_ON(1), redraws = !all && isatty(STDERR_FILENO) != 0;
  const double now = Now();
  if (!all && last_shown_ >= 0.0 && now - last_shown_ < (redraws ? 0.05 : 1.0)) return;
  last_shown_ = now;
  if (!redraws) {
    LOG(INFO) << text;
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
