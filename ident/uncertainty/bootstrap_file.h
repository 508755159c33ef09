// ident: the file that keeps finished bootstrap replicas.
#pragma once

#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "ident/uncertainty/bootstrap.h"

namespace pushid {

// One replica: empty values for a fit that failed.
using ReplicaValues = std::vector<double>;

class BootstrapFile {
 public:
  // Takes over the whole lines of an existing file of the same fit and cuts off the rest. An empty
  // path keeps nothing. Errors: a file that cannot be read, written, or is not of this fit; what
  // it held stays.
  MaybeError Open(const FitProblem& problem, const BootstrapOptions& options,
                  const Bootstrap& bootstrap);

  const std::map<int, ReplicaValues>& finished() const { return finished_; }

  // Not from two threads at once. Errors: it did not reach the file, so that more replicas would be
  // computed for nothing.
  MaybeError Append(int replica, const ReplicaValues& values);

 private:
  std::string path_;
  std::ofstream stream_;
  std::map<int, ReplicaValues> finished_;
};

}  // namespace pushid
