// apps: the flag --published.
#pragma once

#include "apps/flags/command_line.h"
#include "ident/generators/generator_files.h"

DEFINE_string(
    published, "",
    "the settings of a paper: sde (particles; Lyu et al., ACM MM 2021), sdm (diffusion; Tanke et "
    "al., ICCV 2023), which other flags change; empty: pushid's own settings");

namespace pushid {

// The kind of generator whose paper --published names, if any.
inline std::optional<GeneratorKind> PublishedKind() {
  if (FLAGS_published.empty()) return std::nullopt;
  for (const GeneratorKindRow& row : kGeneratorKinds) {
    if (FLAGS_published == row.paper) return row.value;
  }
  throw Error{"--published is " + Quoted(FLAGS_published) + ", not sde or sdm"};
}

}  // namespace pushid
