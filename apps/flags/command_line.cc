// apps: flags, help, and what every program does before and after its job.
#include "apps/flags/command_line.h"

#include <gflags/gflags.h>
#include <glog/logging.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <list>
#include <new>
#include <set>
#include <sstream>

#include "apps/support/blas_threads.h"
#include "apps/support/interruption.h"
#include "apps/support/overwrite_check.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"

DEFINE_bool(quiet, false, "suppress progress on stderr");

namespace pushid {
namespace {

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
                                                 "check", "list_parameters"};
  return !IsOutputFlag(flag.name) && kLeftOut.count(flag.name) == 0;
}

// gflags prints 0.2 as 0.20000000000000001.
std::string WithoutDust(const gflags::CommandLineFlagInfo& flag, const std::string& text) {
  double value = 0.0;
  return flag.type == "double" && ParseDouble(text, &value) ? DoubleText(value) : text;
}

void PrintHelp(const std::string& usage) {
  std::printf("%s\n\nflags:\n", usage.c_str());
  for (const gflags::CommandLineFlagInfo& flag : OwnFlags()) {
    const std::string value =
        flag.default_value.empty() ? "" : "=" + WithoutDust(flag, flag.default_value);
    std::printf("  --%s%s\n      %s\n", flag.name.c_str(), value.c_str(), flag.description.c_str());
  }
  std::printf("  --flagfile=FILE\n      read flags from a file, one per line\n");
  std::printf("  --help, -h\n      print this\n");
  std::printf("  --version\n      print the version\n");
}

bool Asked(const char* flag) {
  std::string value;
  return gflags::GetCommandLineOption(flag, &value) && value == "true";
}

// gflags would name neither the program nor what to do.
Error NoSuchFlag(const std::string& name) {
  std::vector<std::string> known;
  for (const gflags::CommandLineFlagInfo& flag : OwnFlags()) known.push_back(flag.name);
  std::string meant = MeantBy(name, known);
  // "out", where several things can be written.
  for (const std::string& one : known) {
    if (!meant.empty() && !EndsWith(meant, "_" + name)) break;
    if (EndsWith(one, "_" + name)) meant += (meant.empty() ? "" : " or --") + one;
  }
  return Error{"there is no flag --" + name +
               (meant.empty() ? "" : "; did you mean --" + meant + "?") + "; see " + ProgramName() +
               " --help"};
}

// Sets the flag on the way, as gflags will again.
MaybeError CheckValue(const gflags::CommandLineFlagInfo& flag, const std::string& value) {
  if (flag.type == "string" ||
      !gflags::SetCommandLineOption(flag.name.c_str(), value.c_str()).empty()) {
    return std::nullopt;
  }
  return Error{"--" + flag.name + "=" + value + ": " + Quoted(value) + " is not " +
               (flag.type == "double" ? "a number"
                : flag.type == "bool" ? "true or false"
                                      : "a whole number that fits")};
}

// Names and values, before gflags sees them. `-h` becomes --help.
MaybeError CheckFlags(int argc, char** argv) {
  static char help[] = "--help";
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "-h") == 0) argv[i] = help;
    const std::string word = argv[i];
    if (word == "--" || word.find("undefok") != std::string::npos) return std::nullopt;
    if (word.size() < 2 || word[0] != '-') continue;
    const size_t equals = word.find('=');
    const size_t first = word[1] == '-' ? 2 : 1;
    const std::string name =
        word.substr(first, equals == std::string::npos ? equals : equals - first);
    gflags::CommandLineFlagInfo flag;
    if (gflags::GetCommandLineFlagInfo(name.c_str(), &flag)) {
      MaybeError error;
      if (equals != std::string::npos) {
        error = CheckValue(flag, word.substr(equals + 1));
      } else if (flag.type != "bool") {  // its value is the next word
        if (++i == argc) return Error{"--" + name + " has no value: --" + name + "=..."};
        error = CheckValue(flag, argv[i]);
      }
      if (error) return error;
      continue;
    }
    const bool negated = name.rfind("no", 0) == 0 &&
                         gflags::GetCommandLineFlagInfo(name.c_str() + 2, &flag) &&
                         flag.type == "bool";
    if (!negated) return NoSuchFlag(name);
  }
  return std::nullopt;
}

// A result that a full disk or a closed pipe swallowed must not look done.
int CheckPrinted(int exit_code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exit_code;
  const int failed = Fail(std::string("stdout cannot be written: ") + std::strerror(errno));
  return exit_code == kDone ? failed : exit_code;
}

}  // namespace

