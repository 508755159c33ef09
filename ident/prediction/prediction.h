// ident: the motion that a model predicts in a scene.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/model/fitted_model.h"
#include "ident/model/identified_model.h"
#include "ident/model/model_rollout.h"
#include "models/net_force.h"
#include "models/restoration/body.h"

namespace pushid {

// The predicted step of one person (fit/step_probability.h).
struct PredictedStep {
  double margin = 0.0;  // m
  double probability = 0.0, error = 0.0;
};

// The band of one person's hip, from the first unseen frame on, m.
struct HipBand {
  std::vector<Vector3<double>> lower90, upper90;
};

struct Prediction {
  RolloutStatus status;
  RolloutPath<double> path;                       // frames before a failure are valid
  ForceTrace forces;                              // forces that drove it, part by part
  std::vector<ForcePart> parts;                   // parts that reports list
  std::vector<std::vector<Vector3<double>>> hip;  // [person][frame], m; empty after a failure
  bool rod_moves = false;
  bool feet_step = false;  // the path has feet that step
  // One value per person; empty after a failure and where the model has no step probability.
  std::vector<PredictedStep> steps;
  // Number of first frames that were seen (online_predictor.h), frame 0 among them, and a band for
  // each person; 0 and none where none were.
  int observed = 0;
  std::vector<HipBand> bands;

  // A person with the rod of one frame.
  Body BodyAt(const Scene& scene, int frame, int person) const {
    const Body& body = scene.people[person].body;
    return rod_moves ? BodyNow(body, path.At(frame, person).rod) : body;
  }
};

// The rollout from frame 0 and the push alone. num_frames: 0 means as many as the recording has.
Prediction Predict(const IdentifiedModel& model, const PendulumRecording& recording,
                   int num_frames = 0);

// Writes frame, time and, per person, q, qd, hip and the net force with its parts as CSV, and the
// rod's length and the cart's height where the model has a law for them;
// after a failure, the frames before it. On ground that moves, as the laboratory sees it.
MaybeError WriteTrajectoryCsv(const std::string& path, const PendulumRecording& recording,
                              const Prediction& prediction);

// Warnings about recordings that a model is to predict, for GroupedWarnings: units that look wrong,
// people who touch although the model has no contact, pushes beyond those of the fit.
Warnings InputWarnings(const IdentifiedModel& model,
                       const std::vector<PendulumRecording>& recordings);

// A recording whose people are pushed harder, or again.
//
//   ChangedPushes changed;
//   changed.scale = 1.37;      // every force and torque times so much
//   changed.again = {40, {80, 2.0}};  // the push comes three times, at last twice as hard
//   if (MaybeError error = CheckChangedPushes(changed, recording, frames)) ...
//   Predict(model, WithPushes(recording, changed), frames);
//
// A push that comes again is the recorded one, on the same person at the same height, and starts at
// that frame; of several pushes, all come again at their distances. The recorded motion is no
// reference for what follows.

struct PushAgain {
  int frame;
  double times;  // as strong as the first
  PushAgain(int at, double strength = 1.0) : frame(at), times(strength) {}
};

struct ChangedPushes {
  double scale = 1.0;
  std::vector<PushAgain> again;  // frames ascending

  bool Any() const { return scale != 1.0 || !again.empty(); }
};

// The options are named --push_scale and --push_again. frames: how many are predicted. Errors: a
// scale or strength that is not positive; nothing to change; a push that begins before the one
// before it has ended (a net force says nothing of two at once), or after the prediction.
MaybeError CheckChangedPushes(const ChangedPushes& changed, const PendulumRecording& recording,
                              int frames);

// The recording with other pushes; all else stays, the recorded motion too.
PendulumRecording WithPushes(PendulumRecording recording, const ChangedPushes& changed);

// "1.37 times the recorded push, at frames 0, 40 and 80 (2 times)".
std::string ChangedPushesText(const ChangedPushes& changed, const PendulumRecording& recording);

// Motion on ground that moves, as the laboratory sees it: for files and pictures. Errors are the
// same in either.

struct PredictiveBands;

// Nothing changes where the ground does not move. Paths, hips; net forces get the part of inertia.
Prediction InLaboratory(const PendulumRecording& recording, Prediction prediction);
PendulumRecording InLaboratory(PendulumRecording recording);
void ToLaboratory(const Scene& scene, std::vector<BodyMotion>* bodies);
void ToGround(const Scene& scene, std::vector<BodyMotion>* bodies);  // and back
void ToLaboratory(const Scene& scene, PredictiveBands* bands);

}  // namespace pushid
