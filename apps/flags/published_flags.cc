// apps: --published by name.
#include <gflags/gflags.h>

#include "apps/flags/kind_flags.h"
#include "datasets/files/names.h"

DEFINE_string(
    published, "",
    "settings of a paper as defaults: sde (Lyu et al., ACM MM 2021), sdm (Tanke et al., ICCV "
    "2023); other flags change them; empty: those of pushid");

namespace pushid {

void TakePublished(const std::vector<PublishedFlags>& papers) {
  if (FLAGS_published.empty()) return;
  std::string names;
  for (const PublishedFlags& paper : papers) {
    names += (names.empty() ? "" : " or ") + std::string(paper.paper);
    if (paper.paper != FLAGS_published) continue;
    for (const auto& [flag, value] : paper.values) {
      gflags::SetCommandLineOptionWithMode(flag, value, gflags::SET_FLAGS_DEFAULT);
    }
    return;
  }
  throw Error{"--published is " + Quoted(FLAGS_published) + ", not " + names};
}

}  // namespace pushid
