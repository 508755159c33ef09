// apps: the flags of pushid-inspect.
#pragma once

#include <string>
#include <vector>

#include "datasets/manifest/column_mapping.h"

namespace pushid {

struct InspectFlags {
  ColumnMapping mapping;  // of tables; empty: by the files' own names
  std::string svg_out;    // picture of the one file; empty: none
};
// files: the words of the command line that are no flags.
Result<InspectFlags> InspectFlagsFromCommandLine(const std::vector<std::string>& files);

}  // namespace pushid
