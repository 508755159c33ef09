// The neighbour grid finds what comparing everybody with everybody finds, and how people are
// numbered changes nothing.
#include "models/neighbours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "models/rollout.h"
#include "tests/models/model_samples.h"

namespace pushid {
namespace {

std::vector<int> AllPairs(const std::vector<Eigen::Vector2d>& at, const Eigen::Vector2d& reach,
                          int person) {
  std::vector<int> near;
  for (size_t n = 0; n < at.size(); ++n) {
    const Eigen::Vector2d apart = (at[n] - at[person]).cwiseAbs();
    if (static_cast<int>(n) != person && apart[0] < reach[0] && apart[1] < reach[1]) {
      near.push_back(static_cast<int>(n));
    }
  }
  return near;
}

TEST(NeighbourGrid, EqualsAllPairs) {
  Random random(1);
  for (int people : {1, 2, 12, 13, 50, 400}) {
    for (double spread : {0.1, 3.0, 1e6}) {
      std::vector<Eigen::Vector2d> at;
      for (int n = 0; n < people; ++n) {
        at.push_back({random.Uniform(-spread, spread), random.Uniform(-spread, spread)});
      }
      std::vector<int> rank(people);
      std::iota(rank.begin(), rank.end(), 0);
      NeighbourGrid grid(rank);
      const Eigen::Vector2d reach(0.4, 0.9);
      grid.Build(at, reach);
      std::vector<int> near;
      for (int n = 0; n < people; ++n) {
        const auto all = [](int) { return true; };
        grid.Near(n, 0, all, &near);
        std::vector<int> expected = AllPairs(at, reach, n);
        ASSERT_EQ(near, expected) << people << " people, spread " << spread;
        grid.Near(n, n + 1, all, &near);
        expected.erase(expected.begin(), std::upper_bound(expected.begin(), expected.end(), n));
        ASSERT_EQ(near, expected) << people << " people, spread " << spread;
      }
    }
  }
}

ParameterSet<double> CrowdParameters() {
  ParameterSet<double> p{};
  p[kMu] = 25.0, p[kKpTheta] = p[kKpPhi] = 1700.0, p[kKdTheta] = p[kKdPhi] = 80.0, p[kAx] = -9.0;
  p[kTailGain] = 1.0, p[kTailTime] = 0.2, p[kTailExponent] = 1.0;
  p[kContactStiffness] = 2000.0, p[kContactDistance] = 0.4, p[kContactKappa] = 0.6;
  p[kContactDamping] = 150.0, p[kContactHeight] = 0.5;
  p[kPotentialStrength] = 50.0, p[kPotentialLength] = 0.4, p[kNeighbourRange] = 0.5;
  p[kLeanTheta] = 20.0, p[kLeanPhi] = 20.0;
  return p;
}

Scene RandomCrowd(int people, Random* random) {
  Scene scene;
  for (int n = 0; n < people; ++n) {
    ScenePerson person;
    person.body = {random->Uniform(60, 100), random->Uniform(0.85, 1.0), 0.08};
    person.start.q = {0.42 * (n % 5) + random->Uniform(0, 0.02),
                      0.5 * (n / 5) + random->Uniform(0, 0.02), random->Uniform(-0.03, 0.03),
                      random->Uniform(-0.03, 0.03)};
    scene.people.push_back(person);
  }
  scene.pushes.push_back(MakeScenePush(0, 0, PushKind::kExternal,
                                       HalfSinePush(scene.people[0].body, 100.0, 12, scene.dt)));
  return scene;
}

TEST(NeighbourGrid, OrderOfPeopleNeverChangesTheRollout) {
  ModelOptions options;
  options.interaction.spring = options.interaction.damping = true;
  options.interaction.ldp_published = true;
  Random random(2);
  for (int people : {4, 20}) {
    const Scene scene = RandomCrowd(people, &random);
    // Person n of the other scene is person shuffled[n] of this one.
    std::vector<int> shuffled(people);
    std::iota(shuffled.begin(), shuffled.end(), 0);
    for (int i = people - 1; i > 0; --i) std::swap(shuffled[i], shuffled[random.Fork() % (i + 1)]);
    Scene other = scene;
    for (int n = 0; n < people; ++n) other.people[n] = scene.people[shuffled[n]];
    const auto pushed = std::find(shuffled.begin(), shuffled.end(), 0);
    other.pushes[0].person = static_cast<int>(pushed - shuffled.begin());

    RolloutPath<double> path, other_path;
    ASSERT_TRUE(
        Rollout<double>(scene, options, {CrowdParameters()}, InitialVelocities(scene), 60, &path)
            .ok);
    ASSERT_TRUE(Rollout<double>(other, options, {CrowdParameters()}, InitialVelocities(other), 60,
                                &other_path)
                    .ok);
    double farthest = 0.0;
    for (int t = 0; t < 60; ++t) {
      for (int n = 0; n < people; ++n) {
        ASSERT_EQ(other_path.At(t, n).q, path.At(t, shuffled[n]).q) << t << ", " << n;
        ASSERT_EQ(other_path.At(t, n).qd, path.At(t, shuffled[n]).qd) << t << ", " << n;
      }
    }
    for (int n = 1; n < people; ++n) {
      const double moved = path.At(59, n).q[0] - path.At(0, n).q[0];
      farthest = std::max(farthest, moved);
    }
    EXPECT_GT(farthest, 0.02);  // the push did travel
  }
}

TEST(Contact, MomentumIsPassedOnNotMade) {
  Random random(3);
  const Scene scene = RandomCrowd(6, &random);
  ModelOptions options;
  options.interaction.spring = options.interaction.damping = true;
  RolloutPath<double> path;
  FrameTable<NetForce<double>> trace;
  ASSERT_TRUE(Rollout<double>(scene, options, {CrowdParameters()}, InitialVelocities(scene), 60,
                              &path, &trace)
                  .ok);
  for (int t = 0; t < 60; ++t) {
    Vector4<double> sum = Vector4<double>::Zero();
    double largest = 0.0;
    for (int n = 0; n < 6; ++n) {
      sum += trace.At(t, n)[ForcePart::kInteraction];
      largest = std::max(largest, trace.At(t, n)[ForcePart::kInteraction].head<2>().norm());
    }
    EXPECT_LE(sum.head<2>().norm(), 1e-12 * std::max(1.0, largest));
  }
}

}  // namespace
}  // namespace pushid
