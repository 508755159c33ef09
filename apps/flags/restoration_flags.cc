// apps: loading what --restoration names.
#include "apps/flags/restoration_flags.h"

#include "ident/bodies/restoration_files.h"

DEFINE_string(restoration, "",
              "whole bodies: the folder that pushid-train-restoration --out wrote, or rigid");

namespace pushid {

Result<std::unique_ptr<Restoration>> LoadFlaggedRestoration(bool rod_moves) {
  if (rod_moves) {
    return Error{
        "the model's rod moves, and bodies hang on rods of constant length; fit one with "
        "--rod=constant for --restoration"};
  }
  return LoadRestoration(FLAGS_restoration);
}

}  // namespace pushid
