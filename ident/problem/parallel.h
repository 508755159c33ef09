// ident: independent jobs over a few threads, and what they spend.
//
// Every job writes to its own place, so that threads make no difference to a result. An exception
// of a job or of its progress (a user who interrupts, no memory) ends the jobs that have not begun
// and is thrown again by the thread that asked for them: out of another one it would end the
// program.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace pushid {

// s, by a clock that only goes forwards.
inline double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

using JobProgress = std::function<void(int done, int total)>;

// Calls job(i) for i in [0, total); progress after each, from one thread at a time.
inline void ParallelFor(int total, int num_threads, const std::function<void(int)>& job,
                        const JobProgress& progress = nullptr) {
  std::atomic<int> next{0};
  std::mutex mutex;
  int done = 0;
  std::exception_ptr thrown;  // the first one
  const auto work = [&] {
    try {
      for (int i = next++; i < total; i = next++) {
        job(i);
        const std::lock_guard<std::mutex> lock(mutex);
        if (progress && !thrown) progress(++done, total);
      }
    } catch (...) {
      next = total;
      const std::lock_guard<std::mutex> lock(mutex);
      if (!thrown) thrown = std::current_exception();
    }
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < std::min(num_threads, total); ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  if (thrown) std::rethrow_exception(thrown);
}

// Evaluations of all residual blocks of a problem.
struct Evaluations {
  int jacobians = 0;  // residuals and their Jacobian
  int costs = 0;      // residuals alone
};

// Evaluations that were made, over all threads of the process so far.
struct EvaluationCount {
  std::atomic<int> jacobians{0}, costs{0};

  static EvaluationCount& Get() {
    static EvaluationCount count;
    return count;
  }
};

struct Work {
  std::string purpose;  // "start", "horizons", "weights", ...
  Evaluations evaluations;
  double seconds = 0.0;
};

// Splits the time from its construction on by purpose. Where several fits run at a time their
// evaluations are counted together.
class WorkLog {
 public:
  // Adds what was spent since the last call, or since construction, to a purpose.
  void Add(const std::string& purpose) {
    auto part = std::find_if(parts_.begin(), parts_.end(),
                             [&](const Work& w) { return w.purpose == purpose; });
    if (part == parts_.end()) part = parts_.insert(part, {purpose, {}, 0.0});
    const Work from = std::exchange(from_, Here());
    part->evaluations.jacobians += from_.evaluations.jacobians - from.evaluations.jacobians;
    part->evaluations.costs += from_.evaluations.costs - from.evaluations.costs;
    part->seconds += from_.seconds - from.seconds;
  }
  const std::vector<Work>& parts() const { return parts_; }  // in order of their first mention

 private:
  static Work Here() {
    const EvaluationCount& count = EvaluationCount::Get();
    return {"", {count.jacobians, count.costs}, Now()};
  }
  std::vector<Work> parts_;
  Work from_ = Here();
};

}  // namespace pushid
