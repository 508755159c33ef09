// From hip and ankles to the pendulum: exact inverse of HipPosition, and how far LDP's mapping is.
#include "models/skeleton_mapping.h"

#include "tests/models/model_samples.h"

namespace pushid {
namespace {

const Vector3<double> kHalfStance(0.03, 0.1, 0.01);  // from the ankles' midpoint to one of them

MappedPose MapPose(const Body& body, const Vector4<double>& q, SkeletonMapping mapping) {
  const Vector3<double> cart(q[0], q[1], body.cart_height);
  return MapSkeleton(HipPosition(body, q), cart + kHalfStance, cart - kHalfStance, mapping);
}

TEST(SkeletonMapping, ExactMappingInvertsHipPosition) {
  Random random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const Body body = RandomBody(&random);
    const Vector4<double> q = RandomState(&random).q;
    const MappedPose pose = MapPose(body, q, SkeletonMapping::kExact);
    ExpectClose(pose.q, q, 1e-13);
    EXPECT_NEAR(pose.rod_length, body.rod_length, 1e-14);
    EXPECT_NEAR(pose.cart_height, body.cart_height, 1e-15);
  }
}

// The hip that LDP's angles stand for under HipPosition is off by about l theta phi / 2 times the
// angles: 5 mm at 0.22 rad in both, nothing when the lean is in one plane.
TEST(SkeletonMapping, LdpMappingDiffersToThirdOrder) {
  Random random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const Body body = RandomBody(&random);
    Vector4<double> q = RandomState(&random).q;
    q.tail<2>() *= 0.35 / 1.2;
    const MappedPose ldp = MapPose(body, q, SkeletonMapping::kLdp);
    ExpectClose(ldp.q.head<2>().eval(), q.head<2>().eval(), 1e-14);
    EXPECT_NEAR(ldp.rod_length, body.rod_length, 1e-14);
    const double theta = q[2], phi = q[3];
    const double off = (HipPosition(body, ldp.q) - HipPosition(body, q)).norm();
    const double expected = 0.5 * body.rod_length * std::abs(theta * phi) * std::hypot(theta, phi);
    EXPECT_NEAR(off, expected, 0.3 * expected + 1e-12);

    Vector4<double> one_plane = q;
    one_plane[trial % 2 == 0 ? 2 : 3] = 0.0;
    ExpectClose(MapPose(body, one_plane, SkeletonMapping::kLdp).q, one_plane, 1e-14);
  }
}

TEST(SkeletonMapping, LdpAnglesFollowItsConvention) {
  const Body body{80.0, 0.95, 0.1};
  const Vector4<double> q(0.2, -0.1, 0.3, -0.25);
  const MappedPose ldp = MapPose(body, q, SkeletonMapping::kLdp);
  const Vector3<double> cart(q[0], q[1], body.cart_height);
  const Vector3<double> u = (HipPosition(body, q) - cart) / body.rod_length;
  EXPECT_NEAR(u.y(), -std::sin(ldp.q[3]), 1e-15);
  EXPECT_NEAR(u.x(), std::sin(ldp.q[2]) * std::cos(ldp.q[3]), 1e-15);
}

}  // namespace
}  // namespace pushid
