// A user's own force law: a law that writes friction again must do what friction does, in every
// place where forces act; then a law that bends, against Jets through everything.
#include "residuals/autodiff_force_law.h"

#include <ceres/jet.h>

#include "models/rollout.h"
#include "residuals/jets/autodiff_rollout.h"
#include "tests/models/model_samples.h"
#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

constexpr Parameter kOwn = static_cast<Parameter>(kFirstOwnParameter);
constexpr Parameter kOwnSecond = static_cast<Parameter>(kFirstOwnParameter + 1);

// F_x, F_y = -M / 85 kg * drag v: friction as gain_scaling `mass` has it.
struct Friction {
  template <typename T>
  Vector4<T> operator()(const LawPerson& person, const PendulumState<T>& s, const T* own) const {
    const T drag = -person.body.mass / kReferenceMass * own[0];
    return {drag * s.qd[0], drag * s.qd[1], T(0.0), T(0.0)};
  }
};

std::shared_ptr<const ForceLaw> FrictionLaw() {
  return MakeForceLaw("friction_again", {{"drag", "d", "N s/m", 20.0, -100.0, 100.0, 10.0}},
                      Friction{});
}

// Bends in every input, and couples the planes; zero at rest.
struct Bent {
  template <typename T>
  Vector4<T> operator()(const LawPerson& person, const PendulumState<T>& s, const T* own) const {
    using std::sin, std::tanh;
    const T e_th = s.q[2] - person.posture[0], e_ph = s.q[3] - person.posture[1];
    return {-person.body.mass * own[0] * tanh(s.qd[0] / own[1]) + own[0] * e_ph,
            -person.body.mass * own[0] * tanh(s.qd[1] / own[1]), own[1] * sin(e_th * s.qd[0]),
            own[0] * own[1] * (e_th + s.qd[3])};
  }
};

std::shared_ptr<const ForceLaw> BentLaw() {
  return MakeForceLaw(
      "bent",
      {{"bend", "b", "m/s^2", 0.3, 0.0, 5.0, 0.1}, {"width", "w", "m/s", 0.2, 0.01, 5.0, 0.1}},
      Bent{});
}

// By hand: 80 kg at 0.5 m/s with a drag of 34 N s/m is -80 / 85 * 34 * 0.5 = -16 N.
TEST(AutoDiffForceLaw, ByHand) {
  ForceLaw::Inputs inputs = ForceLaw::Inputs::Zero();
  inputs[4] = 0.5, inputs[8] = 34.0;
  ForceLaw::Jacobian jacobian = ForceLaw::Jacobian::Constant(NAN);
  const Vector4<double> force = FrictionLaw()->Force({{80.0, 0.95, 0.0}}, inputs, &jacobian);
  ExpectClose(force, Vector4<double>(-16.0, 0.0, 0.0, 0.0), 1e-14);
  Eigen::Matrix<double, 4, 9> expected = Eigen::Matrix<double, 4, 9>::Zero();
  expected(0, 4) = expected(1, 5) = -32.0;
  expected(0, 8) = -16.0 / 34.0;
  ExpectClose(jacobian.leftCols<9>(), expected, 1e-14);
}

// The scene's people once with friction of 30 N s/m, once with none and the law at 30.
struct Twins {
  ModelOptions friction, law;
  ParameterSet<double> with_friction = RecoveringParameters(), with_law = with_friction;

  Twins() {
    friction.gain_scaling = law.gain_scaling = GainScaling::kMass;
    friction.friction = law.friction = FrictionKind::kIsotropic;
    law.own_laws = {FrictionLaw()};
    with_friction[kMu] = with_law[kOwn] = 30.0;
    with_law[kMu] = 0.0;
  }
};

TEST(OwnLaw, RollsOutAsTheFrictionItRepeats) {
  const Twins twins;
  Random random(1);
  Scene scene = SceneOfPeople(2, 0.05, &random);
  scene.pushes = {RandomPush(0, 3, 6, PushKind::kExternal, 80.0, &random)};
  RolloutPath<double> friction, law;
  ForceTrace forces;
  const auto start = InitialVelocities(scene);
  ASSERT_TRUE(Rollout(scene, twins.friction, {twins.with_friction}, start, 60, &friction).ok);
  ASSERT_TRUE(Rollout(scene, twins.law, {twins.with_law}, start, 60, &law, &forces).ok);
  double fastest = 0.0;
  for (int t = 0; t < 60; ++t) {
    for (int n : {0, 1}) {
      ExpectClose(law.At(t, n).q, friction.At(t, n).q, 1e-12);
      const Vector4<double> own = forces.At(t, n)[ForcePart::kOwn];
      EXPECT_NEAR(own[0], -scene.people[n].body.mass / 85.0 * 30.0 * law.At(t, n).qd[0], 1e-12);
      fastest = std::max(fastest, std::abs(law.At(t, n).qd[0]));
    }
  }
  EXPECT_GT(fastest, 0.1);
}

TEST(OwnLaw, IsAPartOfReportsOnlyWhereThereIsOne) {
  const Twins twins;
  EXPECT_EQ(ReportedParts(twins.law).back(), ForcePart::kOwn);
  EXPECT_EQ(ReportedParts(twins.friction).back(), ForcePart::kNetwork);
  EXPECT_TRUE(Acts(kOwn, twins.law));
  EXPECT_FALSE(Acts(kOwnSecond, twins.law));
}

// Sensitivities against Jets through the whole rollout; contact and a learned rod beside it.
TEST(OwnLaw, SensitivitiesAreThoseOfJets) {
  Random random(7);
  for (const bool learned : {false, true}) {
    ModelOptions options;
    if (learned) {
      options = WithNetwork({NetworkKind::kMlp, 3}, 0.1, &random, {RodKind::kLdp, {2}});
    } else {
      options.interaction.spring = options.interaction.damping = true;
    }
    options.own_laws = {FrictionLaw(), BentLaw()};
    Scene scene = SceneOfPeople(2, 0.05, &random);
    scene.pushes = {RandomPush(0, 2, 6, PushKind::kNet, 80.0, &random)};
    ParameterSet<double> p = RecoveringParameters();
    p[kOwn] = 10.0, p[kOwnSecond] = 0.3, p[kOwnSecond + 1] = 0.25;
    PendulumRecording recording = RecordRollout(scene, options, {p}, 40);
    AddNoise(0.02, &random, &recording);
    ParameterMap map = EveryParameterMap({kMu, kOwnSecond});
    if (learned) map.num_weights = options.learned->num_weights();
    const auto problem = MakeRolloutProblem(recording, options, map, {}, 0.7, 0);
    ParameterBlocks blocks = RandomBlocks(map, problem->layout, p, 0.05, 0.0, &random);
    if (learned) blocks.back() = options.learned->weights;
    ExpectDirectionalDerivatives(AutoDiffRollout(problem), blocks);
  }
}

}  // namespace
}  // namespace pushid
