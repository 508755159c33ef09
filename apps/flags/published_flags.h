// apps: --published: the settings of a paper, as other defaults of a program's own flags.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"

namespace pushid {

struct PublishedFlags {
  const char* paper;  // its name on the command line
  std::vector<std::pair<const char*, const char*>> values;
};

// Makes the values of the paper that --published names the defaults, before any flag is read: flags
// that are given win. Errors: no such paper.
MaybeError TakePublished(const std::vector<PublishedFlags>& papers);

}  // namespace pushid
