// ident: a point in the space of a fit, the recordings that fail there, and the sums of their rows.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "models/scene.h"

namespace pushid {

struct FitPoint {
  std::vector<double> shared;  // fitted scale
  std::map<std::string, std::vector<double>>
      unit;  // deviations by PoolBy's units, fitted scale; empty if not pooled
  std::map<int, std::vector<double>> velocity;  // by recording, where the initial velocity is free
  std::vector<double> weights;                  // of what is learned; empty without

  // Calls each(block) for all entries: shared, units in order of name, velocities in order of
  // recording, weights.
  template <typename Point, typename Each>
  static void ForBlocks(Point& point, const Each& each) {
    each(point.shared);
    for (auto& [name, values] : point.unit) each(values);
    for (auto& [index, values] : point.velocity) each(values);
    each(point.weights);
  }
  // All entries in one row.
  std::vector<double> Flat() const {
    std::vector<double> flat;
    ForBlocks(*this, [&flat](const auto& b) { flat.insert(flat.end(), b.begin(), b.end()); });
    return flat;
  }
  void SetFlat(const std::vector<double>& flat) {
    auto next = flat.begin();
    ForBlocks(*this, [&next](auto& block) {
      std::copy_n(next, block.size(), block.begin());
      next += static_cast<std::ptrdiff_t>(block.size());
    });
  }
};

// A rollout that left the model's domain, by recording.
struct FailedRollout {
  int recording;
  RolloutStatus status;
};

// J'J and J'r of some rows.
struct SecondOrder {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;

  static SecondOrder Zero(Eigen::Index columns) {
    return {Eigen::MatrixXd::Zero(columns, columns), Eigen::VectorXd::Zero(columns)};
  }
};

// Sums over the rows of recordings at a point, by the weights that they have there.
struct RecordingSums {
  Eigen::VectorXd at;  // of the columns; empty: nowhere
  double squares = 0.0;
  SecondOrder sums;

  bool AreAt(const Eigen::VectorXd& x) const { return at.size() == x.size() && at == x; }
  void Scale(double factor) {
    squares *= factor;
    sums.information *= factor;
    sums.gradient *= factor;
  }
};

// Problems of more columns are solved by their rows, without such sums and without secants
// (solver/structured_secants.h): many columns are of units (subjects, settings), of which a
// recording has few and each has its prior, or of a network's weights.
inline constexpr int kDenseColumns = 50;

}  // namespace pushid
