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
#include "models/particles.h"
#include "models/restoration/dense_network.h"

namespace pushid {

inline constexpr int kParticleHidden = 256;

// SDE's generator without its training: particles whose displacements follow a learned
// drift and learned noise (Lyu et al., "Learning Human Motion Prediction via Stochastic
// Differential Equations", ACM MM 2021, called SDE).
//
//   p_t     = (S_t - S_{t-1}) / step_spread            displacement of every coordinate; p_0 = 0
//   h_t     = GRU([p_t, (S_t - pose_mean) / pose_spread], h_{t-1})
//   p_{t+1} = f + g (M e),   e ~ N(0, 1)               the transition of SDE's Eq. 2
//   f       = W h_t + b + sum_{k<9} A_k p_{t-k}        drift; A_0 = 1 and the rest 0 before
//   log g   = V h_t + c, held within -6 .. 2           noise of every coordinate
//   S_{t+1} = S_t + step_spread p_{t+1}                the pose operator, Eq. 7-9: an exact sum
//
// The error of the sum over a whole second is corrected at once, and is not fed back:
//   S_{T+u} += pose_spread sum_{k<6} c_k sin(pi (k + 1/2) u / U),   u = 1 .. U frames of forecast
//   c = W' elu(V' [h_T, d] + b') + b''   d: the first six cosine coefficients of the scaled poses
// zero at the last pose seen, and before training. Of trainings of U frames; later ones keep the
// last correction.
//
// M is lower triangular, and M M^T are the correlations of what the drift misses, (p_{t+1} - f) /
// g, over the windows that were learned from: a wrist goes where its arm goes. Rejected:
// M M^T = D + U U^T of rank 4, which spreads futures less well and saves nothing at this size.
//
// SDE itself (noisy_input) has sum_j g^ij w^j in the place of g M e. Every g^ij is a function of
// h_t (linear, log g^ii as above), and g is lower triangular: any g g^T has such a g, which makes
// the same noise. Its w_1:K belong to the K frames observed: to what goes in at frame k the cell
// adds g(h_{k-1}) w_k, and the forecast frames have no noise of their own.
//
// The forecast is the path without noise; what is predicted is fed back. The cell is in PyTorch's
// conventions. Rejected: a pose operator that is learned, as the released fragment has it (the sum
// is what it has to be, and without it the error at 80 ms doubles).
struct ParticleStructure {
  bool skip = true;          // the sum over A_k
  bool particles = true;     // off: poses go in alone
  bool summed = true;        // off: the next pose comes out, not its displacement
  bool poses = true;         // off: displacements go in alone, as in SDE
  bool lstm = false;         // in place of the GRU
  bool noisy_input = false;  // the noise of SDE; either particles or poses go in then
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
// Share of a coordinate's noise variance that no other coordinate shares: M has an inverse.
inline constexpr float kOwnNoise = 0.01f;

struct ParticleNetwork {
  ParticleStructure structure;
  Eigen::VectorXf pose_mean, pose_spread, step_spread;  // by coordinate; m
  DenseLayer input, recurrent;                          // of the gates, side by side
  DenseLayer drift, noise;
  DenseLayer noise_below;  // g^ij of noisy_input, row after row; used where j < i
  DenseLayer correction_hidden, correction;
  Eigen::MatrixXf noise_mix;  // M, coordinates x coordinates; or empty
  Eigen::MatrixXf skip;       // coordinates x 9 coordinates, the newest step first

  int num_coordinates() const { return static_cast<int>(pose_mean.size()); }
};

// Many people, or many futures of one, after the same number of frames.
class ParticleRollout {
 public:
  // All people must have the same number of frames. Each stands `copies` times side by side.
  // jitter: what is added to the scaled pose that goes in, a column for every copy of every person.
  // normal: draws w_1:K of a network with noisy_input; without it nothing is added.
  ParticleRollout(const ParticleNetwork& network, const std::vector<ObservedMotion>& people,
                  int copies = 1, const Eigen::MatrixXf* jitter = nullptr,
                  const NormalSource* normal = nullptr);

  // The next frame: a column per person. With `noise` (coordinates x people, standard normal) a
  // sampled one.
  const Eigen::MatrixXf& Step(const Eigen::MatrixXf* noise = nullptr);
  // Per person: log density of the last sampled displacement in its units, or of all w_1:K.
  const Eigen::VectorXf& log_likelihood() const { return log_likelihood_; }
  const Eigen::MatrixXf& pose() const { return shown_; }

 private:
  // Moves the cell on by a frame.
  void Observe(const Eigen::MatrixXf& pose, const NormalSource* normal = nullptr);
  // g M e, or sum_j g^ij w^j, in the state that the cell is in; adds to the likelihood.
  Eigen::MatrixXf Mapped(const Eigen::MatrixXf& noise);

  const ParticleNetwork& network_;
  const std::vector<ObservedMotion>& people_;
  int copies_;
  const Eigen::MatrixXf* jitter_;
  int frame_ = 0;  // the next to be observed
  void PrepareCorrection();

  int step_ = 0;  // of the forecast
  Eigen::MatrixXf pose_, shown_, hidden_, memory_, history_;
  Eigen::MatrixXf correction_;  // 6 coordinates x people
  Eigen::VectorXf log_likelihood_;
  float log_mix_ = 0.0f;  // log of the determinant of M
};

// Rows k < 6: the cosines that observed poses are seen by, and the sines of the correction.
Eigen::MatrixXf SeenCosines(int observed);
Eigen::MatrixXf CorrectionSines(int frames);

// The network has its structure and number of coordinates.
void ListTensors(const std::string& prefix, ParticleNetwork* network, TensorFields* fields);

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

  // Forecast of as many frames as the network was fitted for; observed: at least ten frames.
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

// The network has its numbers of blocks, coordinates and observed frames.
void ListTensors(const std::string& prefix, SimlpeNetwork* network, TensorFields* fields);

// Partners of the networks in the blend; empty where the share is 0. siMLPe: of several seeds, in
// the mean.
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
  // Memory of the noise of sampled futures: e_t = memory e_{t-1} + sqrt(1 - memory^2) N(0, 1).
  // Chosen on the validation split, where the noise that was learned, drawn anew every frame,
  // covers 80 ms but too little of 1000 ms: errors of a forecast last.
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
  // The mean of the members' forecasts, without bones.
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
