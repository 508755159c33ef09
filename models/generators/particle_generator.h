// models: forecasts by particle networks: the mean of several seeds, blended with a linear forecast
// and with siMLPe, and corrected to the person's bone lengths.
//
//   S_t = (1 - r_t - s_t) particles_t + r_t ridge_t + s_t siMLPe_t
//   r_t = ridge_share exp(-t / T),   s_t = simlpe_share (1 - exp(-t / T)),   T = 10 frames
//
// The linear forecast is good for the next frames, siMLPe for later ones, also on actions left out
// of the training. Rejected: members that also forecast the mirror image, which gain nothing beside
// siMLPe.
//
// A sampled future is a sampled path of one member (members take turns) with drawn jitter of the
// pose, plus the difference between the blend and the members' mean. Futures thus spread around the
// forecast by the noise, the differences between members and the uncertainty of the pose; siMLPe
// and the ridge shift all of them equally.
#pragma once

#include <vector>

#include "models/generators/motion_generator.h"
#include "models/particles.h"
#include "models/restoration/dense_network.h"

namespace pushid {

inline constexpr int kParticleHidden = 256;

// A particle network without its training: displacements of particles follow a learned drift and
// learned noise (Lyu et al., "Learning Human Motion Prediction via Stochastic Differential
// Equations", ACM MM 2021, called SDE).
//
//   p_t     = (S_t - S_{t-1}) / step_spread            displacement of every coordinate; p_0 = 0
//   h_t     = GRU([p_t, (S_t - pose_mean) / pose_spread], h_{t-1})
//   p_{t+1} = f + g (M e),   e ~ N(0, 1)               the transition of SDE's Eq. 2
//   f       = W h_t + b + sum_{k<9} A_k p_{t-k}        drift; A_0 = 1 and the rest 0 before
//   log g   = V h_t + c, clamped to -6 .. 2            noise of every coordinate
//   S_{t+1} = S_t + step_spread p_{t+1}                the pose operator, Eq. 7-9: an exact sum
//
// The error that the sum accumulates is corrected for all frames at once, and is not fed back:
//   S_{T+u} += pose_spread sum_{k<6} c_k sin(pi (k + 1/2) u / U),   u = 1 .. U frames of forecast
//   c = W' elu(V' [h_T, d] + b') + b''   d: the first six cosine coefficients of the scaled poses
// The correction is zero at the last observed pose, and before training. U is the number of
// forecast frames in training; later frames keep the correction of frame U.
//
// M is lower triangular, and M M^T are the correlations of the drift's errors, (p_{t+1} - f) / g,
// over the training windows: a wrist moves with its arm. Rejected: M M^T = D + U U^T of rank 4,
// which gives worse spreads and saves nothing at this size.
//
// SDE itself (noisy_input) has sum_j g^ij w^j in place of g M e. Every g^ij is a function of h_t
// (linear, log g^ii as above), and g is lower triangular, which is no restriction: every g g^T has
// such a g. The w_1:K belong to the K observed frames: g(h_{k-1}) w_k is added to the input of
// frame k, and forecast frames have no noise of their own.
//
// The forecast is the path without noise, with predictions fed back. The cell follows PyTorch's
// conventions. Rejected: a learned pose operator, as in the released fragment (it has to learn the
// sum, and without the sum the error at 80 ms doubles).
struct ParticleStructure {
  bool skip = true;          // the sum over A_k
  bool particles = true;     // displacements are an input
  bool summed = true;        // the output is a displacement; false: the next pose
  bool poses = true;         // poses are an input; false in SDE
  bool lstm = false;         // in place of the GRU
  bool noisy_input = false;  // the noise of SDE; needs exactly one of particles and poses
  int corrected_frames = 0;  // U; 0: no correction

  bool HasSkip() const { return skip && particles && summed; }
  int NumGates() const { return (lstm ? 4 : 3) * kParticleHidden; }
  int NumInputs(int coordinates) const {
    return ((particles ? 1 : 0) + (poses ? 1 : 0)) * coordinates;
  }
};

inline constexpr int kSkipSteps = 9;
inline constexpr int kCorrectionTerms = 6, kCorrectionHidden = 256;
inline constexpr float kLeastLogNoise = -6.0f, kLargestLogNoise = 2.0f;
// Share of a coordinate's noise variance that is its own, which makes M invertible.
inline constexpr float kOwnNoise = 0.01f;

struct ParticleNetwork {
  ParticleStructure structure;
  Eigen::VectorXf pose_mean, pose_spread, step_spread;  // by coordinate; m
  DenseLayer input, recurrent;                          // of all gates
  DenseLayer drift, noise;
  DenseLayer noise_below;  // g^ij of noisy_input, row after row; used where j < i
  DenseLayer correction_hidden, correction;
  Eigen::MatrixXf noise_mix;  // M, coordinates x coordinates; or empty
  Eigen::MatrixXf skip;       // coordinates x 9 coordinates, the newest step first

  int num_coordinates() const { return static_cast<int>(pose_mean.size()); }
};

// A rollout of many people, or of many futures of each, after the same number of observed frames.
class ParticleRollout {
 public:
  // Each person has `copies` adjacent columns. jitter: added to the scaled input pose, a column for
  // every copy of every person. normal: draws w_1:K of a network with noisy_input; null: w = 0.
  ParticleRollout(const ParticleNetwork& network, const std::vector<ObservedMotion>& people,
                  int copies = 1, const Eigen::MatrixXf* jitter = nullptr,
                  const NormalSource* normal = nullptr);

