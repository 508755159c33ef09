// apps: flags, help, and what every program does before and after its job.
#include "apps/flags/command_line.h"

#include "datasets/files/json_file.h"

#ifdef __GLIBC__
#include <malloc.h>
#include <sys/mman.h>
#endif

#include <cstring>
#include <list>
#include <set>
#include <sstream>

#include "ident/parameters/option_table.h"

DEFINE_bool(quiet, false, "suppress progress on stderr");

namespace pushid {
namespace {

using FlagInfo = gflags::CommandLineFlagInfo;

// gflags lists the flags of every library it finds; users care for ours.
std::vector<FlagInfo> OwnFlags() {
  std::vector<FlagInfo> all, own;
  gflags::GetAllFlags(&all);
  for (const FlagInfo& flag : all) {
    if (flag.filename.find("apps/") != std::string::npos) own.push_back(flag);
  }
  return own;
}

// Flags that name outputs or change only speed and messages are no part of a result.
bool IsPartOfResult(const FlagInfo& flag) {
  static const std::set<std::string> kLeftOut = {"quiet",           "num_threads", "check",
                                                 "list_parameters", "details",     "per_recording"};
  return !IsOutputFlag(flag.name) && kLeftOut.count(flag.name) == 0;
}

// The shortest text of a flag's number: gflags prints 0.2 as 0.20000000000000001.
std::string ShortestNumber(const FlagInfo& flag, const std::string& text) {
  double value = 0.0;
  return flag.type == "double" && ParseDouble(text, &value) ? DoubleText(value) : text;
}

// Flags are compared by value: a default that is given is no change, `none` over a preset's value
// is one.
bool Changed(const FlagInfo& flag) {
  double now = 0.0, before = 0.0;
  const bool numbers =
      ParseDouble(flag.current_value, &now) && ParseDouble(flag.default_value, &before);
  return numbers ? now != before : flag.current_value != flag.default_value;
}

// The headings of --help, in their order, and the files of flags below each.
struct Heading {
  const char* title;
  const char* files[2];
};
constexpr Heading kHeadings[] = {{"recordings", {"recording_flags"}},
                                 {"model", {"model_flags"}},
                                 {"fit", {}},
                                 {kRarelyChanged, {}},
                                 {"settings", {}},  // all others: the program's own
                                 {"prediction", {"observed_flags"}},
                                 {"bodies", {"restoration_flags", "postprocess_flags"}},
                                 {"output", {"overwrite_flag"}},
                                 {"general", {"command_line"}}};

std::string HeadingOf(const FlagInfo& flag) {
  if (IsOutputFlag(flag.name)) return "output";
  if (flag.name == "num_threads" || flag.name == "seed") return "general";
  const FitOptionRow* const row = FindFitOption(flag.name);
  if (row != nullptr && flag.filename.find("fit_option") != std::string::npos) return row->heading;
  const std::string file = std::filesystem::path(flag.filename).stem().string();
  for (const Heading& heading : kHeadings) {
    for (const char* of : heading.files) {
      if (of != nullptr && file == of) return heading.title;
    }
  }
  return "settings";
}

// The flags that people use most, of all programs: --help shows the first ten that a program has.
constexpr char kMostUsed[] =
    "plan jobs dry_run gather shard summary job folder pattern push_pattern push_kind masses "
    "formation model from to recordings setting more_settings id people group_size "
    "recordings_per_person push spacing sensor compare scheme kind model_out out update protocol "
    "window html_out figures_out json_out svg_out mass mapping wave restoration push_scale "
    "push_again explain profile bootstrap horizon_check design learn_forecasts folds group_by "
    "yardsticks bands per_recording details truth noise set preset fix free prior pool "
    "contrast stance seed physics published samples crossvalidate frames direction height "
    "sensor_column fps observed num_threads leave_out";
constexpr size_t kShown = 10;
constexpr size_t kHelpWidth = 100, kHelpIndent = 6, kHelpLines = 2;

// Lines of at most kHelpWidth; only the first ones of a text that is too long.
std::string Wrapped(const std::string& text, bool whole) {
  std::string wrapped;
  size_t at = 0;
  for (size_t line = 0; at < text.size(); ++line) {
    if (line == kHelpLines && !whole) return wrapped.insert(wrapped.size() - 1, " ...");
    size_t end = at + kHelpWidth - kHelpIndent - 4;
    end = end >= text.size() ? text.size() : text.rfind(' ', end);
    if (end == std::string::npos || end <= at) end = std::min(text.size(), text.find(' ', at));
    wrapped += std::string(kHelpIndent, ' ') + text.substr(at, end - at) + "\n";
    at = end + 1;
  }
  return wrapped;
}

// The flags that people use, or all, by their headings.
std::string FlagHelp(bool all) {
  const std::vector<FlagInfo> flags = OwnFlags();
  std::set<std::string> shown;
  for (const std::string& name : SplitList(kMostUsed, ' ')) {
    const auto has = [&name](const FlagInfo& flag) { return flag.name == name; };
    if (shown.size() < kShown && std::any_of(flags.begin(), flags.end(), has)) shown.insert(name);
  }
  std::map<std::string, std::string> below;
  const auto add = [&](const std::string& heading, const std::string& name,
                       const std::string& text) {
    below[heading] += "  " + name + "\n" + Wrapped(text, all);
  };
  for (const FlagInfo& flag : flags) {
    if (!all && shown.count(flag.name) == 0) continue;
    const std::string value =
        flag.default_value.empty() ? "" : "=" + ShortestNumber(flag, flag.default_value);
    add(HeadingOf(flag), "--" + flag.name + value, flag.description);
  }
  if (all) {
    add("general", "--flagfile=FILE", "read flags from a file, one per line");
    add("general", "--v=0", "1: say every step of long work, and what the solver logs");
    add("general", "--help, -h, --help=all", "print what people use, or all flags");
    add("general", "--version", "print the version");
  }
  std::string text;
  for (const Heading& heading : kHeadings) {
    const auto found = below.find(heading.title);
    if (found != below.end()) text += "\n" + std::string(heading.title) + ":\n" + found->second;
  }
  return text + (all ? ""
                     : "\n--help=all describes all " + std::to_string(flags.size()) +
                           " flags; the example works where apps/quickstart.sh has run.\n");
}

// The error names the program, and the flag that may have been meant.
Error NoSuchFlag(const std::string& name) {
  std::vector<std::string> known;
  for (const FlagInfo& flag : OwnFlags()) known.push_back(flag.name);
  std::string meant = ClosestName(name, known);
  // All outputs are suggested for "out".
  for (const std::string& one : known) {
    if (!meant.empty() && !EndsWith(meant, "_" + name)) break;
    if (EndsWith(one, "_" + name)) meant += (meant.empty() ? "" : " or --") + one;
  }
  return Error{"there is no flag --" + name + "; " +
               (meant.empty() ? "see " : "did you mean --" + meant + "? Or see ") + ProgramName() +
               " --help"};
}

bool Asked(const char* flag) {
  std::string value;
  return gflags::GetCommandLineOption(flag, &value) && value == "true";
}

// "--check" or "--check=true"
bool NamesFlag(const std::string& word) {
  if (word.rfind("--", 0) != 0) return false;
  FlagInfo flag;
  return gflags::GetCommandLineFlagInfo(word.substr(2, word.find('=') - 2).c_str(), &flag);
}

// Checks names and values before gflags sees them. `-h` becomes --help, --help=all what gflags has
// for it.
MaybeError CheckFlags(int argc, char** argv) {
  static char help[] = "--help", all[] = "--helpfull";
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "-h") == 0) argv[i] = help;
    if (std::strcmp(argv[i], "--help=all") == 0) argv[i] = all;
    const std::string word = argv[i];
    if (word == "--" || word.find("undefok") != std::string::npos) return std::nullopt;
    if (word.size() < 2 || word[0] != '-') continue;
    const size_t first = word[1] == '-' ? 2 : 1, equals = std::min(word.find('='), word.size());
    const std::string name = word.substr(first, equals - first);
    FlagInfo flag;
    if (!gflags::GetCommandLineFlagInfo(name.c_str(), &flag)) {
      const bool negated = name.rfind("no", 0) == 0 &&
                           gflags::GetCommandLineFlagInfo(name.c_str() + 2, &flag) &&
                           flag.type == "bool";
      if (negated) continue;
      return NoSuchFlag(name);
    }
    if (equals == word.size() && flag.type == "bool") continue;
    std::string value = word.substr(std::min(equals + 1, word.size()));
    if (equals == word.size()) {  // its value is the next word
      const std::string wanted = ": --" + name + "=... (" + flag.description + ")";
      if (++i == argc) return Error{"--" + name + " has no value" + wanted};
      value = argv[i];
      if (NamesFlag(value)) {
        return Error{"--" + name + " has no value, as " + value + " is a flag" + wanted};
      }
    }
    // Setting the flag checks its value; gflags will set it again.
    if (flag.type == "string" ||
        !gflags::SetCommandLineOption(name.c_str(), value.c_str()).empty()) {
      continue;
    }
    return Error{"--" + name + "=" + value + ": " + Quoted(value) + " is not " +
                 (flag.type == "double" ? "a number"
                  : flag.type == "bool" ? "true or false"
                                        : "a whole number that fits")};
  }
  return std::nullopt;
}

