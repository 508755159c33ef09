// apps: --published by name.
#include <gflags/gflags.h>

#include "apps/flags/body_flags.h"
#include "datasets/files/names.h"

DEFINE_string(
    published, "",
    "the settings of a paper: sde (Lyu et al., ACM MM 2021), sdm (Tanke et al., ICCV 2023); other "
    "flags change them; empty: those of pushid");

namespace pushid {

std::string PublishedFromCommandLine() {
  if (FLAGS_published.empty() || FLAGS_published == "sde" || FLAGS_published == "sdm") {
    return FLAGS_published;
  }
  throw Error{"--published is " + Quoted(FLAGS_published) + ", not sde or sdm"};
}

}  // namespace pushid
