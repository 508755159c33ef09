// apps: fork, exec, signals.
#include "apps/support/processes.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "datasets/files/atomic_file.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

constexpr int kCannotStart = 127;
constexpr std::size_t kLongestArgument = 128 * 1024 - 1;  // Linux: MAX_ARG_STRLEN

// Runs between fork and exec, where only some calls are safe.
[[noreturn]] void RunInChild(char* const* argv, pid_t parent, int out, int err) {
  setpgid(0, 0);  // so that a terminal's Ctrl-C reaches the batch alone
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(kCannotStart);  // it died before that was asked for
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  sigset_t none;  // the parent's mask would be inherited
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  execv(argv[0], argv);
  dprintf(STDERR_FILENO, "%s cannot be started: %s\n", argv[0], std::strerror(errno));
  _exit(kCannotStart);
}

// A longer flag is passed by a file beside the outputs, --flagfile.
Result<std::vector<std::string>> Shortened(const ChildSpec& spec) {
  std::vector<std::string> words = spec.command;
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i].size() < kLongestArgument) continue;
    const std::string file = spec.out + "." + std::to_string(i) + ".flags";
    if (MaybeError failed = WriteFileAtomically(file, words[i] + "\n")) return *failed;
    words[i] = "--flagfile=" + file;
  }
  return words;
}

}  // namespace

Result<pid_t> StartChild(const ChildSpec& spec) {
  if (access(spec.command[0].c_str(), X_OK) != 0) {
    return Error{"cannot be run: " + std::string(std::strerror(errno)), spec.command[0]};
  }
  Result<std::vector<std::string>> words = Shortened(spec);
  if (!words.ok()) return words.error();
  std::vector<char*> argv;
  for (std::string& word : words.value()) argv.push_back(word.data());
  argv.push_back(nullptr);
  const int flags = O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC;
  const int out = open(spec.out.c_str(), flags, 0644);
  const int err = out < 0 ? -1 : open(spec.err.c_str(), flags, 0644);
  const bool opened = err >= 0;
  const pid_t parent = getpid();
  const pid_t child = opened ? fork() : -1;
  if (child == 0) RunInChild(argv.data(), parent, out, err);
  const std::string reason = std::strerror(errno);
  if (out >= 0) close(out);
  if (err >= 0) close(err);
  if (!opened) return Error{"cannot be written: " + reason, out < 0 ? spec.out : spec.err};
  if (child < 0) return Error{"no process can be started: " + reason};
  setpgid(child, child);  // in both, so that it is done whichever comes first
  return child;
}

std::string OwnFolder() {
  std::error_code failed;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", failed);
  return failed ? "." : self.parent_path().string();
}

Error RunInstead(const std::string& name, const std::vector<std::string>& arguments) {
  const std::string beside = OwnFolder() + "/" + name;
  std::vector<char*> words = {const_cast<char*>(beside.c_str())};
  for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  execv(beside.c_str(), words.data());
  words[0] = const_cast<char*>(name.c_str());
  if (errno == ENOENT || errno == EACCES) execvp(name.c_str(), words.data());
  if (errno == ENOENT) {
    return Error{name + " is neither beside this program nor on the PATH; install or build it"};
  }
  return Error{std::string("cannot be started: ") + std::strerror(errno), name};
}

std::string ShellText(const std::vector<std::string>& command) {
  std::string text;
  for (const std::string& word : command) text += (text.empty() ? "" : " ") + ShellQuoted(word);
  return text;
}

ChildEnd NextEnded() {
  ChildEnd end;
  int status = 0;
  const pid_t pid = waitpid(-1, &status, WNOHANG);
  if (pid <= 0) return end;
  end.pid = pid;
  if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  return end;
}

void KillChild(pid_t pid, int signal) { kill(-pid, signal); }

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

Result<bool> FolderLock::Take(const std::string& folder) {
  descriptor_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0) return Error{"cannot be opened: " + std::string(strerror(errno)), folder};
  // If the file system has no locks, the job runs without one.
  return flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

}  // namespace pushid
