// models: groups continued by diffusion. The people of a call are one group, at one rate, whose
// frame 0 is the first that was seen; the push is what acts on any of them (their controls).
//
// From noise at T to hardly any in some steps; frames that were seen are put in the place of
// what the network estimates for them, after every step (Eq. 6 of SDM). Networks of several seeds
// take turns, sample by sample. The forecast is the mean of several samples, as the mean joint
// error asks for, half of them of the group in the mirror, where the network errs otherwise.
// Recordings end before people stand still: past the longest one learnt from, what
// the network has them go on with fades, and they come to rest. With a pendulum's path its people
// are moved some of the way to it. Then each body is finished as restored ones are (postprocess.h):
// the seam at the last frame seen fades, bones keep the length of frame 0, resting feet stay.
//
// Noise belongs to people by their place, not by their number, so that their order changes nothing.
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
//   pooled(y) = [y, sums over the others of a y_other], of every level on the way down, in what the
//               middle and the way up are given: all that people see of each other
//
// Convolutions over time are causal (frames t-2, t-1, t), and so is the doubling, so that later
// frames never change earlier ones and a motion may go on past the frames of the training.
// People are a set: weights `a` depend on the two alone. Rejected: a column of all people's
// features at once, which fixes their number.

// A group of people as the diffusion network sees them, and back.
//
//   motion    66 rows: hip(t) - hip(0), then (joint - hip)(t) - (joint - hip)(0), each over the
//             joint's scale; no rotation is taken out: all face the way of the push
//             or, in people's own frames (SDM): hip(t) - hip(0), joint - hip turned to face +x, and
//             cosine and sine of where they face, each to zero mean and unit variance
//   given     a row of each: the observed motion (0 where nothing was seen), 1 where it was, the
//             push on the group over 10 m of the pushed, and where physics have the hip
//   statics   of a person: joints seen from the hip at frame 0, to half of unit variance, place
//             seen from the pushed, height of the hip above 1 m, mass over 80 kg less 1, whether
//             pushed, the push's impulse per mass, its length
//
// Columns of motion and given: the frames of the first person, then those of the next.

inline constexpr int kMotionRows = 3 * kBodyJoints;
inline constexpr int kPushRows = 4;
inline constexpr int kFirstPoseRows = 3 * (kBodyJoints - 1);
inline constexpr int kStaticRows = kFirstPoseRows + 2 + 1 + 1 + 1 + kPushRows + 1;
inline constexpr int kOwnFrameRows = kMotionRows + 2;
inline int GivenRows(int motion_rows = kMotionRows) { return motion_rows + 1 + kPushRows; }

// The frame of the motion's rows (above).
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
// Over all frames and people of the groups.
MotionScales MotionScalesOf(const std::vector<std::vector<ObservedMotion>>& groups,
                            MotionFrame frame);

struct GroupFeatures {
  int people = 0, frames = 0;
  Eigen::MatrixXf given;    // GivenRows x (people * frames)
  Eigen::MatrixXf statics;  // kStaticRows x people
  Eigen::Matrix2Xf places;  // m
};

// observed: the frames of each person that are shown, frames: of the whole motion. The push is that
// of all people together.
GroupFeatures FeaturesOf(const std::vector<ObservedMotion>& group, const MotionScales& scales,
                         int observed, int frames, double dt);

Eigen::MatrixXf MotionRows(const ObservedMotion& person, const MotionScales& scales);
// The motion that begins as the person's does.
Trajectories FromMotionRows(const Eigen::MatrixXf& rows, const ObservedMotion& person,
                            const MotionScales& scales);

// A group as it may as well have been: in the mirror, turned about z, of another size.
struct GroupChange {
  bool mirrored = false;
  double turn = 0.0;  // rad
  double size = 1.0;
};
std::vector<ObservedMotion> Changed(const std::vector<ObservedMotion>& group,
                                    const GroupChange& change);

// local      exp(-(d / 0.8 m)^2), those ahead and those behind apart (a logistic of dx / 0.1 m),
//            each over their sum + 0.1; d, dx between the places at frame 0. Far people fade out.
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
// middle alone, as SDM has it.
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
// Channels in and out of a block.
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
  std::vector<DiffusionPool> pools;  // of the blocks after which people attend to each other
  DenseLayer out, direct;
};

// Weights by which person i (a row) sees person j (a column), a matrix for each view; none of
// attention.
std::vector<Eigen::MatrixXf> PoolingWeights(SocialPooling pooling, const Eigen::Matrix2Xf& places);

