// models: groups continued by diffusion. The people of one call are a group; frame 0 is the first
// observed frame, and the push is the sum of the people's controls.
//
// Sampling starts from noise at T and removes it in some steps; after every step the observed
// frames replace the network's estimate of them (Eq. 6 of SDM). Networks of several seeds take
// turns, sample by sample. The forecast is the mean of several samples, because the mean joint
// error favours a mean; every other sample is of the mirrored group, for which the network's errors
// differ. Recordings end before people stand still: after the length of the longest training
// recording, the predicted motion fades until people rest. Where a pendulum predicts the hip, the
// bodies are moved part of the way to it (`blend`). Finally each body is post-processed as restored
// bodies are (postprocess.h): the jump at the last observed frame fades, bones keep their length of
// frame 0, and resting feet stay in place.
//
// Noise is drawn in the order of people's places, so that the order of people does not matter.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "models/enum_names.h"
#include "models/generators/motion_generator.h"
#include "models/restoration/body.h"
#include "models/restoration/dense_network.h"
#include "models/restoration/postprocess.h"

namespace pushid {

// The network that estimates a group's motion from a noisy one (after Tanke et al., "Social
// Diffusion", ICCV 2023, called SDM), without its training.
//
//   level 0        x_t and what is given, T frames
//   down 1..4      blocks of 64, 64, 96, 96 channels, each with half the frames
//   middle         a block of 96
//   up 3..1        blocks of 96, 64, 64: the frames doubled, beside the level's own of the way down
//   out            the frames doubled once more: conv3, and a linear map of level 0
//
//   block(x)  = SiLU(conv3(FiLM(SiLU(conv3(x))))) + conv1(x)
//   FiLM(y)   = y (1 + g) + b, [g, b] linear in SiLU(MLP(sines of t) + MLP(the person's statics))
//   pooled(y) = [y, sums over the others of a y_other], y: each level's output on the way down, as
//               input of the middle and of the way up; people see nothing else of each other
//
// Convolutions over time are causal (frames t-2, t-1, t), and so is the doubling of frames, so that
// later frames never change earlier ones and a motion may be longer than those of the training.
// People are a set: a weight `a` depends on the two people alone. Rejected: one column with the
// features of all people, which fixes their number.

// The rows that the network reads and writes for a group of people.
//
//   motion    66 rows: hip(t) - hip(0), then (joint - hip)(t) - (joint - hip)(0), each over the
//             joint's scale; rotations stay in, because all people face the way of the push;
//             or, in people's own frames (SDM): hip(t) - hip(0), joint - hip turned to face +x, and
//             cosine and sine of the heading, each with zero mean and unit variance
//   given     the observed motion (0 where nothing is observed), 1 in observed frames, and the push
//             on the group over 10 N/kg
//   statics   per person: joints relative to the hip at frame 0 (a spread of 1/2), place relative
//             to the pushed person, height of the hip above 1 m, mass / 80 kg - 1, whether pushed,
//             the push's impulse per mass, its duration
//
// Columns of motion and given: the frames of the first person, then those of the next.

inline constexpr int kMotionRows = 3 * kBodyJoints;
inline constexpr int kPushRows = 4;
inline constexpr int kFirstPoseRows = 3 * (kBodyJoints - 1);
inline constexpr int kStaticRows = kFirstPoseRows + 2 + 1 + 1 + 1 + kPushRows + 1;
inline constexpr int kOwnFrameRows = kMotionRows + 2;
inline int GivenRows(int motion_rows = kMotionRows) { return motion_rows + 1 + kPushRows; }

enum class MotionFrame { kGroup, kOwn };
constexpr EnumNames<MotionFrame, 2> Names(MotionFrame) {
  return {{{"group", MotionFrame::kGroup}, {"own", MotionFrame::kOwn}}};
}

using JointScales = Eigen::Matrix<float, kBodyJoints, 1>;  // m, by joint

// Units of a motion's rows, and the frame that they are in.
struct MotionScales {
  MotionScales() = default;
  // Scales of joints in the group's frame.
  template <typename OfJoints>
  MotionScales(const Eigen::MatrixBase<OfJoints>& of_joints) : joints(of_joints) {}

  JointScales joints = JointScales::Ones();
  // Scaling of joints seen from the hip at frame 0.
  Scaling first_pose = {Eigen::VectorXf::Zero(kFirstPoseRows),
                        Eigen::VectorXf::Ones(kFirstPoseRows)};
  Eigen::VectorXf mean, spread;  // of people's own frames, kOwnFrameRows; otherwise empty

