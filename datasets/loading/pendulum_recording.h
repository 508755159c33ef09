// datasets: a recording seen as pendulums: the scene to roll out and the motion to compare with.
#pragma once

#include <string>
#include <vector>

#include "datasets/loading/foot_steps.h"
#include "datasets/manifest/recording.h"
#include "models/ipm.h"
#include "models/scene.h"
#include "models/skeleton_mapping.h"

namespace pushid {

// Platforms' measurement of one person at one frame, in the scene's axes.
struct PlateFrame {
  Eigen::Vector2d shear = Eigen::Vector2d::Zero();   // horizontal force on the person, N
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  // of pressure, less that at rest, m
  double weight = 0.0;                               // in [0, 1]
};

struct PendulumRecording : RecordingFacts {
  double facing = 0.0;                   // of its people before the push, rad from x; by the ankles
  std::vector<std::string> subject_ids;  // one per person
  std::vector<PersonFacts> known;        // one per person; empty: nothing is known of anybody
  Scene scene;
  // [person][frame]; velocities are backward differences, which is what semi-implicit Euler's qd
  // is.
  std::vector<std::vector<PendulumState<double>>> states;
  std::vector<std::vector<double>> rod_length;    // m
  std::vector<std::vector<Vector3<double>>> hip;  // m
  // Weight of each frame, in [0, 1]; [person] is empty where all of them count fully. A frame's
  // weight is the least of its own and the one before, which its velocity needs.
  std::vector<std::vector<double>> weight;
  // [person][frame]; [person] is empty where no platform measured, and all of it where none did.
  std::vector<std::vector<PlateFrame>> plates;
  std::vector<MassDistribution> masses;  // one per person, by the segments; empty: not known
  // One per person, from the feet; empty where a recording was not made from one.
  std::vector<PersonSteps> steps;
  std::string content_hash;  // of the files and of what the manifest makes of them

  int num_frames() const { return hip.empty() ? 0 : static_cast<int>(hip[0].size()); }
  double Weight(int person, int frame) const {
    const bool given = person < static_cast<int>(weight.size()) && !weight[person].empty();
    return given ? weight[person][frame] : 1.0;
  }
  int num_people() const { return static_cast<int>(hip.size()); }
  // false: platforms alone measured it, and nobody saw the motion.
  bool IsSeen() const { return Weight(0, 0) > 0.0; }
  // Change of the rod's length since frame 0, m.
  double RodChange(int person, int frame) const {
    return rod_length[person][frame] - rod_length[person][0];
  }
  bool HasPlates(int person) const {
    return person < static_cast<int>(plates.size()) && !plates[person].empty();
  }
  bool HasPlates() const {
    for (const std::vector<PlateFrame>& of_one : plates) {
      if (!of_one.empty()) return true;
    }
    return false;
  }
  bool StepsKnown() const { return !steps.empty(); }
  bool Stepped(int person) const { return StepsKnown() && steps[person].Stepped(); }
};

// Rod length and cart height are those of frame 0; the start velocity is zero or estimated, as the
// recording says (`free` starts from the estimate).
PendulumRecording MakePendulumRecording(const Recording& recording);
std::vector<PendulumRecording> MakePendulumRecordings(const std::vector<Recording>& recordings);

// The direction of the impulse on the pushed person, horizontal and of length 1; without a push
// that of the ground's farthest shift; x without either.
Eigen::Vector2d PushDirection(const PendulumRecording& recording);

// The scene in axes turned by so much about the vertical; forces at the recorded poses. The steps
// of the feet stay as they are.
Scene TurnedScene(const PendulumRecording& recording, double angle);
PendulumRecording Turned(PendulumRecording recording, double angle);

// Error: a key (of --flag) that is neither `other` nor a label of any recording; it names those.
MaybeError CheckLabel(const std::vector<PendulumRecording>& recordings, const std::string& flag,
                      const std::string& key, const std::string& other);

// The distribution of a body's mass, from its recorded segments.
//
// Masses, centres and radii of gyration of segments are the means of women and men in de Leva, J.
// Biomechanics 29, 1996, table 4. Of the 22 joints of a body (recording.h) all segments above the
// ankles are added up at frame 0, as they stand there. Where only shoulders are seen besides hip
// and ankles, legs are straight and head, arms and trunk are one segment whose centre is 0.6 of the
// way from hip to shoulders; where not even those are, the body is an average one
// (models/standing.h). What the manifest says of a person, or of a robot, comes first: how high the
// centre of mass is, and the radius of gyration about it (0 unless given), over the rod.
inline constexpr char kComOverRod[] = "com_over_rod", kGyrationOverRod[] = "gyration_over_rod";

// person: its joints where they were asked for (LoadOptions::keep_all_joints).
MassDistribution MassesOf(const RecordedPerson& person);

bool IsAverage(const MassDistribution& masses);

}  // namespace pushid
