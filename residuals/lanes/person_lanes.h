// residuals: rollouts of people alone, of sliding feet, side by side in the vectors of a processor:
// their normal equations, once for each width of vectors, and the choice of the widest at run time
// as in kernels/vector_kernels.h.
//
// The equations are those of the models' templates (ipm.h, self_terms.h, push.h) and of
// frame_residual.h, whose scalar is a lane each of a vector. All arrays of numbers end in the lane:
// [..][lane].
#pragma once

#include <vector>

#include "models/options.h"
#include "models/scene.h"
#include "models/self_terms.h"
#include "residuals/frame_residual.h"
#include "residuals/kernels/vector_kernels.h"
#include "residuals/parameter_map.h"

namespace pushid {

// Fields of one step of one person.
enum LaneField {
  kLaneHip = 0,       // 3: measured
  kLanePose = 3,      // 4: q, measured
  kLaneVelocity = 7,  // 4: qd, measured
  kLaneWeight = 11,   // on the residual
  kLanePush = 12,     // 4: generalized force
  kLaneActs = 16,     // 1 where the own forces act, 0 where the push replaces them
  kLaneSlides = 17,   // 1 where friction acts
  kLaneGoesOn = 18,   // 1 where the rollout has a next frame
  kLaneFields
};
// Fields of one person.
enum LaneConstant {
  kLaneMass = 0,
  kLaneRod,
  kLaneHeight,
  kLanePointShare,
  kLanePendulumRatio,
  kLaneScale,                     // 3: of GainScaleOf
  kLanePosture = kLaneScale + 3,  // 2
  kLaneHold = kLanePosture + 2,   // 2
  kLaneStep = kLaneHold + 2,      // s
  kLaneStart,                     // 8: q and qd at frame 0
  kLaneConstants = kLaneStart + 8
};
// Fields of one tail.
enum LaneTail { kLaneMean = 0, kLaneMassPerForce = 4, kLaneLogDuration, kLaneEnd, kLaneTails };
inline constexpr int kLaneParameters = kContactStiffness;  // those of a person alone come first

struct LaneEntry {
  int column;
  int parameter;
};

enum class LaneSums {
  kStates,   // no residuals: [q, qd] frame by frame, and its derivatives where there are columns
  kNone,     // r alone, frame by frame from frame 1 on, without the robust loss's weight
  kSquares,  // r'r alone
  kPlain,    // [J r]'[J r]
  kRobust    // and that with the robust loss's own Hessian (CorrectForRobustLoss)
};

// The rollouts that are asked for, and their numbers.
struct LaneRequest {
  LaneSums sums = LaneSums::kStates;
  int frames = 0;            // of the longest rollout
  int columns = 0;           // P
  int velocity_column = -1;  // as in SensitivityInputs
  int first_state = 0;       // the first frame of those that kStates hands out
  ResidualSigmas sigmas = {};
};

// The request with what LaneTables knows.
struct LaneInputs : LaneRequest {
  FrictionKind friction = FrictionKind::kIsotropic;
  int num_entries = 0, num_tails = 0;
  const LaneEntry* entries = nullptr;  // in ascending order of column
  const double* slopes = nullptr;      // of entries
  const double* constants = nullptr;   // kLaneConstants
  const double* parameters = nullptr;  // kLaneParameters
  const double* tails = nullptr;       // num_tails x kLaneTails
  int num_steps = 0;                   // later frames are as the last of them
  const double* steps = nullptr;       // num_steps x kLaneFields
};

struct LaneOutputs {
  double* failed = nullptr;     // 1 where a rollout left the domain
  double* squares = nullptr;    // r'r
  double* residuals = nullptr;  // (frames - 1) x kFrameResiduals, where nothing is summed up
  double* plain = nullptr;      // (P + 1) x (P + 1), the upper triangle
  double* robust = nullptr;     // as plain
  double* states = nullptr;     // (frames - first_state) x (1 + P) x 8; the last within the domain
  double* storage = nullptr;    // LaneStorage
};

// Doubles that a rollout needs besides.
constexpr int LaneStorage(int lanes, int columns, int tails) {
  const int size = columns + 1;
  return lanes * (8 * columns + kFrameResiduals * size + 2 * size * size + 2 * tails + 1);
}

struct PersonLanes {
  int bits;  // of a vector
  int lanes;
  void (*roll)(const LaneInputs& in, const LaneOutputs& out);
};

PUSHID_WIDTHS(PersonLanes);

// The narrowest in which so many people have room; the widest where they do not.
const PersonLanes& PersonLanesFor(int people);

// Whether a scene can be rolled out so: one person, of sliding feet, with no force that remembers
// or that a user brings.
bool HasLanes(const Scene& scene, const ModelOptions& options);

// One person at a point.
struct LanePerson {
  ParameterSet<double> parameters;
  // In ascending order of column, of the same columns and parameters in every lane; none without
  // derivatives.
  std::vector<ColumnEntry> entries;
  const double* velocity = nullptr;  // at frame 0; null: the scene's
};

// The numbers that LaneOutputs has.
struct LaneResults {
  std::vector<double> failed, squares, residuals, plain, robust, states;
};

class LaneTables {
 public:
  // num_tails: the most that one of them has. steps: those that differ, where frames after are as
  // the last of them.
  LaneTables(const PersonLanes& lanes, int num_tails, int steps);

  // Puts a scene into a lane. All lanes share their options but for the tail.
  void Set(int lane, const Scene& scene, const ModelOptions& options, int frames);
  void SetMeasured(int lane, int frame, const Vector3<double>& hip,
                   const PendulumState<double>& state, double weight);

  int width() const { return lanes_->lanes; }
  // people: one for each lane that is set.
  void Roll(const LaneRequest& request, const std::vector<LanePerson>& people,
            LaneResults* results) const;

 private:
  void SetSteps(int lane, const Scene& scene, const ModelOptions& options, int frames);
  void SetTails(int lane, const Scene& scene, const ModelOptions& options);
  double* Step(int lane, int frame) { return steps_.data() + frame * kLaneFields * width() + lane; }
  double& Constant(int id, int lane) { return constants_[id * width() + lane]; }

  const PersonLanes* lanes_;
  int num_tails_, num_steps_;
  FrictionKind friction_ = FrictionKind::kIsotropic;
  std::vector<double> constants_, steps_, tails_;
};

// Steps that differ where nothing is measured: until all pushes have ended.
int NumSteps(const Scene& scene, int frames);
// Pushes on the person with a tail.
int NumTails(const Scene& scene, const ModelOptions& options);

}  // namespace pushid