  bool own_frames() const { return mean.size() > 0; }
  int rows() const { return own_frames() ? kOwnFrameRows : kMotionRows; }
};
MotionScales MotionScalesOf(const std::vector<std::vector<ObservedMotion>>& groups,
                            MotionFrame frame);

struct GroupFeatures {
  int people = 0, frames = 0;
  Eigen::MatrixXf given;    // GivenRows x (people * frames)
  Eigen::MatrixXf statics;  // kStaticRows x people
  Eigen::Matrix2Xf places;  // m
};

// observed: number of frames shown; frames: of the whole motion.
GroupFeatures FeaturesOf(const std::vector<ObservedMotion>& group, const MotionScales& scales,
                         int observed, int frames, double dt);

Eigen::MatrixXf MotionRows(const ObservedMotion& person, const MotionScales& scales);
// The inverse of MotionRows; hip(0) and the first pose are the person's.
Trajectories FromMotionRows(const Eigen::MatrixXf& rows, const ObservedMotion& person,
                            const MotionScales& scales);

// A change that makes another plausible group: mirrored, turned about z, scaled.
struct GroupChange {
  bool mirrored = false;
  double turn = 0.0;  // rad
  double size = 1.0;
};
std::vector<ObservedMotion> Changed(const std::vector<ObservedMotion>& group,
                                    const GroupChange& change);

// local      exp(-(d / 0.8 m)^2), separately for people ahead and behind (a logistic of
//            dx / 0.1 m), each over its sum + 0.1; d, dx: between the places at frame 0
// none       people do not see each other
// mean_all   the mean over everybody, oneself included (SDM)
// heads      attention of four heads with values of their own, oneself included (SDM)
enum class SocialPooling { kLocal, kNone, kMeanAll, kHeads };
constexpr EnumNames<SocialPooling, 4> Names(SocialPooling) {
  return {{{"local", SocialPooling::kLocal},
           {"none", SocialPooling::kNone},
           {"mean_all", SocialPooling::kMeanAll},
           {"heads", SocialPooling::kHeads}}};
}

// The levels at which people see each other: in the middle and on the whole way up, or in the
// middle alone (SDM).
enum class SocialJoin { kLevels, kBottleneck };
constexpr EnumNames<SocialJoin, 2> Names(SocialJoin) {
  return {{{"levels", SocialJoin::kLevels}, {"bottleneck", SocialJoin::kBottleneck}}};
}

struct DiffusionStructure {
  SocialPooling pooling = SocialPooling::kLocal;
  SocialJoin join = SocialJoin::kLevels;
  MotionFrame frame = MotionFrame::kGroup;

  int NumViews() const { return pooling == SocialPooling::kLocal ? 2 : 1; }
  bool PoolsAfter(int block) const;
  bool AttendsAfter(int block) const {
    return pooling == SocialPooling::kHeads && PoolsAfter(block);
  }
  int NumMotion() const { return frame == MotionFrame::kOwn ? kOwnFrameRows : kMotionRows; }
  int NumInputs() const { return NumMotion() + GivenRows(NumMotion()); }
};

inline constexpr int kDiffusionLevels = 4, kDiffusionBlocks = 8;  // four down, middle, three up
inline constexpr int kDiffusionFrames = 1 << kDiffusionLevels;    // frames come in multiples
inline constexpr int kDownWidths[kDiffusionLevels] = {64, 64, 96, 96};
inline constexpr int kTimeWidth = 64, kConditionWidth = 96;
inline constexpr int kHeads = 4;  // of SocialPooling::kHeads
inline constexpr int kTaps = 3;   // frames that a convolution sees
// Numbers of channels.
struct BlockWidths {
  int in = 0, out = 0;
};
BlockWidths WidthsOf(int block, const DiffusionStructure& structure);

inline bool DiffusionStructure::PoolsAfter(int block) const {
  if (pooling == SocialPooling::kNone || block >= kDiffusionLevels) return false;
  return join == SocialJoin::kLevels || block == kDiffusionLevels - 1;
}

// Weights of a convolution: outputs x (3 inputs), the oldest frame first.
struct DiffusionBlock {
  DenseLayer first, second, skip, film;
};
struct DiffusionPool {
  DenseLayer query, key, value, mixed;
};

struct DiffusionNetwork {
  DiffusionStructure structure;
  MotionScales scales;
  DenseLayer first_time, second_time, first_static, second_static;
  std::vector<DiffusionBlock> blocks;
  std::vector<DiffusionPool> pools;  // one for each block with AttendsAfter
  DenseLayer out, direct;
};

// Weights by which person i (row) sees person j (column), a matrix for each view; empty for kNone
// and kHeads.
std::vector<Eigen::MatrixXf> PoolingWeights(SocialPooling pooling, const Eigen::Matrix2Xf& places);

// Sines and cosines of t at 32 frequencies.
Eigen::VectorXf TimeFeatures(double t);

// The network for one group; everything that does not depend on t or x_t is computed once.
class GroupDenoiser {
 public:
  GroupDenoiser(const DiffusionNetwork& network, GroupFeatures features);
  // The estimate of x_0; both NumMotion() x (people * frames).
  Eigen::MatrixXf Estimate(const Eigen::MatrixXf& noisy, double t) const;

