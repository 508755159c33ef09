// apps: flags, help, exit codes, progress.
#include "apps/support/app_support.h"

#include <gflags/gflags.h>
#include <glog/logging.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <set>
#include <vector>

#include "apps/support/overwrite_check.h"
#include "datasets/files/number_text.h"

DEFINE_bool(quiet, false, "no progress on stderr");

namespace pushid {
namespace {

std::string g_program = "pushid";

// gflags lists the flags of every library it finds; users care for ours.
std::vector<gflags::CommandLineFlagInfo> OwnFlags() {
  std::vector<gflags::CommandLineFlagInfo> all, own;
  gflags::GetAllFlags(&all);
  for (const gflags::CommandLineFlagInfo& flag : all) {
    if (flag.filename.find("apps/") != std::string::npos) own.push_back(flag);
  }
  return own;
}

// What names outputs or only changes speed and talk is no part of a result.
bool IsPartOfResult(const gflags::CommandLineFlagInfo& flag) {
  static const std::set<std::string> kLeftOut = {"quiet", "num_threads", "checkpoint_seconds",
                                                 "check"};
  return !IsOutputFlag(flag.name) && kLeftOut.count(flag.name) == 0;
}

// gflags prints 0.2 as 0.20000000000000001.
std::string DefaultText(const gflags::CommandLineFlagInfo& flag) {
  double value = 0.0;
  if (flag.type != "double" || !ParseDouble(flag.default_value, &value)) return flag.default_value;
  return DoubleText(value);
}

void PrintHelp(const std::string& usage) {
  std::printf("%s\n\nflags:\n", usage.c_str());
  for (const gflags::CommandLineFlagInfo& flag : OwnFlags()) {
    const std::string value = flag.default_value.empty() ? "" : "=" + DefaultText(flag);
    std::printf("  --%s%s\n      %s\n", flag.name.c_str(), value.c_str(), flag.description.c_str());
  }
  std::printf("  --flagfile=FILE\n      read flags from a file, one a line\n");
  std::printf("  --version\n      print the version\n");
}

bool Asked(const char* flag) {
  std::string value;
  return gflags::GetCommandLineOption(flag, &value) && value == "true";
}

// gflags would name neither the program nor what to do.
MaybeError CheckFlagNames(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--" || word.find("undefok") != std::string::npos) return std::nullopt;
    if (word.size() < 2 || word[0] != '-') continue;
    const size_t equals = word.find('=');
    const size_t first = word[1] == '-' ? 2 : 1;
    const std::string name =
        word.substr(first, equals == std::string::npos ? equals : equals - first);
    gflags::CommandLineFlagInfo flag;
    if (gflags::GetCommandLineFlagInfo(name.c_str(), &flag)) {
      // Its value may be the next word.
      if (flag.type != "bool" && equals == std::string::npos) ++i;
      continue;
    }
    const bool negated = name.rfind("no", 0) == 0 &&
                         gflags::GetCommandLineFlagInfo(name.c_str() + 2, &flag) &&
                         flag.type == "bool";
    if (!negated) return Error{"there is no flag --" + name + "; see " + g_program + " --help"};
  }
  return std::nullopt;
}

// A result that a full disk or a closed pipe swallowed must not look done.
int CheckPrinted(int exit_code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exit_code;
  const int failed = Fail(std::string("stdout cannot be written: ") + std::strerror(errno));
  return exit_code == kDone ? failed : exit_code;
}

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

int RunApp(int argc, char** argv, const std::string& usage, int (*run)(),
           std::vector<std::string>* words) {
  const std::string path = argv[0];
  g_program = path.substr(path.find_last_of('/') + 1);
  gflags::SetUsageMessage(usage);
  gflags::SetVersionString(PUSHID_VERSION);
  // What goes wrong inside the solver is told in our own words; --minloglevel=0 brings its log
  // back.
  FLAGS_minloglevel = google::GLOG_FATAL;
  FLAGS_logtostderr = true;
  if (MaybeError error = CheckFlagNames(argc, argv)) return Fail(*error);
  gflags::ParseCommandLineNonHelpFlags(&argc, &argv, true);
  google::InitGoogleLogging(argv[0]);
  if (Asked("help") || Asked("helpfull") || Asked("helpshort")) {
    PrintHelp(usage);
    return kDone;
  }
  if (Asked("version")) {
    std::printf("%s %s\n", g_program.c_str(), PUSHID_VERSION);
    return kDone;
  }
  if (words != nullptr) {
    words->assign(argv + 1, argv + argc);
  } else if (argc > 1) {
    return Fail("'" + std::string(argv[1]) + "' is not a flag; see " + g_program + " --help");
  }
  if (MaybeError error = CheckOutputs()) return Fail(*error);
  try {
    return CheckPrinted(run());
  } catch (const std::bad_alloc&) {
    return Fail("out of memory");
  } catch (const std::exception& exception) {
    return Fail(std::string("unexpected: ") + exception.what());
  }
}

int Fail(const Error& error) { return Fail(error.ToString()); }

int Fail(const std::string& message) {
  std::fprintf(stderr, "%s: error: %s\n", g_program.c_str(), message.c_str());
  return kBadInput;
}

void Warn(const std::string& message) {
  std::fprintf(stderr, "%s: warning: %s\n", g_program.c_str(), message.c_str());
}

MaybeError Require(const std::string& flag, const std::string& value, const std::string& what) {
  if (!value.empty()) return std::nullopt;
  return Error{"--" + flag + " is missing: " + what};
}

bool Given(const char* flag) { return !gflags::GetCommandLineFlagInfoOrDie(flag).is_default; }

std::map<std::string, std::string> EffectiveFlags() {
  std::map<std::string, std::string> flags;
  for (const gflags::CommandLineFlagInfo& flag : OwnFlags()) {
    if (IsPartOfResult(flag)) flags[flag.name] = flag.current_value;
  }
  return flags;
}

std::vector<std::string> ChangedFlags() {
  std::vector<std::string> names;
  for (const gflags::CommandLineFlagInfo& flag : OwnFlags()) {
    // By value: a default that is given is no change, `none` over a preset's value is one.
    const bool changed = flag.current_value != flag.default_value;
    if (changed && IsPartOfResult(flag)) names.push_back(flag.name);
  }
  return names;
}

std::string Version() { return PUSHID_VERSION; }

std::string HostName() {
  char name[256] = "";
  if (gethostname(name, sizeof name - 1) != 0) return "";
  return name;
}

ProgressLine::~ProgressLine() { Finish(); }

void ProgressLine::Show(const std::string& text) {
  if (FLAGS_quiet) return;
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

void ProgressLine::Finish() {
  if (width_ > 0) std::fprintf(stderr, "\r%s\r", std::string(width_, ' ').c_str());
  width_ = 0;
}

}  // namespace pushid
