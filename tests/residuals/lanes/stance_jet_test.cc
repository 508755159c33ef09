// One step of feet that step, in the vectors of every width that the processor has, against Jets.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "models/stance.h"
#include "residuals/lanes/person_lanes.h"
#include "residuals/normal_equations.h"
#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

// Inputs: the feet, the hip as ankles and as steps perceive it, the parameters; a column each.
constexpr int kOfStep = kFeetStates + kHipInputs, kOfParameters = kOfStep + kHipInputs;
constexpr int kInputs = kOfParameters + StanceParameters<double>::kCount;
constexpr int kColumns = 40;  // more than inputs, and no whole number of the widest jets
static_assert(kInputs <= kColumns && kColumns % 16 == 8);
using Jet = ceres::Jet<double, kColumns>;

// Of one step: the inputs, and what Jets say.
struct Step {
  StanceJetInputs in;
  RowMajorMatrix expected = RowMajorMatrix(8, kColumns);
};

PosedPendulum<Jet> HipOf(const PendulumState<double>& state, int first) {
  PendulumState<Jet> jets;
  for (int i = 0; i < 2; ++i) jets.q[2 + i] = Jet(state.q[2 + i], first + i);
  for (int i = 0; i < 4; ++i) jets.qd[i] = Jet(state.qd[i], first + 2 + i);
  return jets;
}

PerceivedHip NumbersOf(const PendulumState<double>& state) {
  const Angles<double> angles(state.q);
  const auto& qd = state.qd;
  return {angles.s_th, angles.c_th, angles.s_ph, angles.c_ph, {qd[0], qd[1], qd[2], qd[3]}};
}

Step StepOf(const StanceBody& body, const ParameterSet<double>& p,
            const PendulumState<double>& ankle, const PendulumState<double>& step, bool late) {
  static const RowMajorMatrix identity = RowMajorMatrix::Identity(kColumns, kColumns);
  const auto rows = [](int first) { return identity.row(first).data(); };
  const FeetState<double>& feet = ankle.feet;
  Step made;
  StanceJetInputs& in = made.in;
  in.body = body;
  in.feet[0] = feet.apart[0], in.feet[1] = feet.apart[1];
  in.feet[2] = feet.clock, in.feet[3] = feet.swing_time;
  in.swings = feet.swings, in.landed = feet.landed, in.fresh = feet.fresh;
  in.ankle = NumbersOf(ankle), in.step = NumbersOf(step);
  in.columns = kColumns;
  in.by_feet = rows(0), in.by_ankle = rows(kFeetStates);
  in.by_step = late ? rows(kOfStep) : nullptr;
  in.by_parameter = rows(kOfParameters);
  FeetState<Jet> jets;
  jets.apart = {Jet(in.feet[0], 0), Jet(in.feet[1], 1)};
  jets.clock = Jet(in.feet[2], 2), jets.swing_time = Jet(in.feet[3], 3);
  jets.swings = feet.swings, jets.landed = feet.landed, jets.fresh = feet.fresh;
  const PosedPendulum<Jet> of_ankle = HipOf(ankle, kFeetStates);
  const PosedPendulum<Jet> of_step = late ? HipOf(step, kOfStep) : of_ankle;
  int k = 0;
  const StanceParameters<Jet> parameters([&](Parameter id) {
    in.parameters[k] = p[id];
    return Jet(p[id], kOfParameters + k++);
  });
  const StanceForces<Jet> out = StanceAt(body, parameters, jets, of_ankle, of_step);
  const Jet outputs[] = {out.velocity[0],   out.velocity[1],   out.torque[0],  out.torque[1],
                         out.next.apart[0], out.next.apart[1], out.next.clock, out.next.swing_time};
  for (int i = 0; i < 8; ++i) made.expected.row(i) = outputs[i].v.transpose();
  return made;
}

// Standing, preparing, lifting off, in the air, landing; the first step and later ones.
TEST(StanceJet, EqualsJetsAtEveryWidth) {
  Random random(31);
  ModelOptions options;
  options.stance = Stance::kSteps;
  int lifts = 0, lands = 0;
  for (int trial = 0; trial < 400; ++trial) {
    options.interaction.spring = trial % 2 == 1;  // among others
    const Body body{random.Uniform(50.0, 100.0), random.Uniform(0.8, 1.1), 0.1};
    const SelfForce self(options, body, {0.0, 0.0, 0.05, -0.02}, 1.0 / 60);
    ParameterSet<double> p = RecoveringParameters();
    p[kStepSwing] = random.Uniform(0.1, 0.4);
    const auto state = [&random] {
      PendulumState<double> made;
      for (int i = 0; i < 2; ++i) made.q[2 + i] = random.Uniform(-0.4, 0.4);
      for (int i = 0; i < 4; ++i) made.qd[i] = random.Uniform(-0.6, 0.6);
      return made;
    };
    PendulumState<double> now = state();
    now.feet.apart = {random.Uniform(-0.4, 0.4), random.Uniform(0.1, 0.3)};
    now.feet.landed = static_cast<signed char>(trial % 3 - 1);
    now.feet.swings = static_cast<signed char>(trial / 3 % 3 - 1);
    now.feet.swing_time = p[kStepSwing];
    now.feet.clock = random.Uniform(0.0, now.feet.swings != 0 ? p[kStepSwing] : p[kStepOnset]);
    now.feet.fresh = trial / 9 % 3 == 0;
    if (now.feet.fresh) {  // lifted off or landed within the last step
      (now.feet.swings != 0 ? now.feet.clock : now.feet.swing_time) =
          random.Uniform(0.0, self.standing.dt);
    }
    const PendulumState<double> felt = state();
    for (bool late : {false, true}) {
      const Step step = StepOf(self.standing, p, now, late ? felt : now, late);
      const FeetState<double> next =
          StanceAt<double>(self.standing,
                           StanceParameters<double>([&p](Parameter id) { return p[id]; }), now.feet,
                           now, late ? felt : now)
              .next;
      lifts += now.feet.swings == 0 && next.swings != 0;
      lands += now.feet.swings != 0 && next.swings == 0;
      for (const PersonLanes* lanes : SupportedPersonLanes()) {
        RowMajorMatrix found = RowMajorMatrix::Constant(8, kColumns, NAN);
        lanes->stance_jet(step.in, found.data(), found.row(4).data());
        for (int i = 0; i < found.size(); ++i) {
          const double expected = step.expected.data()[i];
          ASSERT_NEAR(found.data()[i], expected, 1e-9 * (1.0 + std::abs(expected)))
              << lanes->name << ", trial " << trial << ", input " << i % kColumns << ", output "
              << i / kColumns;
        }
      }
    }
  }
  EXPECT_GT(lifts, 10);
  EXPECT_GT(lands, 10);
}

}  // namespace
}  // namespace pushid
