// Formations: who stands where, and which push does what to whom.
#include "models/formation.h"

#include <gtest/gtest.h>

#include <map>

namespace pushid {
namespace {

constexpr double kSpacing = 0.45;

// How many people stand in each row, from the back forwards.
std::vector<int> Rows(const std::vector<Eigen::Vector2d>& positions) {
  std::map<long, int> rows;
  for (const Eigen::Vector2d& p : positions) ++rows[std::lround(p.x() / kSpacing)];
  std::vector<int> counts;
  for (const auto& [row, count] : rows) counts.push_back(count);
  return counts;
}

TEST(Formation, RowsAreThoseOfTheShape) {
  const auto rows = [](FormationShape shape, int people) {
    return Rows(FormationPositions(shape, people, kSpacing));
  };
  using Counts = std::vector<int>;
  EXPECT_EQ(rows(FormationShape::kLine, 4), Counts({1, 1, 1, 1}));
  EXPECT_EQ(rows(FormationShape::kDiamond, 1), Counts({1}));
  EXPECT_EQ(rows(FormationShape::kDiamond, 5), Counts({1, 3, 1}));
  EXPECT_EQ(rows(FormationShape::kDiamond, 13), Counts({1, 3, 5, 3, 1}));
  EXPECT_EQ(rows(FormationShape::kDiamond, 7), Counts({1, 1, 3, 1, 1}));
  EXPECT_EQ(rows(FormationShape::kGrid, 9), Counts({3, 3, 3}));
  EXPECT_EQ(rows(FormationShape::kGrid, 10), Counts({4, 4, 2}));
}

TEST(Formation, PeopleAreNumberedFromTheBackAndStandApart) {
  for (FormationShape shape :
       {FormationShape::kLine, FormationShape::kDiamond, FormationShape::kGrid}) {
    for (int people = 1; people <= 45; ++people) {
      SCOPED_TRACE(people);
      const auto positions = FormationPositions(shape, people, kSpacing);
      ASSERT_EQ(positions.size(), static_cast<size_t>(people));
      EXPECT_EQ(positions[0].x(), 0.0);
      for (int n = 1; n < people; ++n) {
        EXPECT_GE(positions[n].x(), positions[n - 1].x());
        double nearest = 1e9;
        for (int j = 0; j < n; ++j) {
          nearest = std::min(nearest, (positions[n] - positions[j]).norm());
        }
        EXPECT_GT(nearest, kSpacing - 1e-9);
      }
    }
  }
}

TEST(Formation, EverybodyStandsStillAndUpright) {
  const Body body{70.0, 0.9, 0.08};
  const auto positions = FormationPositions(FormationShape::kGrid, 6, kSpacing);
  const Scene scene = FormationScene(positions, body, 0.01);
  ASSERT_EQ(scene.num_people(), 6);
  EXPECT_EQ(scene.dt, 0.01);
  for (int n = 0; n < 6; ++n) {
    const PendulumState<double>& start = scene.people[n].start;
    EXPECT_EQ(start.q.head<2>(), positions[n]);
    EXPECT_EQ(start.q.tail<2>().norm() + start.qd.norm(), 0.0);
    EXPECT_EQ(scene.people[n].body.mass, 70.0);
  }
}

TEST(Formation, PushesKeepTheirImpulseAtAnyFrameRate) {
  for (double fps : {30.0, 60.0, 144.0}) {
    Scene scene =
        FormationScene(FormationPositions(FormationShape::kLine, 3, kSpacing), Body(), 1.0 / fps);
    AddHipPush(1, {80.0, 0.5, 0.2}, &scene);
    AddHipPush(2, {30.0, 1.0, 0.0}, &scene);  // shorter than a frame: one frame
    ASSERT_EQ(scene.pushes.size(), 2u);
    const ScenePush& push = scene.pushes[0];
    EXPECT_EQ(push.person, 1);
    EXPECT_EQ(push.kind, PushKind::kExternal);
    EXPECT_EQ(push.start_frame, std::lround(0.5 * fps));
    double impulse = 0.0;
    for (const Vector4<double>& row : push.force) impulse += row[0] * scene.dt;
    EXPECT_NEAR(impulse, 80.0, 1e-9);
    EXPECT_EQ(scene.pushes[1].force.size(), 1u);
    EXPECT_NEAR(scene.pushes[1].force[0][0] * scene.dt, 30.0, 1e-9);
  }
}

// At once the hip goes where it is pushed, and the cart stays: the push acts at the hip.
TEST(Formation, APushActsAtTheHipInItsDirection) {
  const Body body{70.0, 0.9, 0.08};
  for (double degrees : {0.0, 45.0, 90.0, 180.0, 300.0}) {
    SCOPED_TRACE(degrees);
    const double direction = degrees * M_PI / 180.0;
    Scene scene = FormationScene({Eigen::Vector2d::Zero()}, body, 0.01);
    AddHipPush(0, {10.0, 0.0, 0.01, direction}, &scene);
    const Vector4<double> qdd =
        Acceleration<double>(body, PendulumState<double>(), scene.pushes[0].force[0]);
    EXPECT_LT(qdd.head<2>().norm(), 1e-9);
    const Eigen::Vector2d hip(body.rod_length * qdd[2], -body.rod_length * qdd[3]);
    const Eigen::Vector2d wanted = Eigen::Vector2d(std::cos(direction), std::sin(direction)) *
                                   (10.0 / 0.01 / body.point_mass());
    EXPECT_LT((hip - wanted).norm(), 1e-9 * wanted.norm());
  }
}

}  // namespace
}  // namespace pushid
