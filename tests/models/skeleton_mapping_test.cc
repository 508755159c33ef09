// From hip and ankles to the pendulum: the inverse of HipPosition.
#include "models/skeleton_mapping.h"

#include "tests/models/model_samples.h"

namespace pushid {
namespace {

const Vector3<double> kHalfStance(0.03, 0.1, 0.01);  // from the ankles' midpoint to one of them

MappedPose MapPose(const Body& body, const Vector4<double>& q) {
  const Vector3<double> cart(q[0], q[1], body.cart_height);
  return MapSkeleton(HipPosition(body, q), cart + kHalfStance, cart - kHalfStance);
}

TEST(SkeletonMapping, InvertsHipPosition) {
  Random random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const Body body = RandomBody(&random);
    const Vector4<double> q = RandomState(&random).q;
    const MappedPose pose = MapPose(body, q);
    ExpectClose(pose.q, q, 1e-13);
    EXPECT_NEAR(pose.rod_length, body.rod_length, 1e-14);
    EXPECT_NEAR(pose.cart_height, body.cart_height, 1e-15);
  }
}

}  // namespace
}  // namespace pushid
