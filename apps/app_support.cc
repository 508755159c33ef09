// apps: flags, help, exit codes, progress.
#include "apps/app_support.h"

#include <gflags/gflags.h>
#include <glog/logging.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <exception>
#include <set>
#include <vector>

#include "datasets/number_text.h"

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
  try {
    return run();
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

std::map<std::string, std::string> EffectiveFlags() {
  // What names outputs or only changes speed and talk is no part of a result.
  static const std::set<std::string> kLeftOut = {"quiet", "num_threads", "bootstrap_file",
                                                 "checkpoint_seconds"};
  std::map<std::string, std::string> flags;
  for (const gflags::CommandLineFlagInfo& flag : OwnFlags()) {
    const bool output =
        flag.name.size() >= 3 &&
        (flag.name == "out" || flag.name.compare(flag.name.size() - 3, 3, "out") == 0);
    if (!output && kLeftOut.count(flag.name) == 0) flags[flag.name] = flag.current_value;
  }
  return flags;
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
