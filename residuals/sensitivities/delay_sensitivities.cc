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
    : ankle_(8, num_columns), step_(RolloutSensitivities::Block::Zero(8, num_columns)) {}

void PerceivedSensitivities::Update(const ModelOptions& options, const ParameterSet<double>& p,
                                    const std::vector<ColumnEntry>& entries,
                                    const DelayedPlaces<double>& delayed,
                                    const RolloutPath<double>& path,
                                    const RolloutSensitivities& sensitivities, int frame,
                                    int person) {
  using State = Eigen::Matrix<double, 8, 1>;
  const auto add = [&entries](Parameter id, const State& by, RolloutSensitivities::Block* to) {
    for (const ColumnEntry& entry : entries) {
      if (entry.parameter == id) to->col(entry.column) += entry.derivative * by;
    }
  };
  const PendulumState<double>& now = path.At(frame, person);
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
  State by_delay, by_stiffness = State::Zero(), by_damping = State::Zero();
  by_delay << then.q_by_delay, then.qd_by_delay;
  by_delay.segment<2>(2) *= 1.0 - stiffness;
  by_delay.tail<2>() *= 1.0 - damping;
  by_stiffness.segment<2>(2) = now.q.tail<2>() - then.q.tail<2>();
  by_damping.tail<2>() = (PresentRate(path, frame, person) - then.qd).tail<2>();
  add(kReactionDelay, by_delay, &ankle_);
  add(kPassiveStiffness, by_stiffness, &ankle_);
  add(kPassiveDamping, by_damping, &ankle_);
  if (options.stance == Stance::kFixed) return;
  const DelayedState<double> then_step(path, frame, person, delayed.step);
  DelayedBlock(sensitivities, frame, person, delayed.step, &step_);
  by_delay << then_step.q_by_delay, then_step.qd_by_delay;
  add(StepDelayOf(options.delay), by_delay, &step_);
}

}  // namespace pushid
