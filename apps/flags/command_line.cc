// apps: flags, help, and what every program does before and after its job.
#include "apps/flags/command_line.h"

#include <gflags/gflags.h>
#include <glog/logging.h>
#ifdef __GLIBC__
#include <malloc.h>
#include <sys/mman.h>
#endif

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <list>
#include <new>

#include "apps/support/app_support.h"
#include "apps/support/overwrite_check.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"

DEFINE_bool(quiet, false, "suppress progress on stderr");

namespace pushid {
namespace {

bool Asked(const char* flag) {
  std::string value;
  return gflags::GetCommandLineOption(flag, &value) && value == "true";
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

// "--check" or "--check=true"
bool NamesFlag(const std::string& word) {
  if (word.rfind("--", 0) != 0) return false;
  gflags::CommandLineFlagInfo flag;
  return gflags::GetCommandLineFlagInfo(word.substr(2, word.find('=') - 2).c_str(), &flag);
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
        const std::string wanted = ": --" + name + "=... (" + flag.description + ")";
        if (++i == argc) return Error{"--" + name + " has no value" + wanted};
        if (NamesFlag(argv[i])) {
          return Error{"--" + name + " has no value, as " + argv[i] + " is a flag" + wanted};
        }
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

// A fit lays out the same tables again and again. What goes back to the system in between is asked
// for and cleared anew each time, which takes 3 % of a fit of 32 recordings. Its first megabytes,
// page by page, take another tenth: they come at once, in huge pages where the system has them.
void PrepareHeap() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 64 << 20);
#if defined(MADV_HUGEPAGE) && defined(MADV_POPULATE_WRITE)
  constexpr size_t kHugePage = 2 << 20, kFirst = 4 * kHugePage;
  void* const first = std::aligned_alloc(kHugePage, kFirst);
  if (first == nullptr) return;
  for (int advice : {MADV_HUGEPAGE, MADV_POPULATE_WRITE}) madvise(first, kFirst, advice);
  std::free(first);
#endif
#endif
}

}  // namespace

int RunApp(int argc, char** argv, const std::string& usage, int (*run)(),
           std::vector<std::string>* words) {
  SetBlasThreads(1);
  SetProgramName(argv[0]);
  gflags::SetUsageMessage(usage);
  gflags::SetVersionString(Version());
  // Failures of the solver are reported by our own messages; --minloglevel=0 shows its log.
  FLAGS_minloglevel = google::GLOG_FATAL;
  FLAGS_logtostderr = true;
  if (MaybeError error = CheckFlags(argc, argv)) return Fail(*error);
  gflags::ParseCommandLineNonHelpFlags(&argc, &argv, true);
  google::InitGoogleLogging(argv[0]);
  if (FLAGS_quiet) HideProgress();
  if (Asked("help") || Asked("helpfull") || Asked("helpshort")) {
    std::printf("%s\n%s", usage.c_str(), FlagHelp(Asked("helpfull")).c_str());
    return kDone;
  }
  if (Asked("version")) {
    std::printf("%s %s\n", ProgramName().c_str(), Version().c_str());
    return kDone;
  }
  if (words != nullptr) {
    words->assign(argv + 1, argv + argc);
  } else if (argc > 1) {
    const std::string word = argv[1];
    const bool manifest = EndsWith(word, ".json") && NamesFlag("--recordings");
    return Fail("'" + word + "' is not a flag; " +
                (manifest ? "is it --recordings=" + word + "? Or see " : "see ") + ProgramName() +
                " --help");
  }
  if (MaybeError error = CheckOutputs()) return Fail(*error);
  SayWhenInterrupted("no partial file is left; run the same command to start again");
  PrepareHeap();
  try {
    return CheckPrinted(run());
  } catch (const Error& error) {
    return Fail(error);
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

}  // namespace pushid
