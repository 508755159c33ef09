// apps: how far a training has come.
#pragma once

#include <string>

#include "apps/support/app_support.h"

namespace pushid {

// What Ctrl-C is told of a training into this folder.
std::string KeptCheckpoints(const std::string& folder);

// "window, epoch 12: 43 %, 12 s left"; the time left from the share done so far. Steps are told
// apart by what stands before their last word.
class TrainingLine {
 public:
  TrainingLine();
  void Show(const std::string& step, double done);
  void Finish() { line_.Finish(); }
  double Seconds() const;  // since it was made

 private:
  ProgressLine line_;
  std::string step_;
  double made_, start_ = 0.0, done_at_start_ = 0.0;
};

}  // namespace pushid
