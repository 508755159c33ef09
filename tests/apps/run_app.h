// Runs a built executable as a user does: its own process, its exit code, what it prints.
//
//   const AppRun run = Succeeded(RunApp("pushid-fit", {"--recordings=" + manifest}));
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

extern char** environ;

namespace pushid {

// Programs take so much longer under sanitizers.
#ifdef __SANITIZE_ADDRESS__
inline constexpr double kSlowdown = 10.0;
#else
inline constexpr double kSlowdown = 1.0;
#endif

// Words of a command line, and more of them.
inline std::vector<std::string> With(std::vector<std::string> words,
                                     const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

struct AppRun {
  int exit_code = -1;  // -1: killed by a signal, out of time, or never started
  int signal = 0;
  bool timed_out = false;
  std::string out, err;
};

// One that failed ends the test, which shows what it said.
inline AppRun Succeeded(AppRun run) {
  if (run.exit_code == 0) return run;
  throw std::runtime_error("exit code " + std::to_string(run.exit_code) + ": " + run.err);
}

inline std::string ReadFromStart(std::FILE* file) {
  std::string text;
  std::rewind(file);
  char part[4096];
  for (size_t n; (n = std::fread(part, 1, sizeof part, file)) > 0;) text.append(part, n);
  std::fclose(file);
  return text;
}

// Output goes to unnamed files rather than pipes: nothing can fill up and block. An app that is not
// done after `seconds` (times kSlowdown) is killed.
inline AppRun RunProgram(const std::string& path, const std::vector<std::string>& arguments,
                         double seconds = 120.0) {
  std::vector<char*> argv = {const_cast<char*>(path.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);

  AppRun run;
  std::FILE* out = std::tmpfile();
  std::FILE* err = std::tmpfile();
  if (out == nullptr || err == nullptr) {
    run.err = "no temporary file for the output";
    return run;
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, fileno(out), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(err), STDERR_FILENO);
  pid_t child = 0;
  const int failed = posix_spawn(&child, path.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed == 0) {
    using Clock = std::chrono::steady_clock;
    const auto deadline = Clock::now() + std::chrono::duration<double>(seconds * kSlowdown);
    int status = 0;
    while (waitpid(child, &status, WNOHANG) == 0) {
      if (!run.timed_out && Clock::now() > deadline) {
        run.timed_out = true;
        kill(child, SIGKILL);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    if (WIFSIGNALED(status)) run.signal = WTERMSIG(status);
    if (WIFEXITED(status) && !run.timed_out) run.exit_code = WEXITSTATUS(status);
  }
  run.out = ReadFromStart(out);
  run.err = failed == 0 ? ReadFromStart(err) : "cannot start " + path;
  if (failed != 0) std::fclose(err);
  return run;
}

// One of the project's own.
inline AppRun RunApp(const std::string& name, const std::vector<std::string>& arguments,
                     double seconds = 120.0) {
  return RunProgram(std::string(PUSHID_BIN_DIR) + "/" + name, arguments, seconds);
}

}  // namespace pushid
