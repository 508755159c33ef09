// models: the neighbours' numbers.
#include "models/restoration/neighbour_features.h"

#include <array>
#include <cmath>
#include <tuple>

#include "models/restoration/window_features.h"

namespace pushid {
namespace {

constexpr std::array<int, 6> kLags = {0, -12, -6, 6, 12, 24};
constexpr double kFurthest = 2.0;    // m
constexpr double kNearLength = 1.0;  // m

double Nearness(const Eigen::Vector2d& away) {
  return std::exp(-away.squaredNorm() / (kNearLength * kNearLength));
}

// 0 ahead, 1 behind, 2 to the left, 3 to the right.
int QuarterOf(const Eigen::Vector2d& away) {
  if (std::abs(away.x()) >= std::abs(away.y())) return away.x() >= 0.0 ? 0 : 1;
  return away.y() > 0.0 ? 2 : 3;
}

// Where the rod's tip goes (x, y).
FramePath<Eigen::Vector2d> TipPath(const Body& body, const FramePath<Vector4<double>>& turned,
                                   double dt) {
  std::vector<Eigen::Vector2d> tips;
  for (int t = 0; t < turned.num_frames(); ++t) {
    tips.emplace_back(HipPosition(body, turned.At(t)).head<2>());
  }
  return {std::move(tips), dt};
}

// Indices of the nearest in each quarter; -1: nobody.
std::array<int, kNeighbourQuarters> Nearest(const std::vector<RestorationInput>& people, int n,
                                            const Eigen::Matrix3d& turn) {
  std::array<int, kNeighbourQuarters> nearest;
  std::array<Eigen::Vector2d, kNeighbourQuarters> places;
  nearest.fill(-1);
  for (int k = 0; k < static_cast<int>(people.size()); ++k) {
    if (k == n) continue;
    const Eigen::Vector2d away = (turn * (TipAt(people[k], 0) - TipAt(people[n], 0))).head<2>();
    if (away.norm() > kFurthest) continue;
    const int quarter = QuarterOf(away);
    const auto rank = [](const Eigen::Vector2d& p) {
      return std::make_tuple(p.squaredNorm(), -p.y(), -p.x());
    };
    if (nearest[quarter] >= 0 && rank(away) >= rank(places[quarter])) continue;
    nearest[quarter] = k;
    places[quarter] = away;
  }
  return nearest;
}

}  // namespace

Eigen::MatrixXf NeighbourInputs(const std::vector<RestorationInput>& people, int n) {
  const RestorationInput& person = people[n];
  const double heading = Heading(person.first_pose);
  const auto nearest = Nearest(people, n, TurnAboutZ(-heading));
  const auto own = TipPath(person.body, TurnedPath(person, heading), person.dt);
  const double frames_per_lag = 1.0 / (kWindowLagRate * person.dt);
  const int frames = static_cast<int>(person.q.size());
  Eigen::MatrixXf inputs = Eigen::MatrixXf::Zero(kNeighbourInputs, frames);
  for (int quarter = 0; quarter < kNeighbourQuarters; ++quarter) {
    if (nearest[quarter] < 0) continue;
    const RestorationInput& other = people[nearest[quarter]];
    const FramePath<Vector4<double>> path = TurnedPath(other, heading);
    const auto tip = TipPath(other.body, path, other.dt);
    const auto away_at = [&](double frame) -> Eigen::Vector2d {
      return tip.At(frame) - own.At(frame);
    };
    const Eigen::Vector2d first = away_at(0.0);
    for (int t = 0; t < frames; ++t) {
      auto column = inputs.col(t).segment(quarter * kNumbersPerNeighbour, kNumbersPerNeighbour);
      int row = 0;
      const auto add = [&column, &row](double value) { column[row++] = static_cast<float>(value); };
      add(first.x()), add(first.y()), add(other.body.rod_length), add(Nearness(first));
      for (const int lag : kLags) {
        const Eigen::Vector2d away = away_at(t + lag * frames_per_lag);
        add(away.x() - first.x()), add(away.y() - first.y()), add(Nearness(away));
      }
      const Eigen::Vector2d velocity = tip.RateAt(t) - own.RateAt(t);
      add(velocity.x()), add(velocity.y());
      add(path.At(t)[2]), add(path.At(t)[3]);
    }
  }
  return inputs;
}

}  // namespace pushid
