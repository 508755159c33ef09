// ident: a point in the space of a fit, and the recordings that fail there.
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "models/scene.h"

namespace pushid {

// A point in the space of the fit.
struct FitPoint {
  std::vector<double> shared;  // fitted scale
  std::map<std::string, std::vector<double>>
      unit;  // deviations by PoolBy's units, fitted scale; empty if not pooled
  std::map<int, std::vector<double>> velocity;  // by recording, where the initial velocity is free
  std::vector<double> weights;                  // of what is learned; empty without

  // All entries in one row: shared, units in order of name, velocities in order of recording,
  // weights.
  std::vector<double> Flat() const;
  void SetFlat(const std::vector<double>& flat);
};

inline std::vector<double> FitPoint::Flat() const {
  std::vector<double> flat = shared;
  for (const auto& [name, values] : unit) flat.insert(flat.end(), values.begin(), values.end());
  for (const auto& [index, values] : velocity)
    flat.insert(flat.end(), values.begin(), values.end());
  flat.insert(flat.end(), weights.begin(), weights.end());
  return flat;
}

inline void FitPoint::SetFlat(const std::vector<double>& flat) {
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

// A rollout that left the model's domain, by recording.
struct FailedRollout {
  int recording;
  RolloutStatus status;
};

}  // namespace pushid
