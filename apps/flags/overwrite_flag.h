// apps: --overwrite, of the programs that write what a person may have edited or cannot make again.
#pragma once

#include <string>

#include "datasets/files/error.h"

namespace pushid {

bool OverwriteGiven();

// An Error where the file is there and --overwrite is not given. flag names the file. besides: what
// else may be done ("; --update keeps ...").
MaybeError CheckNew(const std::string& flag, const std::string& file,
                    const std::string& besides = "");

// The same for a folder of recordings that pushid-simulate writes. --overwrite replaces its earlier
// output alone: real recordings stay.
MaybeError CheckOutputFolder(const std::string& flag, const std::string& folder);

}  // namespace pushid
