// datasets: steps of the feet: when they leave the ground, and how far off they land.
//
// A foot that rolls over its toe, turns on its heel or lifts its heel has a point that rests. So a
// foot moves as fast as the slowest of its recorded points (ankle; toe and heel where there are
// some), horizontally: it is off the ground while that speed stays above `moving`, and this is a
// step if it reaches `stepping` and every point goes at least `distance`. Speeds are slopes of
// lines fitted to +-50 ms, so that 2 mm of noise stays below 0.1 m/s at any rate.
//
// Rejected: ankles alone where toes are recorded (a heel lift moves the ankle by 1 to 15 cm and has
// it leave up to 0.2 s before the foot does), and heights (floors tilt, toes sink before they
// leave).
//
//   const PersonSteps steps = FindSteps(person, recording.fps);
//   if (const FootStep* first = steps.First()) ... first->lift_off / recording.fps ...
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "datasets/manifest/recording.h"
#include "models/enum_names.h"

namespace pushid {

enum class Foot { kLeft, kRight };
inline constexpr Foot kFeet[] = {Foot::kLeft, Foot::kRight};
constexpr EnumNames<Foot, 2> Names(Foot) {
  return {{{"left", Foot::kLeft}, {"right", Foot::kRight}}};
}

struct FootStep {
  Foot foot = Foot::kLeft;
  int lift_off = 0;      // the first frame off the ground; 0 where the recording starts so
  int landing = 0;       // the first frame on it again; the recording's end if not finished
  bool finished = true;  // false: still off the ground in the last frame
  // Travel of the ankle from the stance before to the one after (an unfinished step: to the last
  // frame), m forward and to the left: a foot's stride in gait analysis.
  Eigen::Vector2d travel = Eigen::Vector2d::Zero();

  double Length() const { return travel.norm(); }
  double Direction() const;  // rad from forward, positive to the left
};

struct StepThresholds {
  double moving;             // m/s: slower than this is standing
  double stepping;           // m/s that a step reaches
  double distance = 0.05;    // m that every point of the foot goes
  double duration_s = 0.08;  // the shortest step
  double pause_s = 0.05;     // shorter rests do not part two steps
};
inline constexpr StepThresholds kToeOrHeelToo{0.15, 0.3};
// An ankle alone swings over a toe that rests: what it does below these speeds is a heel lift.
inline constexpr StepThresholds kAnkleAlone{0.5, 0.7};

// m; more than noise of 8 mm, a camera that drifts by 3 cm and feet that are put down again do
// (tests/datasets/loading/foot_steps_test.cc).
inline constexpr double kTravelOfWhoMoves = 0.05;

// Steps of both feet, by lift-off.
struct PersonSteps {
  std::vector<FootStep> steps;
  // m, of the foot that went farther: from its place in the first 0.1 s to that in the last, by
  // the point of it that went least. Who slides or shuffles goes without a step.
  double travel = 0.0;

  bool Stepped() const { return !steps.empty(); }
  // Whether the feet stepped, or are elsewhere than they were.
  bool Moved() const { return Stepped() || travel > kTravelOfWhoMoves; }
  const FootStep* First() const { return steps.empty() ? nullptr : &steps.front(); }
  bool Stands(Foot foot, int frame) const;
};

// Frames with weight 0 were not seen, nor were positions that are not finite: a straight line
// replaces them, and a foot that is elsewhere after a short gap has stepped in it. Toes and heels
// may be empty.
PersonSteps FindSteps(const RecordedPerson& person, double fps);

// "0.31 m forwards"; also backwards, to the left, to the right: the nearest of them.
std::string TravelText(const Eigen::Vector2d& travel);

// "left 0.42-0.78 s 0.31 m forwards; right from 0.95 s 0.12 m to the left, cut off"; "none".
std::string StepsText(const PersonSteps& steps, double fps);

}  // namespace pushid
