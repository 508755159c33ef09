// ident: whether intervals agree.
#include "ident/fit/interval_agreement.h"

#include <algorithm>
#include <cmath>

namespace pushid {
namespace {

// Rows that the clustered covariance gives: parameters, then combinations.
std::vector<Agreement> ClusteredRows(const FitResult& result) {
  std::vector<Agreement> rows;
  for (const Estimate& e : result.estimates) {
    if (e.status == EstimateStatus::kFixed) continue;
    rows.push_back({e.name,
                    e.unit,
                    e.value,
                    e.quantile,
                    {e.standard_error, e.lower95, e.upper95},
                    {},
                    {},
                    {},
                    {}});
  }
  for (const Combination& c : result.derived) {
    if (c.standard_error == 0.0) continue;
    rows.push_back({c.name,
                    c.unit,
                    c.value,
                    c.quantile,
                    {c.standard_error, c.lower95, c.upper95},
                    {},
                    {},
                    {},
                    {}});
  }
  return rows;
}

double WidthRatio(const Agreement& row) {
  double smallest = row.clustered.upper - row.clustered.lower, largest = smallest;
  for (const std::optional<Interval>& other : {row.profile, row.bootstrap}) {
    if (!other) continue;
    smallest = std::min(smallest, other->upper - other->lower);
    largest = std::max(largest, other->upper - other->lower);
  }
  return std::isfinite(smallest) && smallest > 0.0 ? largest / smallest : 1.0;
}

}  // namespace

std::vector<Agreement> CompareIntervals(const FittedModel& model) {
  const FitResult& result = model.fit;
  std::vector<Agreement> rows = ClusteredRows(result);
  for (Agreement& row : rows) {
    for (const Profile& p : model.profiles) {
      if (p.name != row.name) continue;
      row.profile = Interval{(p.upper95 - p.lower95) / (2.0 * row.quantile), p.lower95, p.upper95};
      row.classification = p.classification;
      row.by_data_alone = p.by_data_alone;
    }
    if (model.bootstrap) {
      const Bootstrap& b = *model.bootstrap;
      for (size_t i = 0; i < b.names.size(); ++i) {
        if (b.names[i] != row.name) continue;
        row.bootstrap = Interval{b.standard_error[i], b.lower95[i], b.upper95[i]};
      }
    }
    row.ratio = WidthRatio(row);
  }
  rows.erase(std::remove_if(rows.begin(), rows.end(),
                            [](const Agreement& row) { return !row.profile && !row.bootstrap; }),
             rows.end());
  return rows;
}

}  // namespace pushid
