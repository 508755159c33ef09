// residuals: derivative of one frame's residual.
#include "residuals/frame_residual.h"

namespace pushid {
namespace {

// The robust weight of LDP's rows, each alone: d(w r) = (w + 2 r^2 dw/ds) dr.
template <int kColumns>
FrameVector<double> RobustRows(FrameVector<double> r, double weight, double robust,
                               FrameJacobian<kColumns>* jacobian) {
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
FrameVector<double> WithJacobian(const Body& body, double lift, const PosedPendulum<double>& state,
                                 const MeasuredFrame& measured, const ResidualSigmas& sigmas,
                                 FrameJacobian<kColumns>* jacobian) {
  const FrameVector<double> r =
      RawFrameResidual<double>(body, state, state.angles, measured, sigmas);
  jacobian->setZero();
  RawFrameJacobian<kColumns, double>(body, lift, state, state.angles, sigmas, jacobian);
  if (sigmas.loss == FrameLoss::kLdp)
    return RobustRows(r, measured.weight, sigmas.robust, jacobian);
  return RobustlyWeighted(r, measured.weight, sigmas.robust, jacobian);
}

}  // namespace

FrameVector<double> FrameResidualWithJacobian(const Body& body, const PosedPendulum<double>& state,
                                              const MeasuredFrame& measured,
                                              const ResidualSigmas& sigmas,
                                              FrameJacobian<8>* jacobian) {
  return WithJacobian(body, 0.0, state, measured, sigmas, jacobian);
}

FrameVector<double> MovingRodResidualWithJacobian(const Body& body, double lift,
                                                  const PosedPendulum<double>& state,
                                                  const MeasuredFrame& measured,
                                                  const ResidualSigmas& sigmas,
                                                  FrameJacobian<10>* jacobian) {
  return WithJacobian(BodyNow(body, state.rod, lift), lift, state, measured, sigmas, jacobian);
}

}  // namespace pushid