  // The next frame, a column per person; sampled if `noise` is given (coordinates x people,
  // standard normal).
  const Eigen::MatrixXf& Step(const Eigen::MatrixXf* noise = nullptr);
  // Per person: log density of the last sampled displacement (in spreads), or of all w_1:K.
  const Eigen::VectorXf& log_likelihood() const { return log_likelihood_; }
  const Eigen::MatrixXf& pose() const { return shown_; }

 private:
  // Advances the cell by a frame.
  void Observe(const Eigen::MatrixXf& pose, const NormalSource* normal = nullptr);
  // g M e, or sum_j g^ij w^j, in the cell's current state; adds to the likelihood.
  Eigen::MatrixXf Mapped(const Eigen::MatrixXf& noise);

  const ParticleNetwork& network_;
  const std::vector<ObservedMotion>& people_;
  int copies_;
  const Eigen::MatrixXf* jitter_;
  int frame_ = 0;  // number of observed frames
  void PrepareCorrection();

  int step_ = 0;  // number of forecast frames
  Eigen::MatrixXf pose_, shown_, hidden_, memory_, history_;
  Eigen::MatrixXf correction_;  // 6 coordinates x people
  Eigen::VectorXf log_likelihood_;
  float log_mix_ = 0.0f;  // log of the determinant of M
};

// Rows k < 6: the cosines of d and the sines of the correction (above).
Eigen::MatrixXf SeenCosines(int observed);
Eigen::MatrixXf CorrectionSines(int frames);

// The structure and the number of coordinates must be set.
void ListTensors(const std::string& prefix, ParticleNetwork* network, TensorFields* fields);

// The linear forecast: ridge regression from the last pose and the last displacements to all future
// poses at once.
//
//   features: last pose, then the last 9 displacements, newest first; m
//   targets:  future poses minus the last one
//   minimum over W of |Y - W X|^2 + penalty |W|^2, features and targets centred, intercept free

inline constexpr int kRidgeDisplacements = 9;

struct RidgeForecast {
  Eigen::MatrixXf weights;  // coordinates x frames, by features
  Eigen::VectorXf bias;

  // As many frames as were fitted; observed: at least ten frames.
  Trajectories Forecast(const Trajectories& observed) const;
};

// The fit, by sums over windows instead of a table of all windows.
class RidgeFit {
 public:
  // Adds every window of `observed` and `frames` frames.
  void Add(const Trajectories& motion, int observed, int frames);
  // penalty: m^2.
  RidgeForecast Solve(double penalty) const;

 private:
  Eigen::MatrixXd features_squared_, targets_by_features_;
  Eigen::VectorXd feature_sum_, target_sum_;
  double count_ = 0.0;
};

// siMLPe: a perceptron over the cosine coefficients of the observed poses (Guo et al., "Back to
// MLP: A Simple Baseline for Human Motion Prediction", WACV 2023).
//
//   Z = D (S - pose_mean) / pose_spread        D: the orthonormal DCT-II over the T frames observed
//   Y = Z W_in + b_in                          all coordinates, each coefficient alone
//   Y <- Y + norm(A_i Y + a_i),  i < blocks    all coefficients, each coordinate alone
//   S_{T+u} = S_T + pose_spread [D' (Y W_out + b_out)]_u,  u = 1 .. T
//
// norm: layer norm over the coordinates of each coefficient, the only nonlinearity. Unlike the
// paper, poses are scaled, and T is 25 frames, both observed and forecast. Longer forecasts
// continue from the forecast frames.

struct SimlpeBlock {
  DenseLayer mix;                // A_i, a_i: over coefficients
  Eigen::VectorXf scale, shift;  // of the norm, by coordinate
};

struct SimlpeNetwork {
  Eigen::VectorXf pose_mean, pose_spread;  // by coordinate; m
  DenseLayer input, output;                // over coordinates
  std::vector<SimlpeBlock> blocks;

  int observed() const { return static_cast<int>(blocks.front().mix.bias.size()); }
  // Uses the last T frames of `seen`.
  Trajectories Forecast(const Trajectories& seen, int frames) const;
};

inline constexpr float kNormSmooth = 1e-5f;  // added to the variance

// The numbers of blocks, coordinates and observed frames must be set.
void ListTensors(const std::string& prefix, SimlpeNetwork* network, TensorFields* fields);

// What the networks are blended with; empty if the share is 0. Several siMLPe networks are
// averaged.
struct BlendPartners {
  RidgeForecast ridge;
  std::vector<SimlpeNetwork> simlpe = {};
};

inline constexpr float kBlendFrames = 10.0f;  // T

struct ParticleGeneratorOptions {
  double ridge_share = 0.4;   // r_0
  double simlpe_share = 0.5;  // s at infinity
  bool project_bones = true;  // to the lengths of the last observed frame
  double jitter = 0.7;        // of the pose in sampled futures; as in the members' training
  // Memory of the noise of sampled futures: e_t = memory e_{t-1} + sqrt(1 - memory^2) N(0, 1).
  // Chosen on the validation split: independent noise covers errors at 80 ms, but too few at 1000
  // ms, because errors of a forecast are correlated in time.
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
  // The mean of the members' forecasts, before bone lengths are corrected.
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
