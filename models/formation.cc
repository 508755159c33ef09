// models: who stands where in a formation, and pushes at the hip.
#include "models/formation.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace pushid {
namespace {

struct LatticePoint {
  int i = 0, j = 0;  // along x and y, in spacings
};

// The lattice points nearest to the centre by |i| + |j|, rings from the inside out.
std::vector<LatticePoint> DiamondPoints(int people) {
  int radius = 0;
  while (2 * radius * (radius + 1) + 1 < people) ++radius;
  std::vector<LatticePoint> points;
  for (int i = -radius; i <= radius; ++i) {
    const int reach = radius - std::abs(i);
    for (int j = -reach; j <= reach; ++j) points.push_back({i, j});
  }
  const auto key = [](const LatticePoint& p) {
    return std::tuple(std::abs(p.i) + std::abs(p.j), std::abs(p.j), p.i, p.j);
  };
  std::sort(points.begin(), points.end(),
            [&key](const LatticePoint& a, const LatticePoint& b) { return key(a) < key(b); });
  points.resize(people);
  return points;
}

std::vector<LatticePoint> Points(FormationShape shape, int people) {
  if (shape == FormationShape::kDiamond) return DiamondPoints(people);
  const int width = shape == FormationShape::kLine
                        ? 1
                        : static_cast<int>(std::ceil(std::sqrt(static_cast<double>(people))));
  std::vector<LatticePoint> points;
  for (int n = 0; n < people; ++n) points.push_back({n / width, n % width});
  return points;
}

}  // namespace

std::vector<Eigen::Vector2d> FormationPositions(FormationShape shape, int people, double spacing) {
  std::vector<LatticePoint> points = Points(shape, people);
  std::sort(points.begin(), points.end(), [](const LatticePoint& a, const LatticePoint& b) {
    return std::tie(a.i, a.j) < std::tie(b.i, b.j);
  });
  int right = 0, left = 0;
  for (const LatticePoint& point : points) {
    right = std::min(right, point.j);
    left = std::max(left, point.j);
  }
  const double middle = 0.5 * (right + left);
  std::vector<Eigen::Vector2d> positions;
  for (const LatticePoint& point : points) {
    positions.emplace_back(spacing * (point.i - points.front().i), spacing * (point.j - middle));
  }
  return positions;
}

Scene FormationScene(const std::vector<Eigen::Vector2d>& positions, const Body& body, double dt) {
  Scene scene;
  scene.dt = dt;
  for (const Eigen::Vector2d& position : positions) {
    ScenePerson person;
    person.body = body;
    person.start.q.head<2>() = position;
    scene.people.push_back(person);
  }
  return scene;
}

void AddHipPush(int person, const HipPush& push, Scene* scene) {
  const int frames = std::max(1, static_cast<int>(std::lround(push.duration / scene->dt)));
  const int start = static_cast<int>(std::lround(push.start / scene->dt));
  std::vector<Vector4<double>> rows =
      HalfSinePush(scene->people[person].body, push.impulse, frames, scene->dt);
  const ScenePerson& pushed = scene->people[person];
  for (Vector4<double>& row : rows) {
    const Vector3<double> force(row[0] * std::cos(push.direction),
                                row[0] * std::sin(push.direction), 0.0);
    row = GeneralizedForce(pushed.body, pushed.start.q, force, push.height);
    // The rows of a net push are all forces while it lasts, and hold the posture as well.
    if (push.kind != PushKind::kExternal) row += Gravity<double>(pushed.body, pushed.start.q);
  }
  scene->pushes.push_back(MakeScenePush(person, start, push.kind, std::move(rows)));
}

}  // namespace pushid
