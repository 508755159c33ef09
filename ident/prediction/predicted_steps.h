// ident: when people step in a predicted path, for how long and how far.
//
// A path with step states (models/stance.h) says of a person, not of a foot, how much the feet are
// let go. A stepping phase begins with the first frame in which the state is above 0.85, where feet
// begin to move, and lasts until it falls below 0.75: a state that flickers makes one phase. It may
// hold several steps of a real person: compare its beginning with the recorded first lift-off
// (datasets/loading/foot_steps.h); its travel is the cart's, not a foot's.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/prediction/prediction.h"

namespace pushid {

struct SteppingPhase {
  int lift_off = 0;      // the first frame that steps
  int landing = 0;       // the first frame that stands again; the path's end if not finished
  bool finished = true;  // false: still stepping in the last frame
  Eigen::Vector2d travel = Eigen::Vector2d::Zero();  // of the cart, lift-off to landing, m
};

std::vector<SteppingPhase> SteppingPhases(const RolloutPath<double>& path, int person);

// Whether somebody stands, frame by frame; empty where the path has no step states.
std::vector<bool> StandingFrames(const Prediction& prediction, int person);

// A line per person: "S01: P(step) 0.93, steps from 0.42 s to 0.95 s, 0.31 m forwards"; empty
// where the model says nothing of steps.
std::string PredictedStepsText(const PendulumRecording& recording, const Prediction& prediction);

}  // namespace pushid
