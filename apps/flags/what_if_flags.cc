// apps: what-ifs from the command line.
#include "apps/flags/what_if_flags.h"

#include <cstring>

#include "apps/flags/model_flags.h"
#include "ident/results/result_json.h"

namespace pushid {
namespace {

std::vector<std::string>& Sets() {
  static std::vector<std::string> sets;
  return sets;
}

}  // namespace

void KeepEverySet(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    for (const char* flag : {"--set", "-set"}) {
      const size_t length = std::strlen(flag);
      if (std::strncmp(argv[i], flag, length) != 0) continue;
      if (argv[i][length] == '=') Sets().push_back(argv[i] + length + 1);
      if (argv[i][length] == '\0' && i + 1 < argc) Sets().push_back(argv[i + 1]);
    }
  }
}

Result<std::vector<WhatIf>> LoadWhatIfs() {
  if (MaybeError missing = RequireModel()) return *missing;
  const ModelFlags flags = ModelFlagsFromCommandLine();
  const Result<FittedModel> read = ReadFittedModel(flags.file);
  if (!read.ok()) return read.error();
  IdentifiedModel fitted = ModelOf(read.value().fit);
  fitted.source = flags.file;
  std::vector<std::string> sets = Sets();
  // Of a flag file.
  if (sets.empty() && !flags.set.empty()) sets.push_back(flags.set);
  std::vector<WhatIf> what_ifs = {{"", fitted}};
  for (const std::string& set : sets) {
    WhatIf one{set, fitted};
    if (MaybeError error = SetValues(set, &one.model)) return *error;
    what_ifs.push_back(std::move(one));
  }
  return what_ifs;
}

}  // namespace pushid
