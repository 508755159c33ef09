// residuals: the chain rule through one step of a rod law.
#include "residuals/sensitivities/rod_sensitivities.h"

namespace pushid {

RodSensitivities::RodSensitivities(const LearnedTerms& network, const double* weights,
                                   int num_columns, int weight_column)
    : shape_(network.rod),
      weights_(weights + network.rod_at()),
      weight_column_(weight_column < 0 ? -1 : weight_column + network.rod_at()),
      own_(weight_column < 0 ? 0 : shape_.num_weights()),
      velocity_(num_columns) {}

const Eigen::RowVectorXd& RodSensitivities::Velocity(const RodStep& step, const States& by_state,
                                                     const States& before, const Row& rod) {
  static const auto kScales = MotionInputScales();
  const bool fitted = weight_column_ >= 0;
  const RodInputGradient by_input =
      RodVelocityGradient(shape_, weights_, step.layers, fitted ? own_.data() : nullptr);
  const Eigen::RowVector4d by_force =
      by_input.segment<4>(RodShape::kForceInputs) / (kNetworkAcceleration * step.mass);
  Eigen::Matrix<double, 1, 8> along = by_force * step.self.by_state;
  along.tail<kMotionInputs>() += by_input.head<kMotionInputs>() * kScales.asDiagonal();
  velocity_.noalias() = along * by_state;
  velocity_ += (by_input[RodShape::kRodInput] / kNetworkRod) * rod;
  if (!step.self.by_previous.isZero(0.0)) {
    const Eigen::RowVector2d back = by_force.head<2>() * step.self.by_previous.asDiagonal();
    velocity_.noalias() += back * before.middleRows<2>(4);
  }
  for (const ColumnEntry& entry : step.parameters) {
    velocity_[entry.column] +=
        entry.derivative * by_force.dot(step.self.by_parameter.col(entry.parameter));
  }
  if (step.network != nullptr) step.network->AddTo(by_force, &velocity_);
  if (fitted) velocity_.segment(weight_column_, own_.size()) += own_;
  return velocity_;
}

}  // namespace pushid
