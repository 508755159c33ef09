// apps: the flags of pushid-report.
#pragma once

#include <string>

#include "datasets/files/error.h"

namespace pushid {

struct ReportFlags {
  std::string model;     // file that pushid-fit --model_out wrote
  std::string truth;     // manifest of pushid-simulate: only compare with its values; empty: no
  std::string html_out;  // page; empty: none
  std::string csv_dir;   // folder for the numbers behind every plot; empty: none
  bool text = false;     // the whole report, not only the parameters
  int num_threads = 1;

  bool whole() const { return text || !html_out.empty() || !csv_dir.empty(); }
};
Result<ReportFlags> ReportFlagsFromCommandLine();

}  // namespace pushid