int RunApp(int argc, char** argv, const std::string& usage, int (*run)(),
           std::vector<std::string>* words) {
  SetBlasThreads(1);
  SetProgramName(argv[0]);
  gflags::SetUsageMessage(usage);
  gflags::SetVersionString(Version());
  // What goes wrong inside the solver is told in our own words; --minloglevel=0 brings its log
  // back.
  FLAGS_minloglevel = google::GLOG_FATAL;
  FLAGS_logtostderr = true;
  if (MaybeError error = CheckFlags(argc, argv)) return Fail(*error);
  gflags::ParseCommandLineNonHelpFlags(&argc, &argv, true);
  google::InitGoogleLogging(argv[0]);
  if (FLAGS_quiet) HideProgress();
  if (Asked("help") || Asked("helpfull") || Asked("helpshort")) {
    PrintHelp(usage);
    return kDone;
  }
  if (Asked("version")) {
    std::printf("%s %s\n", ProgramName().c_str(), Version().c_str());
    return kDone;
  }
  if (words != nullptr) {
    words->assign(argv + 1, argv + argc);
  } else if (argc > 1) {
    return Fail("'" + std::string(argv[1]) + "' is not a flag; see " + ProgramName() + " --help");
  }
  if (MaybeError error = CheckOutputs()) return Fail(*error);
  SayWhenInterrupted("no partial file is left; run the same command to start again");
  try {
    return CheckPrinted(run());
  } catch (const std::bad_alloc&) {
    return Fail("out of memory");
  } catch (const std::exception& exception) {
    return Fail(std::string("unexpected: ") + exception.what());
  }
}

void JoinRepeated(const std::string& flag, char separator, int argc, char** argv) {
  // Every occurrence gets the whole text, so that it does not matter which one counts.
  std::vector<char**> places;  // "--flag=value", or the word behind "--flag"
  std::string joined;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const size_t dashes = word.rfind("--", 0) == 0 ? 2 : 1;
    const bool next = word.substr(dashes) == flag && word[0] == '-' && i + 1 < argc;
    if (!next && (word[0] != '-' || word.compare(dashes, flag.size() + 1, flag + "=") != 0)) {
      continue;
    }
    if (next) ++i;
    places.push_back(&argv[i]);
    if (places.size() > 1) joined += separator;
    joined += next ? argv[i] : word.substr(dashes + flag.size() + 1);
  }
  static std::list<std::string> kept;  // argv only points
  for (char** place : places) {
    const bool next = **place != '-' || std::string(*place).find(flag + "=") == std::string::npos;
    *place = kept.emplace_back(next ? joined : "--" + flag + "=" + joined).data();
  }
}

MaybeError Require(const std::string& flag, const std::string& value, const std::string& what) {
  if (!value.empty()) return std::nullopt;
  return Error{"--" + flag + " is missing: " + what};
}

bool Given(const char* flag) { return !gflags::GetCommandLineFlagInfoOrDie(flag).is_default; }

std::map<std::string, std::string> EffectiveFlags() {
  std::map<std::string, std::string> flags;
  for (const gflags::CommandLineFlagInfo& flag : OwnFlags()) {
    if (IsPartOfResult(flag)) flags[flag.name] = WithoutDust(flag, flag.current_value);
  }
  return flags;
}

std::vector<std::string> ChangedFlags() {
  std::vector<std::string> names;
  for (const gflags::CommandLineFlagInfo& flag : OwnFlags()) {
    // By value: a default that is given is no change, `none` over a preset's value is one.
    double now = 0.0, before = 0.0;
    const bool numbers =
        ParseDouble(flag.current_value, &now) && ParseDouble(flag.default_value, &before);
    const bool changed = numbers ? now != before : flag.current_value != flag.default_value;
    if (changed && IsPartOfResult(flag)) names.push_back(flag.name);
  }
  return names;
}

MaybeError CheckRange(const char* flag, double value, double lowest, double highest) {
  if (value >= lowest && value <= highest) return std::nullopt;
  std::ostringstream text;
  text << "--" << flag << " is " << value << "; it must lie between " << lowest << " and "
       << highest;
  return Error{text.str()};
}

namespace {

// A file that would hold something else than its name says.
MaybeError CheckEnding(const std::string& file) {
  const size_t dot = file.rfind('.');
  if (dot == std::string::npos) return std::nullopt;
  for (const char* other : {"fbx", "obj", "usd", "png", "jpg", "jpeg", "gif", "mp4", "avi", "webm",
                            "pdf", "xlsx", "xls", "mat", "h5", "pkl"}) {
    if (!EqualsIgnoringCase(file.substr(dot + 1), other)) continue;
    return Error{"no program writes ." + std::string(other) +
                     "; use .html for pages, .svg for pictures, .bvh, .gltf or .glb for bodies, "
                     ".csv for tables, .json for models and scores",
                 file};
  }
  return std::nullopt;
}

}  // namespace

MaybeError CheckOutputFiles(std::initializer_list<std::string> files) {
  for (const std::string& file : files) {
    if (file.empty()) continue;
    if (MaybeError error = CheckEnding(file)) return error;
    if (MaybeError error = CheckWritable(file)) return error;
  }
  return std::nullopt;
}

}  // namespace pushid
