// apps: the flags of pushid-train-restoration.
#pragma once

#include <string>

#include "ident/training/restoration_chain.h"

namespace pushid {

struct TrainRestorationFlags {
  RestorationRunOptions options;  // with the fit's options read from it
  std::string out;                // folder of the restoration
  int crossvalidate = 0;          // folds, instead of writing a restoration; 0: off
  FoldScheme scheme = FoldScheme::kStratified;
  std::string json_out;       // scores of the cross-validation; empty: none
  std::string more_settings;  // of recordings to learn from too; empty: none
  bool check = false;         // nothing else was read
};
TrainRestorationFlags TrainRestorationFlagsFromCommandLine();

}  // namespace pushid
