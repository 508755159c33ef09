// residuals: the chain rule through a reaction delay.
#include "residuals/sensitivities/delay_sensitivities.h"

#include "models/reaction_delay.h"

namespace pushid {
namespace {

// d [q, qd] of a delayed state / d columns. Before frame 0 people are at rest where they started.
void DelayedBlock(const RolloutSensitivities& sensitivities, int now, int person,
                  const DelayedPlace<double>& place, RolloutSensitivities::Block* block) {
  block->setZero();
  for (int i = 0; i < DelayedFrames<double>::kCount; ++i) {
    const int pose = now - place.of_pose.back - i, rate = now - place.of_rate.back - i;
    // A start's pose has no derivatives.
    if (pose >= 0) {
      block->topRows<4>() += place.of_pose.weight[i] * sensitivities.At(pose, person).topRows<4>();
    }
    if (rate >= 0) {
      block->bottomRows<4>() +=
          place.of_rate.weight[i] * sensitivities.At(rate, person).bottomRows<4>();
    }
  }
}

}  // namespace

PerceivedSensitivities::PerceivedSensitivities(int num_columns)
    : ankle_(8, num_columns), step_(8, num_columns) {}

void PerceivedSensitivities::Update(const ModelOptions& options, const ParameterSet<double>& p,
                                    const DelayedPlaces<double>& delayed,
                                    const RolloutPath<double>& path,
                                    const RolloutSensitivities& sensitivities, int frame,
                                    int person) {
  const PendulumState<double>& now = path.At(frame, person);
  step_delay_ = StepDelayOf(options.delay);
  steps_ = options.stance != Stance::kFixed;
  const DelayedState<double> then(path, frame, person, delayed.ankle);
  DelayedBlock(sensitivities, frame, person, delayed.ankle, &ankle_);
  const double stiffness = p[kPassiveStiffness], damping = p[kPassiveDamping];
  const auto of_now = sensitivities.At(frame, person);
  ankle_.middleRows<2>(2) =
      (1.0 - stiffness) * ankle_.middleRows<2>(2) + stiffness * of_now.middleRows<2>(2);
  ankle_.bottomRows<2>() = (1.0 - damping) * ankle_.bottomRows<2>() +
                           damping * (frame > 0 ? kRateAhead : 1.0) * of_now.bottomRows<2>();
  if (frame > 0) {
    ankle_.bottomRows<2>() +=
        damping * (1.0 - kRateAhead) * sensitivities.At(frame - 1, person).bottomRows<2>();
  }
  ankle_by_delay_ << then.q_by_delay, then.qd_by_delay;
  by_stiffness_share_.setZero();
  by_damping_share_.setZero();
  ankle_by_delay_.segment<2>(2) *= 1.0 - stiffness;
  ankle_by_delay_.tail<2>() *= 1.0 - damping;
  by_stiffness_share_.segment<2>(2) = now.q.tail<2>() - then.q.tail<2>();
  by_damping_share_.tail<2>() = (PresentRate(path, frame, person) - then.qd).tail<2>();
  if (!steps_) return;
  const DelayedState<double> then_step(path, frame, person, delayed.step);
  DelayedBlock(sensitivities, frame, person, delayed.step, &step_);
  step_by_delay_ << then_step.q_by_delay, then_step.qd_by_delay;
}

void PerceivedSensitivities::AddTo(
    const Eigen::Matrix<double, 4, 8>& by_ankle, const Eigen::Matrix<double, 4, 8>& by_step,
    Eigen::Ref<Eigen::Matrix<double, 4, Eigen::Dynamic, Eigen::RowMajor>> by_column) const {
  by_column.noalias() += by_ankle * ankle_;
  if (steps_) by_column.noalias() += by_step * step_;
}

void PerceivedSensitivities::AddParameters(
    const Eigen::Matrix<double, 4, 8>& by_ankle, const Eigen::Matrix<double, 4, 8>& by_step,
    Eigen::Matrix<double, 4, kNumParameters>* by_parameter) const {
  by_parameter->col(kReactionDelay) += by_ankle * ankle_by_delay_;
  if (steps_) by_parameter->col(step_delay_) += by_step * step_by_delay_;
  by_parameter->col(kPassiveStiffness) += by_ankle * by_stiffness_share_;
  by_parameter->col(kPassiveDamping) += by_ankle * by_damping_share_;
}

}  // namespace pushid
