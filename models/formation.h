// models: people standing in a line, a diamond or a grid, and the pushes that travel through them.
//
// Pushes go along +x, so people are numbered from the back (smallest x) forwards, and within a row
// from the right (smallest y) to the left: person 0 is the one, or among the ones, pushed first.
// The formation is centred on y = 0 as a whole (a last row that is not full stands to the right);
// the first row stands at x = 0.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/enum_names.h"
#include "models/scene.h"

namespace pushid {

enum class FormationShape {
  kLine,     // one behind the other
  kDiamond,  // a square lattice turned on its corner: rows of 1, 3, 5, 3, 1 for 13 people
  kGrid      // near-square: as many rows as people in a row, or one fewer
};
constexpr EnumNames<FormationShape, 3> Names(FormationShape) {
  return {{{"line", FormationShape::kLine},
           {"diamond", FormationShape::kDiamond},
           {"grid", FormationShape::kGrid}}};
}

// Cart positions (x, y), m. Neighbours stand `spacing` apart. A diamond is whole for 1, 5, 13, 25,
// 41 ... people; in between its outermost ring is filled from the corners on the x axis outwards.
std::vector<Eigen::Vector2d> FormationPositions(FormationShape shape, int people, double spacing);

// People upright and at rest, all with the same body.
Scene FormationScene(const std::vector<Eigen::Vector2d>& positions, const Body& body, double dt);

// A half-sine; of a net push the rows, which the model's tail follows.
struct HipPush {
  double impulse = 0.0;    // N s
  double start = 0.0;      // s
  double duration = 0.2;   // s
  double direction = 0.0;  // rad from +x, positive to the left
  double height = 1.0;     // of the rod: the hip
  PushKind kind = PushKind::kExternal;
};

// Start and duration are rounded to frames; the impulse is kept.
void AddHipPush(int person, const HipPush& push, Scene* scene);

}  // namespace pushid