// Sines and cosines of t at 32 frequencies.
Eigen::VectorXf TimeFeatures(double t);

// One group; what does not depend on t or x_t is computed once.
class GroupDenoiser {
 public:
  GroupDenoiser(const DiffusionNetwork& network, GroupFeatures features);
  // The estimate of x_0; both NumMotion() x (people * frames).
  Eigen::MatrixXf Estimate(const Eigen::MatrixXf& noisy, double t) const;

 private:
  // Values are channels x (people * frames).
  int FramesOf(const Eigen::MatrixXf& values) const;
  // conditions: of FiLM, a column per person.
  Eigen::MatrixXf Block(int index, const Eigen::MatrixXf& in,
                        const Eigen::MatrixXf& conditions) const;
  // The values, and below them what people see of each other.
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

// The share of a motion that is left after t of T steps of forward noise, and the way back.
//
//   x_t = sqrt(a_t) x_0 + sqrt(1 - a_t) e,  e ~ N(0, 1)
//   a_t = f(t) / f(0),  f(t) = cos^2((t / T + s) / (1 + s) pi / 2)   the cosine schedule, s = 0.008
//
// The network estimates x_0 itself, and noise of an earlier time u is added to it anew (Eq. 5 of
// SDM). Rejected: the posterior of x_u given x_t and x_0 (DDPM), which errs as much or more.

inline constexpr int kDiffusionTime = 1000;  // T

// a_t; 1 at t = 0, 0 at t = T.
inline double SignalShare(double t) {
  constexpr double kOffset = 0.008;
  const auto f = [](double time) {
    return std::pow(std::cos((time / kDiffusionTime + kOffset) / (1.0 + kOffset) * M_PI_2), 2);
  };
  return std::clamp(f(t) / f(0.0), 0.0, 1.0);
}

// Eq. 6 of SDM: frames that were seen take the place of what is estimated for them. past: every
// person's MotionRows of these frames.
void PutPast(const std::vector<Eigen::MatrixXf>& past, Eigen::MatrixXf* estimate);

// Eq. 5: x_u of an estimate of x_0.
Eigen::MatrixXf NoisedAgain(const Eigen::MatrixXf& estimate, const Eigen::MatrixXf& noise,
                            double u);

struct DiffusionGeneratorOptions {
  int steps = 25;
  int averaged = 8;         // samples of a forecast
  bool mirrored = true;     // every other one of them of the group in the mirror
  int learnt_frames = 128;  // of the longest motion learnt from
  bool settle = true;       // later ones fade; off: the network alone goes on, as in SDM
  double settling = 0.5;    // s, in which steps of later frames fade to 1/e
  double blend = 0.0;       // share of the way to the pendulum's hip
  PostprocessOptions postprocess = {true, 20};
  // Keeps what Forecast samples, for forecasts of the same people that differ by what is done to
  // samples afterwards (blend, postprocess).
  std::shared_ptr<std::vector<Trajectories>> sampled = nullptr;
};

class DiffusionGenerator : public MotionGenerator {
 public:
  // noise: makes a source that begins anew, for forecasts that repeat themselves; dt: s.
  DiffusionGenerator(ParticleLayout layout, std::vector<DiffusionNetwork> members, double dt,
                     const DiffusionGeneratorOptions& options, std::function<NormalSource()> noise);

  const ParticleLayout& layout() const override { return layout_; }
  std::vector<Trajectories> Forecast(const std::vector<ObservedMotion>& people,
                                     int frames) const override;

 private:
  // Everybody's motion, with what the network makes of the frames seen, before it is finished.
  std::vector<Trajectories> SampleWhole(const std::vector<ObservedMotion>& people,
                                        const DiffusionNetwork& network, int frames,
                                        const NormalSource& normal) const;
  // The mean of several.
  std::vector<Trajectories> SampledMean(const std::vector<ObservedMotion>& people,
                                        int frames) const;
  // Networks take turns.
  const DiffusionNetwork& Member(int sample) const { return members_[sample % members_.size()]; }
  // The frames after those seen.
  Trajectories Finished(const ObservedMotion& person, Trajectories motion) const;

  ParticleLayout layout_;
  std::vector<DiffusionNetwork> members_;
  double dt_;
  DiffusionGeneratorOptions options_;
  std::function<NormalSource()> noise_;
};

}  // namespace pushid
