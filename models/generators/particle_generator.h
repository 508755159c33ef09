// models: several particle networks of different seeds, averaged, blended with the linear forecast
// and with siMLPe, and brought back to the person's bones.
//
//   S_t = (1 - r_t - s_t) particles_t + r_t ridge_t + s_t siMLPe_t
//   r_t = ridge_share exp(-t / T),   s_t = simlpe_share (1 - exp(-t / T)),   T = 10 frames
//
// The linear forecast is good for the next frames alone, siMLPe for the far ones, both on actions
// that none of them has learned from. Rejected: members that also forecast the mirror image, which
// gain nothing beside siMLPe.
//
// A sampled future is a sampled path of one member, the members taking turns, with a draw of the
// pose's jitter, moved by what the blend differs from the members' mean: so futures spread around
// the forecast as noise, members and what is not known of the pose do. siMLPe and the ridge move
// them all alike.
#pragma once

#include <vector>

#include "models/generators/motion_generator.h"
#include "models/generators/particle_network.h"
#include "models/particles.h"

namespace pushid {

// The linear forecast: ridge regression from the last pose and the last displacements to
// all future poses at once. What any network has to beat, and a good partner in a blend.
//
//   features: last pose, then the last 9 displacements, newest first; m
//   targets:  future poses minus the last one
//   minimum over W of |Y - W X|^2 + penalty |W|^2, features and targets centred, intercept free

inline constexpr int kRidgeDisplacements = 9;

struct RidgeForecast {
  Eigen::MatrixXf weights;  // coordinates x frames, by features
  Eigen::VectorXf bias;

  // As many frames as it was fitted for; observed: at least ten frames.
  Trajectories Forecast(const Trajectories& observed) const;
};

// Sums over windows, so that no table of all of them stands in memory.
class RidgeFit {
 public:
  // Every start of a window of `observed` and `frames` frames in the motion.
  void Add(const Trajectories& motion, int observed, int frames);
  // penalty: m^2.
  RidgeForecast Solve(double penalty) const;

 private:
  Eigen::MatrixXd features_squared_, targets_by_features_;
  Eigen::VectorXd feature_sum_, target_sum_;
  double count_ = 0.0;
};

// siMLPe: a perceptron over the cosine coefficients of what was observed, without recurrence,
// displacements or noise (Guo et al., "Back to MLP: A Simple Baseline for Human Motion Prediction",
// WACV 2023).
//
//   Z = D (S - pose_mean) / pose_spread        D: the orthonormal DCT-II over the T frames observed
//   Y = Z W_in + b_in                          all coordinates, each coefficient alone
//   Y <- Y + norm(A_i Y + a_i),  i < blocks    all coefficients, each coordinate alone
//   S_{T+u} = S_T + pose_spread [D' (Y W_out + b_out)]_u,  u = 1 .. T
//
// norm: layer norm over the coordinates of each coefficient, the only nonlinearity. Apart from the
// paper poses are scaled, and with 25 frames observed instead of 50 forecasts of the same length
// fill all of T. Longer forecasts continue its own.

struct SimlpeBlock {
  DenseLayer mix;                // A_i, a_i: over coefficients
  Eigen::VectorXf scale, shift;  // of the norm, by coordinate
};

struct SimlpeNetwork {
  Eigen::VectorXf pose_mean, pose_spread;  // by coordinate; m
  DenseLayer input, output;                // over coordinates
  std::vector<SimlpeBlock> blocks;

  int observed() const { return static_cast<int>(blocks.front().mix.bias.size()); }
  // The last T frames of `seen` are read.
  Trajectories Forecast(const Trajectories& seen, int frames) const;
};

inline constexpr float kNormSmooth = 1e-5f;  // added to the variance

void AddTensors(const std::string& name, const SimlpeNetwork& network, TensorList* tensors);
SimlpeNetwork TakeSimlpe(const std::string& name, int observed, int coordinates, int blocks,
                         TensorReader* reader);

// The mean of several seeds.
Trajectories MeanForecast(const std::vector<SimlpeNetwork>& members, const Trajectories& seen,
                          int frames);

// What is blended with the networks; empty where its share is 0.
struct BlendPartners {
  RidgeForecast ridge;
  std::vector<SimlpeNetwork> simlpe = {};
};

inline constexpr float kBlendFrames = 10.0f;  // T

struct ParticleGeneratorOptions {
  double ridge_share = 0.4;   // of the linear forecast before the first frame; 0 needs none
  double simlpe_share = 0.5;  // of siMLPe in the far future; 0 needs none
  bool project_bones = true;  // to the lengths of the last frame that was seen
  double jitter = 0.7;        // of the pose in sampled futures; as the members were trained
  // Of the noise of sampled futures: e_t = memory e_{t-1} + sqrt(1 - memory^2) N(0, 1). Chosen on
  // the validation split, where the noise that was learned, drawn anew every frame, covers 80 ms
  // but too little of 1000 ms: errors of a forecast last.
  double noise_memory = 0.32;
};

class ParticleGenerator : public MotionGenerator {
 public:
  ParticleGenerator(ParticleLayout layout, std::vector<ParticleNetwork> members,
                    BlendPartners partners, const ParticleGeneratorOptions& options);

  const ParticleLayout& layout() const override { return layout_; }
  std::vector<Trajectories> Forecast(const std::vector<ObservedMotion>& people,
                                     int frames) const override;
  std::vector<std::vector<SampledFuture>> Sample(const std::vector<ObservedMotion>& people,
                                                 int frames, int count,
                                                 const NormalSource& normal) const override;

 private:
  // What the members forecast in the mean, without bones.
  std::vector<Trajectories> MeanOfMembers(const std::vector<ObservedMotion>& people,
                                          int frames) const;
  void Blend(const std::vector<ObservedMotion>& people, std::vector<Trajectories>* motions) const;
  void Finish(const ObservedMotion& person, Trajectories* motion) const;

  ParticleLayout layout_;
  std::vector<ParticleNetwork> members_;
  BlendPartners partners_;
  ParticleGeneratorOptions options_;
};

}  // namespace pushid
