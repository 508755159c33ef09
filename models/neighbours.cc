// models: the neighbour grid and the canonical order.
#include "models/neighbours.h"

#include <numeric>
#include <tuple>

namespace pushid {

Eigen::Vector2d InteractionReach(const InteractionTerms& terms, const ParameterSet<double>& p,
                                 double lean) {
  Eigen::Vector2d reach = Eigen::Vector2d::Zero();
  if (terms.Contact()) {
    const double d = p[kContactDistance];
    reach = {d + 2.0 * lean, d / p[kContactKappa] + 2.0 * lean};
  }
  if (terms.AtCarts()) {
    reach = reach.cwiseMax(Eigen::Vector2d::Constant(p[kNeighbourRange]));
  }
  return reach;
}

void NeighbourGrid::Build(const std::vector<Eigen::Vector2d>& at, const Eigen::Vector2d& reach) {
  at_ = at;
  reach_ = reach;
  if (at.size() <= kFewPeople) return;
  members_.clear();
  for (int n = 0; n < static_cast<int>(at.size()); ++n) members_.push_back({Cell(at[n]), n});
  std::sort(members_.begin(), members_.end(),
            [](const Member& a, const Member& b) { return a.cell < b.cell; });
}

std::vector<int> CanonicalRank(const Scene& scene) {
  std::vector<int> order(scene.people.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&scene](int n) {
    const ScenePerson& person = scene.people[n];
    const Vector4<double>& q = person.start.q;
    return std::make_tuple(q[0], q[1], q[2], q[3], person.body.mass, person.body.rod_length);
  };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  std::vector<int> rank(order.size());
  for (std::size_t r = 0; r < order.size(); ++r) rank[order[r]] = static_cast<int>(r);
  return rank;
}

PairFinder::PairFinder(const Scene& scene, const InteractionTerms& terms)
    : scene_(&scene),
      terms_(terms),
      order_(scene.people.size()),
      cart_(scene.people.size()),
      point_(scene.people.size()) {
  std::vector<int> rank = CanonicalRank(scene);
  for (std::size_t n = 0; n < rank.size(); ++n) order_[rank[n]] = static_cast<int>(n);
  if (Active()) {
    for (const ScenePerson& person : scene.people) first_.emplace_back(person.start.q);
  }
  grid_ = NeighbourGrid(std::move(rank));
}

void PairFinder::Near(int person, std::vector<int>* near, int from) const {
  near->clear();
  if (!Active()) return;
  grid_.Near(
      person, from, [this, person](int other) { return MayAct(person, other); }, near);
}

}  // namespace pushid
