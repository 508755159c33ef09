// models: bodies by LDP's chain of conditional variational autoencoders, frame by frame for all
// people.
//
// A frame of the lower body has 111 numbers, of the upper body 171, of both in one network 267, all
// in the frame of the heading at frame 0 and at 60 Hz:
//   displacement of the hip since the previous frame (x, y), m              2
//   change of the heading since the previous frame, rad                     1
//   joint positions, m                                                      3 per joint
//   their change since the previous frame, m/s                              3 per joint
//   joint rotations relative to frame 0 (FitSkeleton), six numbers          6 per joint
// The pendulum of a frame has 15: cart x, y relative to frame 0, theta, phi, end of the rod
// relative to the hip at frame 0 (3), rod length, and the changes of x, y, theta, phi and end of
// rod since the previous frame.
//
// Coordinates of the positions: `ldp`, as published, relative to the hip at frame 0, so that the
// network also predicts the hip, which drifts; `tip` (default), relative to the hip of the same
// frame, which is put at the rod's tip. Rotations are fitted to positions, because recordings are
// read as positions.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "models/enum_names.h"
#include "models/process_noise.h"
#include "models/restoration/dense_network.h"
#include "models/restoration/restoration.h"

namespace pushid {

enum class CvaeCoordinates { kTip, kLdp };
constexpr EnumNames<CvaeCoordinates, 2> Names(CvaeCoordinates) {
  return {{{"tip", CvaeCoordinates::kTip}, {"ldp", CvaeCoordinates::kLdp}}};
}

// LDP's network of the lower and of the upper body.
enum CvaeHalf { kLowerHalf, kUpperHalf };

// The parts of the chain, some of which an ablation leaves out.
struct CvaeLayout {
  CvaeCoordinates coordinates = CvaeCoordinates::kTip;
  bool pendulum = true;  // false: the next pose from the pose alone, with the hip
  bool halves = true;    // false: one network for all joints, in place of the lower body's

