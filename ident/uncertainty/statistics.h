// ident: medians and Student's t.
#pragma once

#include <algorithm>
#include <vector>

namespace pushid {

// Of an even number, the mean of the middle two. values: at least one.
inline double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

// Two-sided 95 % quantile of Student's t.
double StudentQuantile95(double degrees_of_freedom);
// Probability that |T| exceeds |t|.
double StudentTail(double t, double degrees_of_freedom);

}  // namespace pushid
