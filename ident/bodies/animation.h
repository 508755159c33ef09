// ident: moving people as pictures: one web page with a time slider, and a strip of poses.
#pragma once

#include <string>
#include <vector>

#include "ident/bodies/body_files.h"
#include "ident/prediction/prediction.h"

namespace pushid {

// What a person does according to one source, with pendulum and net force where there are any.
struct AnimatedPerson {
  std::string name;
  bool recorded = false;              // else predicted
  BodyMotion body;                    // empty: pendulum only
  std::vector<Vector3<double>> cart;  // empty: none
  std::vector<Vector3<double>> tip;
  std::vector<Vector4<double>> force;  // net, generalized: N and N m; empty: none
};

struct Animation {
  std::string title;
  double dt = 1.0 / 60.0;  // s
  std::vector<AnimatedPerson> people;

  int num_frames() const;
};

// The pendulums and forces of all people of a prediction, with bodies where given (one per person,
// or none).
void AddPrediction(const PendulumRecording& recording, const Prediction& prediction,
                   const std::vector<BodyMotion>& bodies, Animation* animation);
// Bodies alone: recorded, or forecast without a pendulum.
void AddRecorded(const std::vector<std::string>& names, const std::vector<BodyMotion>& bodies,
                 Animation* animation);
void AddForecast(const std::vector<std::string>& names, const std::vector<BodyMotion>& bodies,
                 Animation* animation);

// One self-contained page: no network, no library. Play, time slider, orbit by mouse or touch,
// zoom by wheel, and what is shown by check boxes.
std::string AnimationHtml(const Animation& animation);

// `poses` moments from first to last frame, seen from the side (x to the right, z up), recorded
// bodies grey behind predicted ones in colour.
std::string PoseStripSvg(const Animation& animation, int poses);

}  // namespace pushid
