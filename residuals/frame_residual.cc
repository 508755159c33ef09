// residuals: derivative of one frame's residual.
#include "residuals/frame_residual.h"

namespace pushid {
namespace {

// The robust weight of LDP's rows, each alone: d(w r) = (w + 2 r^2 dw/ds) dr.
template <int kColumns>
FrameVector<double> RobustRows(FrameVector<double> r, double weight, double robust,
                               Eigen::Matrix<double, kFrameResiduals, kColumns>* jacobian) {
  for (int i = 0; i < kFrameResiduals; ++i) {
    double w = 1.0, slope = 1.0;
    if (robust > 0.0) {
      const double c = std::sqrt(1.0 + r[i] * r[i] / (robust * robust));
      w = std::sqrt(2.0 / (1.0 + c));
      slope = w - r[i] * r[i] / (w * robust * robust * c * (1.0 + c) * (1.0 + c));
    }
    jacobian->row(i) *= weight * slope;
    r[i] *= weight * w;
  }
  return r;
}

// lift: of the cart, where the columns end with [rod, lift]. body: with the lengths of that frame.
template <int kColumns>
FrameVector<double> WithJacobian(const Body& body, double lift, const PendulumState<double>& state,
                                 const MeasuredFrame& measured, const ResidualSigmas& sigmas,
                                 Eigen::Matrix<double, kFrameResiduals, kColumns>* jacobian) {
  const Angles<double> angles(state.q);
  const auto& [s_th, c_th, s_ph, c_ph] = angles;
  const FrameVector<double> r = RawFrameResidual(body, state, angles, measured, sigmas);
  const double l = body.rod_length;
  Eigen::Matrix<double, kFrameResiduals, kColumns>& j = *jacobian;
  j.setZero();
  j(0, 0) = j(1, 1) = 1.0 / sigmas.hip;
  j(3, 4) = j(4, 5) = 1.0 / sigmas.velocity;
  j(5, 2) = j(6, 3) = 1.0 / sigmas.angle;
  j(7, 6) = j(8, 7) = 1.0 / sigmas.rate;
  if (sigmas.loss == FrameLoss::kLdp) {
    j(2, 7) = 1.0 / sigmas.rate;
    return RobustRows(r, measured.weight, sigmas.robust, jacobian);
  }
  j(0, 2) = l * c_th / sigmas.hip;
  j(1, 2) = l * s_th * s_ph / sigmas.hip;
  j(1, 3) = -l * c_th * c_ph / sigmas.hip;
  j(2, 2) = -l * s_th * c_ph / sigmas.hip;
  j(2, 3) = -l * c_th * s_ph / sigmas.hip;
  if constexpr (kColumns == 10) {
    j(0, 8) = s_th / sigmas.hip;
    j(1, 8) = -c_th * s_ph / sigmas.hip;
    j(2, 8) = (c_th * c_ph - lift) / sigmas.hip;
    j(2, 9) = -state.rod / sigmas.hip;
  }
  return RobustlyWeighted(r, measured.weight, sigmas.robust, jacobian);
}

}  // namespace

FrameVector<double> FrameResidualWithJacobian(const Body& body, const PendulumState<double>& state,
                                              const MeasuredFrame& measured,
                                              const ResidualSigmas& sigmas,
                                              Eigen::Matrix<double, kFrameResiduals, 8>* jacobian) {
  return WithJacobian(body, 0.0, state, measured, sigmas, jacobian);
}

FrameVector<double> MovingRodResidualWithJacobian(
    const Body& body, double lift, const PendulumState<double>& state,
    const MeasuredFrame& measured, const ResidualSigmas& sigmas,
    Eigen::Matrix<double, kFrameResiduals, 10>* jacobian) {
  return WithJacobian(BodyNow(body, state.rod, lift), lift, state, measured, sigmas, jacobian);
}

}  // namespace pushid
