// ident: the median; of an even number, the mean of the middle two.
#pragma once

#include <algorithm>
#include <vector>

namespace pushid {

// values: at least one.
inline double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace pushid
