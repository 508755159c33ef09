// residuals: what one frame of one person contributes, and its robust loss.
//
//   r = w [ (hip - hip_measured) / s_hip                    3
//           (cart velocity - measured) / s_velocity         2
//           (angles - measured) / s_angle                   2
//           (angular rates - measured) / s_rate ]           2
// Likelihood: independent errors with these standard deviations, heavier than normal in the tails.
// w^2 = rho(|r|^2) / |r|^2 with the pseudo-Huber rho(s) = 2 d^2 (sqrt(1 + s / d^2) - 1), so that
// sum r^2 / 2 is the robust cost of the frame. A Ceres LossFunction would act on the whole
// recording, which is one residual block. The frame's weight multiplies w r. Rejected: hip
// positions alone, which let velocities run wild between frames; one scalar per frame, which stalls
// Gauss-Newton.
//
// FrameLoss::kLdp is LDP's (Yue et al., CVPR 2024, supplement, Eq. 6): the absolute errors of x, y,
// theta, phi, xd, yd and thd, and in place of that of phd, phd itself, lambda times. Its rows are
//   [x, y - measured; lambda phd; xd, yd - measured; theta, phi - measured; thd - measured; l -
//   measured]
// each with a w of its own, so that the cost is d |r| beyond d: absolute values that can be
// differentiated. The rod's row, zero where the rod is constant, is what a law of the rod learns
// from: the other rows hardly depend on l.
#pragma once

#include <cmath>

#include "models/enum_names.h"
#include "models/ipm.h"

namespace pushid {

// The likelihood of the recordings that a fit maximizes.
enum class Likelihood {
  kTrajectory,  // of whole rollouts from frame 0 (rollout_residual.h): no process
                // noise
  kTransition,  // of every measured state given the one before
  kInnovation   // of every measurement given all before it
};
constexpr EnumNames<Likelihood, 3> Names(Likelihood) {
  return {{{"trajectory", Likelihood::kTrajectory},
           {"transition", Likelihood::kTransition},
           {"innovation", Likelihood::kInnovation}}};
}

// How a rollout is differentiated.
enum class DerivativesBy {
  kAuto,     // the quickest there is: lanes (lanes/person_lanes.h) or jets
  kAutodiff  // jets (jets/autodiff_rollout.h) alone
};
constexpr EnumNames<DerivativesBy, 2> Names(DerivativesBy) {
  return {{{"auto", DerivativesBy::kAuto}, {"autodiff", DerivativesBy::kAutodiff}}};
}

inline constexpr int kFrameResiduals = 9;

enum class FrameLoss { kHip, kLdp };
constexpr EnumNames<FrameLoss, 2> Names(FrameLoss) {
  return {{{"hip", FrameLoss::kHip}, {"ldp", FrameLoss::kLdp}}};
}

inline constexpr double kLdpRateWeight = 0.3;  // lambda of LDP's loss, as released

struct ResidualSigmas {
  double hip = 0.10;      // m; raise it when the marker of the hip is poor
  double velocity = 1.0;  // m/s, of the cart
  double angle = 1.0;     // rad
  double rate = 3.0;      // rad/s
  double robust = 0.5;    // pseudo-Huber scale d in sigmas (of |r|); 0 means plain least squares
  FrameLoss loss = FrameLoss::kHip;
  // Force platforms (plate_residual.h): N, and m of the centre of pressure.
  double shear = 10.0, centre = 0.005;

  // d of whole frames; 0 where each row has its own.
  double OfFrames() const { return loss == FrameLoss::kHip ? robust : 0.0; }
};

// Sigmas under which FrameLoss::kLdp weighs metres, radians and their rates alike, as LDP does.
inline constexpr ResidualSigmas kLdpSigmas = {0.1, 0.1, 0.1, 0.1, 0.01, FrameLoss::kLdp};

template <typename L>
struct MeasuredFrameOf {
  Vector3<L> hip;          // m
  PendulumState<L> state;  // m, rad, m/s, rad/s
  L weight = L(1.0);       // on r; 0 where nothing was measured
  L rod = L(0.0);          // l - l_0, m; 0 where the model's is constant
};
using MeasuredFrame = MeasuredFrameOf<double>;

template <typename T>
using FrameVector = Eigen::Matrix<T, kFrameResiduals, 1>;

// r before the robust weight. angles: of the state.
// body: with the lengths of that frame (BodyNow, where the rod moves).
template <typename T, typename L, typename M>
FrameVector<T> RawFrameResidual(const BodyOf<L>& body, const PendulumState<T>& state,
                                const Angles<T>& angles, const MeasuredFrameOf<M>& measured,
                                const ResidualSigmas& sigmas) {
  FrameVector<T> r;
  if (sigmas.loss == FrameLoss::kLdp) {
    for (int i = 0; i < 2; ++i) r[i] = (state.q[i] - measured.state.q[i]) / sigmas.hip;
    r[2] = kLdpRateWeight * state.qd[3] / sigmas.rate;
  } else {
    r.template head<3>() =
        (HipPosition(body, angles, state.q) - measured.hip) * T(1.0 / sigmas.hip);
  }
  for (int i = 0; i < 2; ++i) {
    r[3 + i] = (state.qd[i] - measured.state.qd[i]) * (1.0 / sigmas.velocity);
    r[5 + i] = (state.q[2 + i] - measured.state.q[2 + i]) * (1.0 / sigmas.angle);
    r[7 + i] = (state.qd[2 + i] - measured.state.qd[2 + i]) * (1.0 / sigmas.rate);
  }
  if (sigmas.loss == FrameLoss::kLdp) r[8] = (state.rod - measured.rod) / sigmas.hip;
  return r;
}

// w of the header; 1 for plain least squares.
template <typename T>
T RobustWeight(const T& squared_norm, double robust) {
  using std::sqrt;
  if (robust <= 0.0) return T(1.0);
  return sqrt(2.0 / (1.0 + sqrt(1.0 + squared_norm / (robust * robust))));
}

// Slope of residuals that share one w: w, and twice dw/ds over w, of
//   d(w r) = w dr + r (2 dw/ds) r' dr, with c = sqrt(1 + s/d^2), w^2 = 2 / (1 + c) = 2 u
template <typename T>
struct RobustSlope {
  T w = T(1.0), over_w = T(0.0);

