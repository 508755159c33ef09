// apps: messages, outputs against inputs, threads of the BLAS.
#include "apps/support/app_support.h"

#include <dlfcn.h>
#include <gflags/gflags.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <vector>

#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "datasets/manifest/manifest.h"

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

namespace {

// A share of unknown size is a mark that moves.
std::string Bar(double share, double seconds) {
  constexpr int kLength = 20, kMark = 3;
  const bool known = share >= 0.0;
  const int from = known ? 0 : static_cast<int>(4.0 * seconds) % (kLength - kMark + 1);
  const int length = known ? static_cast<int>(kLength * std::min(1.0, share)) : kMark;
  return std::string(kLength, '.').replace(from, length, length, '#');
}

}  // namespace

void ProgressLine::Show(const std::string& text, double share) {
  if (FLAGS_minloglevel > google::GLOG_INFO) return;
  const bool all = VLOG_IS_ON(1), redraws = !all && isatty(STDERR_FILENO) != 0;
  const double now = Now(), elapsed = now - begin_;
  if (!all && (elapsed < 1.0 || now - last_shown_ < (redraws ? 0.1 : 10.0))) return;
  last_shown_ = now;
  std::string line = std::to_string(static_cast<int>(elapsed)) + " s  " + text;
  if (!redraws) {
    LOG(INFO) << line;
    return;
  }
  line = "[" + Bar(share, elapsed) + "] " + line;
  const std::string padding(width_ > line.size() ? width_ - line.size() : 0, ' ');
  std::fprintf(stderr, "\r%s%s", line.c_str(), padding.c_str());
  std::fflush(stderr);
  width_ = line.size();
}

JobProgress ProgressLine::OfJobs(const std::string& what) {
  return [this, what](int done, int total) {
    Show(what + " " + std::to_string(done) + " of " + std::to_string(total),
         static_cast<double>(done) / std::max(1, total));
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
  line_.Show(text, done);
}

std::string Version() { return PUSHID_VERSION; }

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
  // Ends threads that look for work; the next product that needs them starts them again.
  auto* const end_threads = Loaded<int()>("blas_thread_shutdown_");
  if (num_threads == 1 && end_threads != nullptr) end_threads();
}

void RestartWithBlasOfProcessor(char** argv) {
#if defined(__x86_64__) && defined(__GNUC__)
  auto* const core = Loaded<const char*()>("openblas_get_corename");
  if (core == nullptr || std::getenv("OPENBLAS_CORETYPE") != nullptr) return;
  if (std::string(core()) != "Prescott" || !__builtin_cpu_supports("avx2")) return;
  setenv("OPENBLAS_CORETYPE", __builtin_cpu_supports("avx512bw") ? "SkylakeX" : "Haswell", 1);
  execv("/proc/self/exe", argv);  // where it fails, training goes on, slower
#else
  (void)argv;
#endif
}