// A result that a full disk or a closed pipe swallowed is an error.
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

bool Given(const char* flag) { return !gflags::GetCommandLineFlagInfoOrDie(flag).is_default; }

void RefuseGiven(const std::vector<std::string>& flags, const std::string& why,
                 const std::string& file) {
  for (const std::string& flag : flags) {
    if (!Given(flag.c_str())) continue;
    const size_t place = why.find("{}");
    throw Error{
        place == std::string::npos ? "--" + flag + why : std::string(why).replace(place, 2, flag),
        file};
  }
}

void Require(const std::string& flag, const std::string& value, const std::string& what) {
  if (!value.empty()) return;
  throw Error{"--" + flag + " is missing: " + what};
}

void CheckRange(const char* flag, double value, double lowest, double highest) {
  if (value >= lowest && value <= highest) return;
  std::ostringstream text;
  text << "--" << flag << " is " << value << "; it must lie between " << lowest << " and "
       << highest;
  throw Error{text.str()};
}

std::map<std::string, std::string> EffectiveFlags() {
  std::map<std::string, std::string> flags;
  for (const FlagInfo& flag : OwnFlags()) {
    if (IsPartOfResult(flag)) flags[flag.name] = ShortestNumber(flag, flag.current_value);
  }
  return flags;
}

