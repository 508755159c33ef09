// apps: progress of trainings.
#include "apps/support/training_line.h"

#include <cmath>

#include "ident/problem/parallel.h"

namespace pushid {

std::string KeptCheckpoints(const std::string& folder) {
  return "the last checkpoint is in " + folder + ", and the same command continues from there";
}

TrainingLine::TrainingLine() : made_(Now()) {}

double TrainingLine::Seconds() const { return Now() - made_; }

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
  line_.Show(text);
}

}  // namespace pushid
