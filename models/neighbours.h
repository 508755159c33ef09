// models: who may act on whom at one frame: a search on a uniform grid of carts.
//
// People are sorted into the cells of a grid as wide as the reach, by a counting sort over hashed
// cells: the cost per person does not grow with the crowd. The order in which a person meets her
// neighbours is that of their places at frame 0 (ties: angles, then mass), never that of their
// numbers, so that sums come out the same to the last bit however the people are numbered.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "models/interaction.h"
#include "models/scene.h"

namespace pushid {

// The largest |dx| and |dy| of two carts that may act on each other, where nobody's contact point
// is more than `lean` metres off the cart.
Eigen::Vector2d InteractionReach(const InteractionTerms& terms, const ParameterSet<double>& p,
                                 double lean);

class NeighbourGrid {
 public:
  NeighbourGrid() = default;
  // rank[n]: the place of person n in the canonical order.
  explicit NeighbourGrid(std::vector<int> rank) : rank_(std::move(rank)) {}

  void Build(const std::vector<Eigen::Vector2d>& at, const Eigen::Vector2d& reach);
  // Everybody but `person` within the reach along both axes, in canonical order.
  void Near(int person, std::vector<int>* near) const;
  int Rank(int person) const { return rank_[person]; }

 private:
  Eigen::Matrix<std::int64_t, 2, 1> Cell(const Eigen::Vector2d& at) const;
  std::size_t Bucket(const Eigen::Matrix<std::int64_t, 2, 1>& cell) const;

  std::vector<int> rank_;
  std::vector<Eigen::Vector2d> at_;
  Eigen::Vector2d reach_ = Eigen::Vector2d::Zero();
  std::vector<Eigen::Matrix<std::int64_t, 2, 1>> cell_;  // of each person
  std::vector<int> first_, member_, next_;               // members of a bucket; scratch
};

// The canonical order of a scene's people.
std::vector<int> CanonicalRank(const Scene& scene);

// Finds the pairs of a scene frame by frame.
class PairFinder {
 public:
  PairFinder(const Scene& scene, const InteractionTerms& terms);

  // states: of everybody at one frame; p: the parameters everybody shares between them.
  template <typename T>
  void Update(const ParameterSet<T>& p, const PendulumState<T>* states) {
    const bool alone = !terms_.Any() || at_.size() < 2;
    if (alone) return;
    ParameterSet<double> real;
    for (int i = 0; i < kNumParameters; ++i) real[i] = RealPart(p[i]);
    double lean = 0.0;
    for (std::size_t n = 0; n < at_.size(); ++n) {
      const Vector4<T>& q = states[n].q;
      at_[n] = {RealPart(q[0]), RealPart(q[1])};
      if (!terms_.Contact()) continue;
      const Vector4<double> angles(0.0, 0.0, RealPart(q[2]), RealPart(q[3]));
      const auto offset =
          ContactPoint<double>(scene_->people[n].body, angles, real[kContactHeight]);
      lean = std::max(lean, offset.norm());
    }
    grid_.Build(at_, InteractionReach(terms_, real, lean));
  }

  // Neighbours of a person in canonical order.
  void Near(int person, std::vector<int>* near) const {
    near->clear();
    if (terms_.Any() && at_.size() > 1) grid_.Near(person, near);
  }
  int Rank(int person) const { return grid_.Rank(person); }

  // Calls visit(n, j) for every pair once, n before j in canonical order, pairs in that order too.
  template <typename Visit>
  void ForEachPair(Visit&& visit) {
    if (!terms_.Any() || at_.size() < 2) return;
    for (int n : order_) {
      grid_.Near(n, &near_);
      for (int j : near_) {
        if (grid_.Rank(j) > grid_.Rank(n)) visit(n, j);
      }
    }
  }

 private:
  const Scene* scene_;
  InteractionTerms terms_;
  std::vector<int> order_;  // people by rank
  std::vector<Eigen::Vector2d> at_;
  NeighbourGrid grid_;
  std::vector<int> near_;
};

// Two people of a scene as an interaction sees them.
inline Pair PairOf(const Scene& scene, int n, int j) {
  const ScenePerson &a = scene.people[n], &b = scene.people[j];
  return {a.body, b.body, a.start.q, b.start.q};
}

}  // namespace pushid
