// ident: bootstrap over recordings: the fit repeated on recordings drawn with replacement.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace pushid {

struct Bootstrap {
  int replicas = 0;  // asked for
  uint64_t seed = 0;
  int failed = 0;  // did not converge; they are in no row
  std::vector<std::string> names, units;
  std::vector<std::vector<double>> values;  // one row per good replica, natural units
  // By parameter: standard deviation over replicas, and their 2.5 and 97.5 % quantiles.
  std::vector<double> standard_error, lower95, upper95;
};

}  // namespace pushid
