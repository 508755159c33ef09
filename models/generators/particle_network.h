// models: SDE's generator without its training: particles whose displacements follow a learned
// drift and learned noise (Lyu et al., "Learning Human Motion Prediction via Stochastic
// Differential Equations", ACM MM 2021, called SDE).
//
//   p_t     = (S_t - S_{t-1}) / step_spread            displacement of every coordinate; p_0 = 0
//   h_t     = GRU([p_t, (S_t - pose_mean) / pose_spread], h_{t-1})
//   p_{t+1} = f + g (M e),   e ~ N(0, 1)               the transition of SDE's Eq. 4
//   f       = W h_t + b + sum_{k<9} A_k p_{t-k}        drift; A_0 = 1 and the rest 0 before
//   log g   = V h_t + c, held within -6 .. 2           noise of every coordinate
//   S_{t+1} = S_t + step_spread p_{t+1}                the pose operator, Eq. 7-9: an exact sum
//
// What the sum gets wrong over a whole second is corrected at once, and is not fed back:
//   S_{T+u} += pose_spread sum_{k<6} c_k sin(pi (k + 1/2) u / U),   u = 1 .. U frames of forecast
//   c = W' elu(V' [h_T, d] + b') + b''   d: the first six cosine coefficients of the scaled poses
// zero at the last pose seen, and before training. Of trainings of U frames; later ones keep the
// last correction.
//
// M is lower triangular, and M M^T are the correlations of what the drift misses, (p_{t+1} - f) /
// g, over the windows that were learned from: a wrist goes where its arm goes. In SDE M is 1, and
// neighbours are torn apart. Rejected: M M^T = D + U U^T of rank 4, which spreads futures less well
// and saves nothing at this size.
//
// The forecast is the path without noise; what is predicted is fed back. The cell is in PyTorch's
// conventions. Rejected: a pose operator that is learned, as the released fragment has it (the sum
// is what it has to be, and without it the error at 80 ms doubles); an LSTM, which is no better.
#pragma once

#include "models/generators/motion_generator.h"
#include "models/restoration/dense_network.h"

namespace pushid {

struct ParticleStructure {
  bool skip = true;              // the sum over A_k
  bool particles = true;         // off: poses go in alone, and the next pose comes out
  bool poses = true;             // off: displacements go in alone, as in SDE
  bool correlated_noise = true;  // off: M = 1
  int corrected_frames = 0;      // U; 0: no correction

  bool HasSkip() const { return skip && particles; }
  int NumInputs(int coordinates) const {
    return ((particles ? 1 : 0) + (poses ? 1 : 0)) * coordinates;
  }
};

inline constexpr int kSkipSteps = 9;
inline constexpr int kParticleHidden = 256, kParticleGates = 3 * kParticleHidden;
inline constexpr int kCorrectionTerms = 6, kCorrectionHidden = 256;
inline constexpr float kLeastLogNoise = -6.0f, kLargestLogNoise = 2.0f;
// Of a coordinate's noise, what no other coordinate shares (in variance): M has an inverse.
inline constexpr float kOwnNoise = 0.01f;

struct ParticleNetwork {
  ParticleStructure structure;
  Eigen::VectorXf pose_mean, pose_spread, step_spread;  // by coordinate; m
  DenseLayer input, recurrent;                          // of the gates, side by side
  DenseLayer drift, noise;
  DenseLayer correction_hidden, correction;
  Eigen::MatrixXf noise_mix;  // M, coordinates x coordinates; or empty
  Eigen::MatrixXf skip;       // coordinates x 9 coordinates, the newest step first

  int num_coordinates() const { return static_cast<int>(pose_mean.size()); }
};

// Where many people, or many futures of one, stand after the same number of frames.
class ParticleRollout {
 public:
  // All people must have the same number of frames. Each stands `copies` times side by side.
  // jitter: what is added to the scaled pose that goes in, a column for every copy of every person.
  ParticleRollout(const ParticleNetwork& network, const std::vector<ObservedMotion>& people,
                  int copies = 1, const Eigen::MatrixXf* jitter = nullptr);

  // The next frame: a column per person. With `noise` (coordinates x people, standard normal) a
  // sampled one.
  const Eigen::MatrixXf& Step(const Eigen::MatrixXf* noise = nullptr);
  // Of the last step's transitions, per person: log density of the displacement in its units.
  const Eigen::VectorXf& log_likelihood() const { return log_likelihood_; }
  const Eigen::MatrixXf& pose() const { return shown_; }

 private:
  void Observe(const Eigen::MatrixXf& pose);  // moves the cell on by a frame

  const ParticleNetwork& network_;
  const std::vector<ObservedMotion>& people_;
  int copies_;
  const Eigen::MatrixXf* jitter_;
  int frame_ = 0;  // the next to be observed
  void PrepareCorrection();

  int step_ = 0;  // of the forecast
  Eigen::MatrixXf pose_, shown_, hidden_, history_;
  Eigen::MatrixXf correction_;  // 6 coordinates x people
  Eigen::VectorXf log_likelihood_;
  float log_mix_ = 0.0f;  // log of the determinant of M
};

// Rows k < 6: the cosines that observed poses are seen by, and the sines of the correction.
Eigen::MatrixXf SeenCosines(int observed);
Eigen::MatrixXf CorrectionSines(int frames);

void AddTensors(const std::string& name, const ParticleNetwork& network, TensorList* tensors);
ParticleNetwork TakeParticles(const std::string& name, const ParticleStructure& structure,
                              int coordinates, TensorReader* reader);

}  // namespace pushid
