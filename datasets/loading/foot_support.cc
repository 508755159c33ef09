// datasets: how far the ground under a person's feet reaches from between the ankles.
#include "datasets/loading/foot_support.h"

#include <cmath>

namespace pushid {
namespace {

using Track = std::vector<Eigen::Vector3d>;

// Mean of both feet, from the first track of each to the second, along `direction` on x.
std::optional<double> Reach(double direction, const Track& left_ankle, const Track& left,
                            const Track& right_ankle, const Track& right) {
  if (left.empty() || right.empty()) return std::nullopt;
  const double reach =
      0.5 * direction * (left[0].x() - left_ankle[0].x() + right[0].x() - right_ankle[0].x());
  return reach > 0.0 ? std::optional(reach) : std::nullopt;
}

}  // namespace

FootSupport SupportOf(const RecordedPerson& person) {
  const Track &left = person.left_ankle, &right = person.right_ankle;
  FootSupport support;
  support.side = 0.5 * std::abs(left[0].y() - right[0].y());
  support.forward = Reach(1.0, left, person.left_toe, right, person.right_toe);
  support.back = Reach(-1.0, left, person.left_heel, right, person.right_heel);
  return support;
}

}  // namespace pushid
