// ident: moving people as one web page with a time slider, which needs no other file.
#pragma once

#include <string>
#include <vector>

#include "ident/bodies/body_recording.h"
#include "ident/prediction/predicted_steps.h"

namespace pushid {

// A person's motion by one source, with pendulum and net force where there are any.
struct AnimatedPerson {
  std::string name;
  bool recorded = false;  // else predicted
  // Joints of a body (SetBody), or of a file's skeleton that lacks some of a body, frame by frame,
  // with their parents (-1: none); empty: none. head: of a body; -1: none.
  std::vector<Eigen::Matrix3Xd> joints;
  std::vector<int> parents;
  int head = -1;
  std::vector<Vector3<double>> cart;  // empty: none
  std::vector<Vector3<double>> tip;
  std::vector<Vector4<double>> force;  // net, generalized: N and N m; empty: none
  std::vector<Footprint> footprints;   // empty: unknown
  double facing = 0.0;                 // of the feet, rad from x
  std::string what;                    // of a what-if: "mu=10"; empty: the model as it was fitted

  void SetBody(const BodyMotion& body);
};

// A push as it is drawn: whom it meets, and its force (x, y: N) from a frame on.
struct AnimatedPush {
  std::string person;
  int start = 0;
  std::vector<Vector4<double>> force;
};

struct Animation {
  std::string title;
  double dt = 1.0 / 60.0;  // s
  std::vector<AnimatedPerson> people;
  std::vector<AnimatedPush> pushes;
  std::string told;                  // words beside the motion; may be empty
  std::vector<std::string> figures;  // SVG, below the motion

  int num_frames() const;
};

// The what-ifs in the order of their first person; the model as it was fitted is "".
std::vector<std::string> WhatsOf(const Animation& animation);
inline constexpr char kAsFitted[] = "as fitted";  // how a reader sees ""

// The pendulums and forces of all people of a prediction, with bodies where given (one per person,
// or none). what: names a what-if.
void AddPrediction(const PendulumRecording& recording, const Prediction& prediction,
                   const std::vector<BodyMotion>& bodies, Animation* animation,
                   const std::string& what = "");
void AddPushes(const PendulumRecording& recording, Animation* animation);
// Pendulums of all people, with bodies where given.
void AddRecorded(const PendulumRecording& recording, const std::vector<BodyMotion>& bodies,
                 Animation* animation);
// Bodies without a pendulum.
void AddForecast(const std::vector<std::string>& names, const std::vector<BodyMotion>& bodies,
                 Animation* animation);

// One self-contained page: no network, no library; of several animations one is chosen by its
// title. sample_seconds: between positions that are written and those between them interpolated,
// for small files; 0: every frame. Words and figures are the first animation's. Play, time slider,
// orbit by mouse or touch, zoom by wheel, and what is shown by check boxes. Feet that step leave
// their prints, with the times of landings, which fade when they leave. The ground has marks in
// metres from where the pushed person starts; a group is seen from above as well.
std::string AnimationHtml(const std::vector<Animation>& animations, double sample_seconds = 0.0);

// Colours that the colour-blind tell apart, on light and on dark paper: of people, or of what-ifs
// where there are some. A push is orange, so none of them is.
inline constexpr const char* kAnimationColours[] = {"#2a78c8", "#009e73", "#cc79a7",
                                                    "#a08000", "#56b4e9", "#7a5fd0"};

// Distances from an ankle to the ends of a foot as it is drawn, m.
inline constexpr double kSoleBehind = 0.06, kSoleBefore = 0.19;

}  // namespace pushid
