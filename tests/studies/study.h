// What the studies of synthetic recordings share: percentages, and the end where one cannot go on.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

#include "datasets/files/error.h"

namespace pushid {

inline std::string Percent(int count, int total) {
  char text[16];
  std::snprintf(text, sizeof text, "%.1f", total > 0 ? 100.0 * count / total : 0.0);
  return text;
}

// The value; an error ends the study, which prints it.
template <typename T>
T OrExit(Result<T> result) {
  if (result.ok()) return std::move(result).value();
  std::fprintf(stderr, "%s\n", result.error().ToString().c_str());
  std::exit(1);
}

}  // namespace pushid
