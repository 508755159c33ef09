// apps: --published by name.
#pragma once

#include "apps/flags/command_line.h"
#include "ident/generators/generator_files.h"

DEFINE_string(
    published, "",
    "the settings of a paper: sde (particles; Lyu et al., ACM MM 2021), sdm (diffusion; Tanke et "
    "al., ICCV 2023); other flags change them; empty: those of pushid");

namespace pushid {

// The kind of generator whose paper's settings are asked for, if any.
inline std::optional<GeneratorKind> PublishedKind() {
  if (FLAGS_published.empty()) return std::nullopt;
  for (const GeneratorKindRow& row : kGeneratorKinds) {
    if (FLAGS_published == row.paper) return row.value;
  }
  throw Error{"--published is " + Quoted(FLAGS_published) + ", not sde or sdm"};
}

}  // namespace pushid
