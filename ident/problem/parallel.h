// ident: independent jobs over a few threads, and what they spend.
//
// Which thread does which job makes no difference to a
// result: every job writes to its own place.
//
// What a job or its progress throws (a user who interrupts, no memory) ends the jobs that have not
// begun and is thrown again by the thread that asked for them: out of another one it would end the
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

// What a fit spends, and on what: evaluations of its problem, and time.

// Evaluations of all residual blocks of a problem.
struct Evaluations {
  int jacobians = 0;  // residuals and their Jacobian
  int costs = 0;      // residuals alone
};

// Counts evaluations that are about to be made, in any thread.
void CountEvaluations(const Evaluations& more);
// The sum over all threads of the process so far.
Evaluations EvaluationsSoFar();

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
  void Add(const std::string& purpose);
  const std::vector<Work>& parts() const { return parts_; }  // in order of their first mention

 private:
  std::vector<Work> parts_;
  Evaluations from_ = EvaluationsSoFar();
  double since_ = Now();
};

}  // namespace pushid
