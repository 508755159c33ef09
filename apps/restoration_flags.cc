// apps: loading what --restoration names.
#include "apps/restoration_flags.h"

#include "ident/restoration_files.h"

DEFINE_string(restoration, "",
              "whole bodies: the folder that pushid-train-restoration --out wrote, or rigid");

namespace pushid {

Result<std::unique_ptr<Restoration>> LoadFlaggedRestoration() {
  return LoadRestoration(FLAGS_restoration);
}

}  // namespace pushid
