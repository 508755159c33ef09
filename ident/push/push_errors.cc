// ident: moves of refits as an error.
#include "ident/push/push_errors.h"

#include <cmath>
#include <map>
#include <string>

namespace pushid {

std::vector<PushError> PushErrors(const RefitTable& check) {
  std::vector<PushError> errors;
  for (size_t i = 0; i < check.parameters.size(); ++i) {
    struct Source {
      double squares = 0.0;
      int refits = 0;
    };
    std::map<std::string, Source> sources;
    for (const RefitRow& row : check.rows) {
      if (row.value.empty()) continue;
      Source& source = sources[row.source];
      source.squares += std::pow(row.value[i] - check.value[i], 2);
      ++source.refits;
    }
    double square = 0.0;
    for (const auto& [name, source] : sources) square += source.squares / source.refits;
    errors.push_back({std::sqrt(square), std::hypot(check.standard_error[i], std::sqrt(square))});
  }
  return errors;
}

}  // namespace pushid
