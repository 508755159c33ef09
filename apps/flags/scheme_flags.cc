// apps: --scheme by name.
#include <gflags/gflags.h>

#include "apps/flags/body_flags.h"
#include "apps/flags/command_line.h"
#include "datasets/files/names.h"
#include "ident/parameters/option_names.h"

DEFINE_string(scheme, pushid::NameOf(pushid::FoldScheme::kStratified),
              "--crossvalidate: stratified (folds by setting, strength and subject) or interleaved "
              "(recordings of a setting assigned to folds in turn)");

namespace pushid {

FoldScheme SchemeFromCommandLine(bool takes_folds) {
  FoldScheme scheme = FoldScheme::kStratified;
  OrFail(ParseName("--scheme", FLAGS_scheme, &scheme));
  if (!takes_folds && Given("scheme")) throw Error{"--scheme needs --crossvalidate"};
  return scheme;
}

}  // namespace pushid
