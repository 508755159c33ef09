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

NeighbourGrid::GridCell NeighbourGrid::Cell(const Eigen::Vector2d& at) const {
  return {static_cast<std::int64_t>(std::floor(at[0] / reach_[0])),
          static_cast<std::int64_t>(std::floor(at[1] / reach_[1]))};
}

std::size_t NeighbourGrid::Bucket(const GridCell& cell) const {
  const std::uint64_t column = static_cast<std::uint64_t>(cell[0]) * 0x9E3779B97F4A7C15u >> 20;
  // first_ has a power of two of buckets and one more.
  return (column + static_cast<std::uint64_t>(cell[1])) & (first_.size() - 2);
}

void NeighbourGrid::Build(const std::vector<Eigen::Vector2d>& at, const Eigen::Vector2d& reach) {
  at_ = at;
  reach_ = reach;
  const std::size_t people = at.size();
  if (people <= kFewPeople) return;
  std::size_t buckets = 16;
  while (buckets < 2 * people) buckets *= 2;
  first_.assign(buckets + 1, 0);
  cell_.resize(people);
  members_.resize(people);
  for (std::size_t n = 0; n < people; ++n) {
    cell_[n] = Cell(at[n]);
    ++first_[Bucket(cell_[n]) + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  next_.assign(first_.begin(), first_.end() - 1);
  for (std::size_t n = 0; n < people; ++n) {
    members_[next_[Bucket(cell_[n])]++] = {at[n], cell_[n][0], static_cast<int>(n)};
  }
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
