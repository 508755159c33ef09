// ident: the numbers of a fit in one row.
#include "ident/problem/fit_point.h"

#include <algorithm>

namespace pushid {

std::vector<double> FitPoint::Flat() const {
  std::vector<double> flat = shared;
  for (const auto& [name, values] : unit) flat.insert(flat.end(), values.begin(), values.end());
  for (const auto& [index, values] : velocity)
    flat.insert(flat.end(), values.begin(), values.end());
  flat.insert(flat.end(), weights.begin(), weights.end());
  return flat;
}

void FitPoint::SetFlat(const std::vector<double>& flat) {
  auto next = flat.begin();
  auto take = [&next](std::vector<double>* values) {
    std::copy_n(next, values->size(), values->begin());
    next += static_cast<std::ptrdiff_t>(values->size());
  };
  take(&shared);
  for (auto& [name, values] : unit) take(&values);
  for (auto& [index, values] : velocity) take(&values);
  take(&weights);
}

}  // namespace pushid