void WriteIfNamed(const std::string& file, const nlohmann::ordered_json& json) {
  if (!file.empty()) OrFail(WriteJson(file, json));
}

nlohmann::ordered_json ResultHead(const char* schema) {
  return {{"schema", schema}, {"version", Version()}, {"configuration", EffectiveFlags()}};
}

std::vector<std::string> ChangedFlags() {
  std::vector<std::string> names;
  for (const FlagInfo& flag : OwnFlags()) {
    if (Changed(flag) && IsPartOfResult(flag)) names.push_back(flag.name);
  }
  return names;
}

int RunApp(int argc, char** argv, const std::string& usage, int (*run)(),
           std::vector<std::string>* words) {
  SetBlasThreads(1);
  StartLog(argv[0]);
  gflags::SetUsageMessage(usage);
  gflags::SetVersionString(Version());
  if (MaybeError error = CheckFlags(argc, argv)) return Fail(*error);
  gflags::ParseCommandLineNonHelpFlags(&argc, &argv, true);
  if (FLAGS_quiet) FLAGS_minloglevel = google::GLOG_WARNING;
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
  std::vector<char**> places;  // "--flag=value", or "--flag" and the word behind it
  std::string joined;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    for (const std::string& name : {"--" + flag, "-" + flag}) {
      const bool next = word == name && i + 1 < argc;
      if (!next && word.rfind(name + "=", 0) != 0) continue;
      if (!places.empty()) joined += separator;
      places.push_back(&argv[i]);
      if (next) places.push_back(&argv[++i]);
      joined += next ? argv[i] : word.substr(name.size() + 1);
    }
  }
  static std::list<std::string> kept;  // argv only points
  for (char** place : places) *place = kept.emplace_back("--" + flag + "=" + joined).data();
}

}  // namespace pushid
