// apps: the flags of pushid-crossvalidate alone.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "datasets/files/error.h"
#include "ident/fit/fit_setup.h"
#include "ident/problem/folds.h"

namespace pushid {

struct CrossvalidateFlags {
  FoldScheme scheme = FoldScheme::kStratified;
  int folds = 4, repeats = 5;  // of the stratified scheme
  std::string folds_file;      // instead of a scheme; empty: none
  // Names of further candidates, with the options that they have over the given ones.
  std::vector<std::pair<std::string, GivenOptions>> candidates;
  bool baselines = true;
  std::string frontier_out, json_out;  // empty: not written
  bool bands = false;
};

Result<CrossvalidateFlags> CrossvalidateFlagsFromCommandLine();

}  // namespace pushid
