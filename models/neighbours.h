// models: who may act on whom at one frame: a search on a uniform grid of carts.
//
// People are sorted by the cells of a grid as wide as the reach: the cost per person hardly grows
// with the crowd, however far apart people are, and neighbours lie near in memory. The order in
// which a person meets the neighbours is that of their places at frame 0 (ties: angles, then mass),
// never that of their numbers, so that sums come out the same to the last bit however the people
// are numbered.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "models/interaction.h"
#include "models/scene.h"

namespace pushid {

// The largest |dx| and |dy| of two carts that may act on each other, where no contact point
// is more than `lean` metres off the cart.
Eigen::Vector2d InteractionReach(const InteractionTerms& terms, const ParameterSet<double>& p,
                                 double lean);

class NeighbourGrid {
 public:
  NeighbourGrid() = default;
  // rank[n]: the place of person n in the canonical order.
  explicit NeighbourGrid(std::vector<int> rank) : rank_(std::move(rank)) {}

  void Build(const std::vector<Eigen::Vector2d>& at, const Eigen::Vector2d& reach);
  // Finds the people within reach of `person` along both axes, of canonical rank `from` or higher
  // and with keep(other), in canonical order.
  template <typename Keep>
  void Near(int person, int from, const Keep& keep, std::vector<int>* near) const {
    near->clear();
    const Eigen::Vector2d at = at_[person];
    const auto consider = [&](int other, const Eigen::Vector2d& there) {
      if (rank_[other] < from || other == person) return;
      const Eigen::Vector2d apart = (there - at).cwiseAbs();
      const bool close = apart[0] <= reach_[0] && apart[1] <= reach_[1];
      if (close && keep(other)) near->push_back(other);
    };
    ForEachCandidate(person, consider);
    std::sort(near->begin(), near->end(), [this](int a, int b) { return rank_[a] < rank_[b]; });
  }
  int Rank(int person) const { return rank_[person]; }

 private:
  // Groups of at most so many people are compared with each other directly.
  static constexpr std::size_t kFewPeople = 12;

  using GridCell = std::pair<std::int64_t, std::int64_t>;
  struct Member {
    GridCell cell;
    int person;
  };

  // Calls visit(person, place) for everybody in the person's cell and the eight around it, the
  // person too, each once; in a small crowd for everybody.
  template <typename Visit>
  void ForEachCandidate(int person, const Visit& visit) const {
    if (at_.size() <= kFewPeople) {
      for (std::size_t other = 0; other < at_.size(); ++other) {
        visit(static_cast<int>(other), at_[other]);
      }
      return;
    }
    const auto [column, row] = Cell(at_[person]);
    for (const std::int64_t beside : {column - 1, column, column + 1}) {
      auto member =
          std::lower_bound(members_.begin(), members_.end(), GridCell(beside, row - 1),
                           [](const Member& m, const GridCell& lowest) { return m.cell < lowest; });
      for (; member != members_.end() && member->cell <= GridCell(beside, row + 1); ++member) {
        visit(member->person, at_[member->person]);
      }
    }
  }
  GridCell Cell(const Eigen::Vector2d& at) const {
    return {static_cast<std::int64_t>(std::floor(at[0] / reach_[0])),
            static_cast<std::int64_t>(std::floor(at[1] / reach_[1]))};
  }

  std::vector<int> rank_;
  std::vector<Eigen::Vector2d> at_;
  Eigen::Vector2d reach_ = Eigen::Vector2d::Zero();
  std::vector<Member> members_;  // by cell
};

// The canonical order of a scene's people.
std::vector<int> CanonicalRank(const Scene& scene);

// Finds the pairs of a scene frame by frame: exactly those that some term of the model may act on.
class PairFinder {
 public:
  PairFinder(const Scene& scene, const InteractionTerms& terms);

  // states: of everybody at one frame; p: the parameters everybody shares between them.
  template <typename T>
  void Update(const ParameterSet<T>& p, const std::vector<PosedPendulum<T>>& states) {
    if (!Active()) return;
    for (int i = 0; i < kNumParameters; ++i) parameters_[i] = RealPart(p[i]);
    double lean_squared = 0.0;  // m^2, of the contact point farthest off its cart
    for (std::size_t n = 0; n < cart_.size(); ++n) {
      cart_[n] = {RealPart(states[n].q[0]), RealPart(states[n].q[1])};
      if (!terms_.Contact()) continue;
      const auto& [s_th, c_th, s_ph, c_ph] = states[n].angles;
      const double reach = parameters_[kContactHeight] * scene_->people[n].body.rod_length;
      point_[n] =
          cart_[n] + reach * Eigen::Vector2d(RealPart(s_th), -RealPart(c_th) * RealPart(s_ph));
      lean_squared = std::max(lean_squared, (point_[n] - cart_[n]).squaredNorm());
    }
    grid_.Build(cart_, InteractionReach(terms_, parameters_, std::sqrt(lean_squared)));
  }

  // Neighbours of a person in canonical order, from a place in it on.
  void Near(int person, std::vector<int>* near, int from = 0) const;
  int Rank(int person) const { return grid_.Rank(person); }
  Pair Of(int n, int j) const {
    return {scene_->people[n].body, scene_->people[j].body, first_[n], first_[j]};
  }

  // Calls visit(n, j) for every pair once, n before j in canonical order, pairs in that order too.
  template <typename Visit>
  void ForEachPair(Visit&& visit) {
    if (!Active()) return;
    for (int n : order_) {
      Near(n, &near_, grid_.Rank(n) + 1);
      for (int j : near_) visit(n, j);
    }
  }

 private:
  bool Active() const { return terms_.Any() && cart_.size() > 1; }
  bool MayAct(int n, int j) const {
    if (terms_.Contact()) {
      const double kappa = parameters_[kContactKappa], d = parameters_[kContactDistance];
      const Eigen::Vector2d r = point_[n] - point_[j];
      if (r[0] * r[0] + kappa * kappa * r[1] * r[1] < d * d) return true;
    }
    if (!terms_.AtCarts()) return false;
    const double reach = parameters_[kNeighbourRange];
    return (cart_[n] - cart_[j]).squaredNorm() <= reach * reach;
  }

  const Scene* scene_;
  InteractionTerms terms_;
  ParameterSet<double> parameters_{};
  std::vector<int> order_;  // people by rank
  std::vector<FirstPose> first_;
  std::vector<Eigen::Vector2d> cart_, point_;  // point_: of contact
  NeighbourGrid grid_;
  std::vector<int> near_;
};

}  // namespace pushid
