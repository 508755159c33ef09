// models: bodies by LDP's chain of conditional variational autoencoders, frame after frame,
// everybody together.
//
// A frame of the lower body has 111 numbers, of the upper body 171, of both in one network 267, all
// in the frame of the heading at frame 0 and at 60 Hz:
//   way of the hip since the frame before (x, y), m                         2
//   change of the facing direction since the frame before, rad              1
//   joint positions, m                                                      3 per joint
//   their change since the frame before, m/s                                3 per joint
//   joint rotations against frame 0 (FitSkeleton), six numbers             6 per joint
// The pendulum of a frame has 15: cart x, y against frame 0, theta, phi, end of the rod against the
// hip at frame 0 (3), rod length, and the changes of x, y, theta, phi and end of rod since the
// frame before.
//
// Coordinates of the positions: `ldp`, as published, against the hip at frame 0, so that the
// network itself carries the hip, which drifts; `tip` (default), against the hip of the same frame,
// which is put at the rod's tip. Rotations are fitted to positions: recordings are read as
// positions.
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

// Halves of the body: LDP's lower and its upper network.
enum CvaeHalf { kLowerHalf, kUpperHalf };

// The parts of the chain; to leave some of LDP's out is to see what they are worth.
struct CvaeLayout {
  CvaeCoordinates coordinates = CvaeCoordinates::kTip;
  bool pendulum = true;  // false: the next pose from the pose alone; the network carries the hip
  bool halves = true;    // false: one network for all joints, in the place of the lower body's

  int num_halves() const { return halves ? 2 : 1; }
  const std::vector<int>& Joints(int half) const;
  int Frame(int half) const { return 3 + 12 * static_cast<int>(Joints(half).size()); }
  int Positions(int half) const { return 3 * static_cast<int>(Joints(half).size()); }
  // Numbers that the networks of a half go on from.
  int Condition(int half) const {
    return Frame(half) + (half == kUpperHalf ? Positions(kLowerHalf) : 0);
  }
  int PendulumFrame() const;  // 15 or 0
  // The coordinates in use: without a pendulum there is no tip.
  CvaeCoordinates Origin() const { return pendulum ? coordinates : CvaeCoordinates::kLdp; }
};

inline constexpr int kPendulumFrame = 15;
inline constexpr double kCvaeRate = 60.0;  // Hz

// A column per frame. person and motion at 60 Hz (Resampled).
Eigen::MatrixXf PendulumFrames(const RestorationInput& person, const CvaeLayout& layout);
using BodyFrames = std::vector<Eigen::MatrixXf>;  // of each half
BodyFrames FramesOf(const RestorationInput& person, const BodyMotion& motion,
                    const CvaeLayout& layout);

// Back from frames to the world; the hip is at the rod's tip in `tip` coordinates.
BodyMotion MotionFromFrames(const RestorationInput& person, const BodyFrames& frames,
                            const CvaeLayout& layout);

// A person at another rate, by linear interpolation; unchanged where the rates agree.
RestorationInput Resampled(const RestorationInput& person, double dt);
// `frames` poses at dt of a motion at motion_dt.
BodyMotion Resampled(const BodyMotion& motion, double motion_dt, double dt, int frames);

// The networks of LDP's chain that are used after training: two samplers, which guess the
// latent variable from pose and pendulum, and two decoders, mixtures of experts.
//
//   lower: z = S_l(x^l_t, pendulum_t+1),  x^l_t+1 = D_l(z, x^l_t)
//   upper: c = [x^u_t, lower positions t+1],  z = S_u(c, pendulum_t+1),  x^u_t+1 = D_u(z, c)
//
// Without halves only the lower body's pair is there, and poses all joints. Without a pendulum
// there are no samplers: z is drawn from a standard normal three times a frame and the poses are
// averaged, as LDP does in its ablation.
//
// A sampler gives a Gaussian: z is its mean (CvaeLatent::kMean), or mu + sigma eps (kDraw). What is
// drawn is drawn anew for every frame, person and half of the body. The experts' outputs are
// blended, not their weights: the same function, since a layer is linear, and one product for a
// whole crowd.

inline constexpr int kLatent = 64, kExperts = 4, kCvaeHidden = 256, kGateHidden = 64;

enum class CvaeLatent { kMean, kDraw };
constexpr EnumNames<CvaeLatent, 2> Names(CvaeLatent) {
  return {{{"mean", CvaeLatent::kMean}, {"draw", CvaeLatent::kDraw}}};
}

// Three layers, the pendulum concatenated at each: [x, p] -> 256 -> 256 -> mean and log-variance.
struct CvaeSampler {
  DenseLayer first, second, mean, log_variance;
  // eps: a column per person; none: the mean.
  Eigen::MatrixXf Evaluate(const Eigen::MatrixXf& condition, const Eigen::MatrixXf& pendulum,
                           const Eigen::MatrixXf& eps) const;
};

// Three layers of four experts, z concatenated at each: [z, c] -> 256 -> 256 -> frame; the experts'
// weights stand below each other. The gate, a network of its own on [z, c], says how they are
// mixed.
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
  CvaeNetworks halves[2];  // of what the layout has
  Scaling pendulum;
};

inline constexpr int kCvaeDraws = 3;  // of z in a frame, without a pendulum

// One frame of a half on: scaled frames of everybody, a column each, in place. pendulum: scaled, of
// the next frame. draws: standard normal numbers, a column per person: kCvaeDraws times everybody
// where there is no pendulum (z), everybody once (eps) or none (the mean) with samplers. lower: the
// lower body's next frames, for the upper one.
void Step(const CvaeWeights& weights, CvaeHalf half, const Eigen::MatrixXf& pendulum,
          const Eigen::MatrixXf& draws, const Eigen::MatrixXf& lower, Eigen::MatrixXf* frames);

void ListTensors(const std::string& prefix, CvaeWeights* weights, TensorFields* fields);

class CvaeRestoration : public Restoration {
 public:
  // draws: of z where there is no pendulum, made anew for every call of Restore.
  explicit CvaeRestoration(CvaeWeights weights, std::function<NormalSource()> draws = nullptr)
      : weights_(std::move(weights)), draws_(std::move(draws)) {}
  std::string_view kind() const override { return RowOf(RestorationKind::kCvae).name; }
  std::vector<BodyMotion> Restore(const std::vector<RestorationInput>& people) const override;
  bool CanDraw() const { return weights_.layout.pendulum; }
  // Draws z from the samplers' Gaussians from here on (CanDraw); every call of Restore takes its
  // normal numbers from `draws` anew.
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
