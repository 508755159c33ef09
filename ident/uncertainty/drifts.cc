// ident: which estimates drift with the horizon; of a finished table, which reports read.
#include <algorithm>
#include <cmath>

#include "ident/uncertainty/refit_checks.h"

namespace pushid {
namespace {

constexpr double kDriftErrors = 2.0;

std::vector<Drift> FarMoves(const RefitTable& horizons, bool of_single_steps) {
  std::vector<Drift> drifts;
  for (size_t p = 0; p < horizons.parameters.size(); ++p) {
    Drift drift{p, 0, 0.0};
    for (size_t r = 0; r < horizons.rows.size(); ++r) {
      const RefitRow& row = horizons.rows[r];
      if (row.value.empty() || (row.frames == kOneStep) != of_single_steps) continue;
      const double error = std::max(row.standard_error[p], horizons.standard_error[p]);
      const double move = std::abs(row.value[p] - horizons.value[p]) / error;
      if (!std::isfinite(move) || move <= drift.in_errors) continue;
      drift.row = r;
      drift.in_errors = move;
    }
    if (drift.in_errors > kDriftErrors) drifts.push_back(drift);
  }
  return drifts;
}

}  // namespace

std::vector<Drift> Drifts(const RefitTable& horizons) { return FarMoves(horizons, false); }

std::vector<Drift> MovesOfSingleSteps(const RefitTable& horizons) {
  return FarMoves(horizons, true);
}

}  // namespace pushid