  int num_halves() const { return halves ? 2 : 1; }
  const std::vector<int>& Joints(int half) const;
  int Frame(int half) const { return 3 + 12 * static_cast<int>(Joints(half).size()); }
  int Positions(int half) const { return 3 * static_cast<int>(Joints(half).size()); }
  // Size of the condition of a half's networks.
  int Condition(int half) const {
    return Frame(half) + (half == kUpperHalf ? Positions(kLowerHalf) : 0);
  }
  int PendulumFrame() const;  // 15 or 0
  // The coordinates in use: without a pendulum there is no tip.
  CvaeCoordinates Origin() const { return pendulum ? coordinates : CvaeCoordinates::kLdp; }
};

inline constexpr int kPendulumFrame = 15;
inline constexpr double kCvaeRate = 60.0;  // Hz

// Frames as columns; person and motion at 60 Hz (Resampled).
Eigen::MatrixXf PendulumFrames(const RestorationInput& person, const CvaeLayout& layout);
using BodyFrames = std::vector<Eigen::MatrixXf>;  // of each half
BodyFrames FramesOf(const RestorationInput& person, const BodyMotion& motion,
                    const CvaeLayout& layout);

// The motion in the world; in `tip` coordinates the hip is at the rod's tip.
BodyMotion MotionFromFrames(const RestorationInput& person, const BodyFrames& frames,
                            const CvaeLayout& layout);

// Resampled to `dt` by linear interpolation; unchanged if the rates agree.
RestorationInput Resampled(const RestorationInput& person, double dt);
// `frames` poses at dt of a motion at motion_dt.
BodyMotion Resampled(const BodyMotion& motion, double motion_dt, double dt, int frames);

// The networks of LDP's chain that are used after training: two samplers, which guess the
// latent variable from pose and pendulum, and two decoders, mixtures of experts.
//
//   lower: z = S_l(x^l_t, pendulum_t+1),  x^l_t+1 = D_l(z, x^l_t)
//   upper: c = [x^u_t, lower positions t+1],  z = S_u(c, pendulum_t+1),  x^u_t+1 = D_u(z, c)
//
// Without halves, the lower body's pair alone predicts all joints. Without a pendulum there are no
// samplers: z is drawn from a standard normal three times per frame and the poses are averaged, as
// in LDP's ablation.
//
// A sampler returns a Gaussian: z is its mean (CvaeLatent::kMean), or mu + sigma eps (kDraw), with
// separate draws for each frame, person and half of the body. The outputs of the experts are
// blended, not their weights: the function is the same, since a layer is linear, and one product
// serves a whole crowd.

inline constexpr int kLatent = 64, kExperts = 4, kCvaeHidden = 256, kGateHidden = 64;

enum class CvaeLatent { kMean, kDraw };
constexpr EnumNames<CvaeLatent, 2> Names(CvaeLatent) {
  return {{{"mean", CvaeLatent::kMean}, {"draw", CvaeLatent::kDraw}}};
}

// Three layers, the pendulum concatenated at each: [x, p] -> 256 -> 256 -> mean and log-variance.
struct CvaeSampler {
  DenseLayer first, second, mean, log_variance;
  // eps: standard normal, a column per person; empty: the mean is returned.
  Eigen::MatrixXf Evaluate(const Eigen::MatrixXf& condition, const Eigen::MatrixXf& pendulum,
                           const Eigen::MatrixXf& eps) const;
};

// Three layers of four experts, z concatenated at each: [z, c] -> 256 -> 256 -> frame. The rows of
// a layer are those of the experts, one below the other. The gate, another network of [z, c], has
// the shares of the experts.
struct CvaeDecoder {
  DenseNetwork gate;
  DenseLayer first, second, last;
  Eigen::MatrixXf Evaluate(const Eigen::MatrixXf& z, const Eigen::MatrixXf& condition) const;
};

struct CvaeNetworks {
  Scaling scaling;  // of the frames
  CvaeSampler sampler;
  CvaeDecoder decoder;
};

struct CvaeWeights {
  CvaeLayout layout;
  CvaeNetworks halves[2];  // the second is empty without layout.halves
  Scaling pendulum;
};

inline constexpr int kCvaeDraws = 3;  // of z per frame, without a pendulum

// Replaces the scaled frames of a half of the body, a column per person, by the next ones.
// pendulum: scaled, of the next frame. draws: standard normal; without a pendulum, z as kCvaeDraws
// columns per person; with samplers, eps as one column per person, or empty for the mean. lower:
// the lower body's next frames, for the upper body.
void Step(const CvaeWeights& weights, CvaeHalf half, const Eigen::MatrixXf& pendulum,
          const Eigen::MatrixXf& draws, const Eigen::MatrixXf& lower, Eigen::MatrixXf* frames);

void ListTensors(const std::string& prefix, CvaeWeights* weights, TensorFields* fields);

class CvaeRestoration : public Restoration {
 public:
  // draws: makes the source of z without a pendulum, for each call of Restore.
  explicit CvaeRestoration(CvaeWeights weights, std::function<NormalSource()> draws = nullptr)
      : weights_(std::move(weights)), draws_(std::move(draws)) {}
  std::string_view kind() const override { return RowOf(RestorationKind::kCvae).name; }
  std::vector<BodyMotion> Restore(const std::vector<RestorationInput>& people) const override;
  bool CanDraw() const { return weights_.layout.pendulum; }
  // Makes Restore draw z from the samplers' Gaussians (requires CanDraw); `draws` makes a new
  // source for each call.
  void DrawLatent(std::function<NormalSource()> draws) {
    latent_ = CvaeLatent::kDraw;
    draws_ = std::move(draws);
  }

 private:
  CvaeWeights weights_;
  std::function<NormalSource()> draws_;
  CvaeLatent latent_ = CvaeLatent::kMean;
};

}  // namespace pushid