 private:
  // Values are channels x (people * frames).
  int FramesOf(const Eigen::MatrixXf& values) const;
  // conditions: input of FiLM, a column per person.
  Eigen::MatrixXf Block(int index, const Eigen::MatrixXf& in,
                        const Eigen::MatrixXf& conditions) const;
  // The values, and below them the sums over the others.
  Eigen::MatrixXf Pooled(int index, const Eigen::MatrixXf& values) const;
  Eigen::MatrixXf Attended(const DiffusionPool& pool, const Eigen::MatrixXf& values) const;
  Eigen::MatrixXf Doubled(const Eigen::MatrixXf& values) const;

  const DiffusionNetwork& network_;
  GroupFeatures features_;
  int frames_;               // padded
  Eigen::MatrixXf statics_;  // kConditionWidth x people
  std::vector<Eigen::MatrixXf> views_;
};

void ListTensors(const std::string& prefix, DiffusionNetwork* network, TensorFields* fields);

// Forward noise, and its removal.
//
//   x_t = sqrt(a_t) x_0 + sqrt(1 - a_t) e,  e ~ N(0, 1)
//   a_t = f(t) / f(0),  f(t) = cos^2((t / T + s) / (1 + s) pi / 2)   the cosine schedule, s = 0.008
//
// The network estimates x_0 itself, and fresh noise of an earlier time u is added to the estimate
// (Eq. 5 of SDM). Rejected: the posterior of x_u given x_t and x_0 (DDPM), whose errors are the
// same or larger.

inline constexpr int kDiffusionTime = 1000;  // T

// a_t; 1 at t = 0, 0 at t = T.
inline double SignalShare(double t) {
  constexpr double kOffset = 0.008;
  const auto f = [](double time) {
    return std::pow(std::cos((time / kDiffusionTime + kOffset) / (1.0 + kOffset) * M_PI_2), 2);
  };
  return std::clamp(f(t) / f(0.0), 0.0, 1.0);
}

// Eq. 6 of SDM: observed frames replace their estimates. past: each person's MotionRows of them.
void PutPast(const std::vector<Eigen::MatrixXf>& past, Eigen::MatrixXf* estimate);

// Eq. 5: x_u of an estimate of x_0.
Eigen::MatrixXf NoisedAgain(const Eigen::MatrixXf& estimate, const Eigen::MatrixXf& noise,
                            double u);

struct DiffusionGeneratorOptions {
  int steps = 25;
  int averaged = 8;         // samples of a forecast
  bool mirrored = true;     // every other sample is of the mirrored group
  int learnt_frames = 128;  // length of the longest training recording
  bool settle = true;       // fade the motion after learnt_frames; false as in SDM
  double settling = 0.5;    // s, in which later displacements fade to 1/e
  double blend = 0.0;       // share of the way to the pendulum's hip
  PostprocessOptions postprocess = {true, 20};
  // Keeps the samples of Forecast, for further forecasts of the same people with another blend or
  // post-processing.
  std::shared_ptr<std::vector<Trajectories>> sampled = nullptr;
};

class DiffusionGenerator : public MotionGenerator {
 public:
  // noise: makes a source that restarts its sequence, so that forecasts repeat; dt: s.
  DiffusionGenerator(ParticleLayout layout, std::vector<DiffusionNetwork> members, double dt,
                     const DiffusionGeneratorOptions& options, std::function<NormalSource()> noise);

  const ParticleLayout& layout() const override { return layout_; }
  std::vector<Trajectories> Forecast(const std::vector<ObservedMotion>& people,
                                     int frames) const override;

 private:
  // One sample of everybody's whole motion, before post-processing.
  std::vector<Trajectories> SampleWhole(const std::vector<ObservedMotion>& people,
                                        const DiffusionNetwork& network, int frames,
                                        const NormalSource& normal) const;
  std::vector<Trajectories> SampledMean(const std::vector<ObservedMotion>& people,
                                        int frames) const;
  const DiffusionNetwork& Member(int sample) const { return members_[sample % members_.size()]; }
  // The post-processed frames after the observed ones.
  Trajectories Finished(const ObservedMotion& person, Trajectories motion) const;

  ParticleLayout layout_;
  std::vector<DiffusionNetwork> members_;
  double dt_;
  DiffusionGeneratorOptions options_;
  std::function<NormalSource()> noise_;
};

}  // namespace pushid