namespace {

namespace fs = std::filesystem;

constexpr const char* kInputs[] = {"recordings", "model",    "physics",  "truth",
                                   "sensor",     "masses",   "mapping",  "generator",
                                   "plan",       "flagfile", "formation"};

// Compares files through symbolic and hard links too. A file that exists is never the same as one
// that does not.
bool Same(const std::string& a, const std::string& b) {
  std::error_code failed, unknown;
  const bool same = fs::equivalent(a, b, failed);
  if (!failed || fs::exists(a, unknown) || fs::exists(b, unknown)) return same;
  const auto whole = [](const std::string& path) {
    std::error_code ignored;
    std::string text = fs::weakly_canonical(fs::absolute(path), ignored).string();
    if (text.size() > 1 && text.back() == '/') text.pop_back();
    return text;
  };
  return whole(a) == whole(b);
}

Error BothName(const std::string& a, const std::string& b, const std::string& path) {
  return Error{a + " and " + b + " both name " + path + "; give each a file of its own"};
}

// The kind of output by the flag's name or, for pages and pictures, by its help in brackets.
struct OutputKind {
  const char *flag, *help, *ending;
};
constexpr OutputKind kKinds[] = {{"svg_out", "(SVG", ".svg"},
                                 {"html_out", "(HTML", ".html"},
                                 {"csv_out", nullptr, ".csv"},
                                 {"json_out", nullptr, ".json"}};

// name, help: of the flag.
bool Writes(const std::string& name, const std::string& help, const OutputKind& kind) {
  return EndsWith(name, kind.flag) ||
         (kind.help != nullptr && help.find(kind.help) != std::string::npos);
}

// An output's flag with its dashes, the file that it names, and the flag's help.
struct NamedOutput {
  std::string name, path, help;
};
// Flags are parsed once, so these are the same whenever they are asked for.
const std::vector<NamedOutput>& Outputs() {
  static const std::vector<NamedOutput> outputs = [] {
    std::vector<gflags::CommandLineFlagInfo> flags;
    gflags::GetAllFlags(&flags);
    std::vector<NamedOutput> named;
    for (const gflags::CommandLineFlagInfo& flag : flags) {
      if (!IsOutputFlag(flag.name) || flag.current_value.empty()) continue;
      named.push_back({"--" + flag.name, flag.current_value, flag.description});
    }
    return named;
  }();
  return outputs;
}

// Refuses, for instance, a page under the name of a picture.
MaybeError CheckKind(const NamedOutput& output) {
  for (const OutputKind& kind : kKinds) {
    if (!Writes(output.name, output.help, kind) || EndsWith(output.path, kind.ending)) continue;
    for (const OutputKind& other : kKinds) {
      if (!EndsWith(output.path, other.ending) || Writes(output.name, output.help, other)) continue;
      return Error{output.name + " writes " + kind.ending + ", but " + output.path + " ends in " +
                   other.ending};
    }
  }
  return std::nullopt;
}

// Refuses a file whose content would differ from what its name says.
MaybeError CheckEnding(const std::string& file) {
  const size_t dot = file.rfind('.');
  if (dot == std::string::npos) return std::nullopt;
  for (const char* other : {"fbx", "obj", "usd", "png", "jpg", "jpeg", "gif", "mp4", "avi", "webm",
                            "pdf", "xlsx", "xls", "mat", "h5", "pkl"}) {
    if (!EqualsIgnoringCase(file.substr(dot + 1), other)) continue;
    return Error{"no program writes ." + std::string(other) +
                     "; use .html for pages, .svg for pictures, .bvh for bodies, "
                     ".csv for tables, .json for models and scores",
                 file};
  }
  return std::nullopt;
}

}  // namespace

MaybeError CheckNotRead(const std::string& reader, const std::string& path) {
  for (const NamedOutput& output : Outputs()) {
    // pushid-check adds to the model that it reads.
    if (reader == "--model" && output.name == "--model_out") continue;
    if (Same(output.path, path)) return BothName(reader, output.name, path);
  }
  return std::nullopt;
}

MaybeError CheckOutputs() {
  const std::vector<NamedOutput>& outputs = Outputs();
  for (size_t i = 0; i < outputs.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      if (!Same(outputs[i].path, outputs[k].path)) continue;
      return BothName(outputs[k].name, outputs[i].name, outputs[i].path);
    }
  }
  for (const char* input : kInputs) {
    gflags::CommandLineFlagInfo flag;
    const bool known = gflags::GetCommandLineFlagInfo(input, &flag);
    if (!known || flag.is_default || flag.current_value.empty()) continue;
    // A formation may be a word instead of a file.
    if (flag.name == "formation" && !fs::is_regular_file(flag.current_value)) continue;
    for (const std::string& path : ManifestPaths(flag.current_value)) {
      if (MaybeError error = CheckNotRead("--" + flag.name, path)) return error;
    }
  }
  for (const NamedOutput& output : outputs) {
    if (MaybeError error = CheckKind(output)) return error;
  }
  return std::nullopt;
}

MaybeError CheckOutputFiles(std::initializer_list<std::string> files) {
  for (const std::string& file : files) {
    if (file.empty()) continue;
    if (MaybeError error = CheckEnding(file)) return error;
    if (MaybeError error = CheckWritable(file)) return error;
  }
  return std::nullopt;
}

}  // namespace pushid