  RobustSlope(const T& squared_norm, double robust) {
    using std::sqrt;
    if (robust <= 0.0) return;
    const double inverse_square = 1.0 / (robust * robust);
    const T c = sqrt(1.0 + squared_norm * inverse_square), u = 1.0 / (1.0 + c);
    w = sqrt(2.0 * u);
    over_w = -0.5 * inverse_square * u / c;
  }
};

// A frame's rows of the Jacobian of w r, made those whose J'J is the robust cost's own Hessian but
// for the model's second derivatives (Triggs et al. 2000, section 4.3): the Jacobian of w r counts
// the loss as steeper than it is. With c = sqrt(1 + |r|^2 / d^2):
//   J <- (1 - u u') J sqrt((1 + c) / 2c) + u u' J sqrt(2 / (c (1 + c))),   u = r / |r|
// residual: w r times `weight`.
template <typename T>
struct RobustHessian {
  T across, along;  // the two factors

  // squared: |w r|^2 without the weight.
  RobustHessian(const T& squared, double robust) {
    using std::sqrt;
    const T c = 1.0 + squared / (2.0 * robust * robust);
    across = sqrt((1.0 + c) / (2.0 * c));
    along = sqrt(2.0 / (c * (1.0 + c)));
  }
};

// r and J of a frame become those of weight w r. seen: the frame's weight, which is in them.
template <typename Residual, typename Rows>
void ApplyRobustLoss(double seen, double weight, double robust, Residual&& residual,
                     Rows&& jacobian) {
  if (seen <= 0.0) return;  // nothing was measured: zeros
  const RobustSlope<double> slope(residual.squaredNorm() / (seen * seen), robust);
  Eigen::Matrix<double, 1, Eigen::Dynamic> along = residual[0] * jacobian.row(0);
  for (Eigen::Index i = 1; i < residual.size(); ++i) along += residual[i] * jacobian.row(i);
  along *= slope.over_w / (seen * seen);
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    jacobian.row(i) = weight * slope.w * (jacobian.row(i) + residual[i] * along);
  }
  residual *= weight * slope.w;
}

template <typename Residual, typename Rows>
void CorrectForRobustLoss(const Residual& residual, double weight, double robust, Rows&& jacobian) {
  const double squared = residual.squaredNorm();
  if (robust <= 0.0 || weight <= 0.0 || squared <= 0.0) return;
  const RobustHessian<double> factor(squared / (weight * weight), robust);
  // Row by row, as vectors of the processor lie.
  Eigen::Matrix<double, 1, Eigen::Dynamic> along = residual[0] * jacobian.row(0);
  for (Eigen::Index i = 1; i < residual.size(); ++i) along += residual[i] * jacobian.row(i);
  along *= (factor.along - factor.across) / squared;
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    jacobian.row(i) = factor.across * jacobian.row(i) + residual[i] * along;
  }
}

template <typename T, typename L>
FrameVector<T> FrameResidual(const BodyOf<L>& body, const PendulumState<T>& state,
                             const MeasuredFrame& measured, const ResidualSigmas& sigmas) {
  FrameVector<T> r = RawFrameResidual(body, state, Angles<T>(state.q), measured, sigmas);
  if (sigmas.loss == FrameLoss::kLdp) {
    for (T& one : r) one *= measured.weight * RobustWeight<T>(one * one, sigmas.robust);
    return r;
  }
  return T(measured.weight) * RobustWeight<T>(r.squaredNorm(), sigmas.robust) * r;
}

}  // namespace pushid
