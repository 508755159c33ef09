// ident: the file that keeps finished bootstrap replicas.
#pragma once

#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "ident/bootstrap.h"

namespace pushid {

// One replica: empty values for a fit that failed.
using ReplicaValues = std::vector<double>;

class BootstrapFile {
 public:
  // Takes over the whole lines of an existing file of the same fit and cuts off the rest. An empty
  // path keeps nothing.
  MaybeError Open(const FitProblem& problem, const BootstrapOptions& options,
                  const std::vector<std::string>& names);

  const std::map<int, ReplicaValues>& finished() const { return finished_; }

  // Not from two threads at once.
  void Append(int replica, const ReplicaValues& values);

  // After the last Append: whether everything reached the file.
  MaybeError Close();

 private:
  std::string path_;
  std::ofstream stream_;
  std::map<int, ReplicaValues> finished_;
};

}  // namespace pushid
