// apps: what-ifs from the command line.
#include "apps/flags/what_if_flags.h"

#include <sstream>

#include "apps/flags/model_flags.h"
#include "ident/model/model_json.h"

namespace pushid {
Result<std::vector<WhatIf>> LoadWhatIfs() {
  if (MaybeError missing = RequireModel()) return *missing;
  const ModelFlags flags = ModelFlagsFromCommandLine();
  const Result<FittedModel> read = ReadFittedModel(flags.file);
  if (!read.ok()) return read.error();
  IdentifiedModel fitted = ModelOf(read.value().fit);
  fitted.source = flags.file;
  std::vector<WhatIf> what_ifs = {{"", fitted}};
  std::stringstream sets(flags.set);
  for (std::string set; std::getline(sets, set, kBetweenSets);) {
    WhatIf one{set, fitted};
    if (MaybeError error = SetValues(set, &one.model)) return *error;
    what_ifs.push_back(std::move(one));
  }
  return what_ifs;
}

}  // namespace pushid
