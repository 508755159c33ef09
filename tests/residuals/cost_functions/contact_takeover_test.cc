// What a learned interaction takes over from contact: the regression by other means; its
// derivatives.
#include "residuals/cost_functions/contact_takeover.h"

#include <Eigen/Dense>

#include "models/neighbours.h"
#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

ModelOptions Learned(double size, Random* random) {
  ModelOptions options = WithNetwork({}, size, random, {}, {{3}});
  options.interaction.spring = options.interaction.damping = true;
  return options;
}

// Two who are pushed together.
PendulumRecording PushedTogether(const ModelOptions& options, Random* random) {
  Scene scene = SceneOfPeople(2, 0.05, random);
  scene.pushes = {RandomPush(0, 0, 8, PushKind::kExternal, 200.0, random)};
  return RecordRollout(scene, options, std::vector(2, RecoveringParameters()), 60);
}

// Least squares of all forces, stacked.
TEST(ContactTakeover, IsTheRegressionOnUnitContact) {
  Random random(81);
  const ModelOptions options = Learned(0.5, &random);
  const PendulumRecording recording = PushedTogether(options, &random);
  ParameterSet<double> p = RecoveringParameters(), spring = p, damping = p;
  spring[kContactStiffness] = damping[kContactDamping] = 1.0;
  spring[kContactDamping] = damping[kContactStiffness] = 0.0;
  std::vector<double> rows, forces;
  const Pair pair = PairOf(recording.scene, 0, 1);
  for (int t = 0; t < recording.num_frames(); ++t) {
    const PosedPendulum<double> n(recording.states[0][t]), j(recording.states[1][t]);
    PairForce<double> network, by_spring, by_damping;
    AddLearnedPair(options.learned->pair, options.learned->weights.data(), pair, p, n, j, &network);
    ContactTerm<true, true>::Add(pair, spring, n, j, &by_spring);
    ContactTerm<true, true>::Add(pair, damping, n, j, &by_damping);
    for (int i = 0; i < 8; ++i) {
      const auto at = [i](const PairForce<double>& f) { return i < 4 ? f.on_n[i] : f.on_j[i - 4]; };
      rows.push_back(at(by_spring));
      rows.push_back(at(by_damping));
      forces.push_back(at(network));
    }
  }
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;
  const Eigen::Map<const Rows> matrix(rows.data(), static_cast<Eigen::Index>(forces.size()), 2);
  const Eigen::Map<const Eigen::VectorXd> right(forces.data(), matrix.rows());
  const Eigen::Vector2d expected = matrix.colPivHouseholderQr().solve(right);
  const ContactTakeover taken =
      ContactTakeoverResidual({recording}, options, p, 1.0).Of(options.learned->weights);
  EXPECT_GT(expected.norm(), 1.0);
  EXPECT_NEAR(taken.stiffness, expected[0], 1e-9 * expected.norm());
  EXPECT_NEAR(taken.damping, expected[1], 1e-9 * expected.norm());
  EXPECT_GT(taken.rms_force, 0.0);
}

// Frames that count half weigh less; they do not make the force smaller. Those that were not seen
// are no touches.
TEST(ContactTakeover, WeightsAreOfFramesNotOfForces) {
  Random random(83);
  const ModelOptions options = Learned(0.5, &random);
  PendulumRecording recording = PushedTogether(options, &random);
  const auto of = [&] {
    return ContactTakeoverResidual({recording}, options, RecoveringParameters(), 1.0)
        .Of(options.learned->weights);
  };
  const ContactTakeover whole = of();
  recording.weight.assign(2, std::vector<double>(60, 0.5));
  EXPECT_NEAR(of().stiffness, whole.stiffness, 1e-9 * std::abs(whole.stiffness));
  EXPECT_NEAR(of().rms_force, whole.rms_force, 1e-12);
  recording.weight.assign(2, std::vector<double>(60, 0.0));
  EXPECT_EQ(of().stiffness, 0.0);
  EXPECT_EQ(of().rms_force, 0.0);
}

TEST(ContactTakeover, JacobianAgainstNumericDifferentiation) {
  Random random(82);
  for (double size : {0.0, 1e-6, 0.8}) {
    const ModelOptions options = Learned(size, &random);
    const PendulumRecording recording = PushedTogether(options, &random);
    const ContactTakeoverResidual residual({recording}, options, RecoveringParameters(), 2.0);
    std::vector<double> weights = options.learned->weights;
    const int count = static_cast<int>(weights.size());
    const auto evaluate = [&](Eigen::Vector2d* r, double* jacobian) {
      const double* blocks[] = {weights.data()};
      double* jacobians[] = {jacobian};
      ASSERT_TRUE(residual.Evaluate(blocks, r->data(), jacobian != nullptr ? jacobians : nullptr));
    };
    Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor> jacobian(2, count);
    Eigen::Vector2d at, up, down;
    evaluate(&at, jacobian.data());
    const double scale = std::max(1e-3, jacobian.cwiseAbs().maxCoeff());
    for (int i = 0; i < count; ++i) {
      const double kept = weights[i];
      weights[i] = kept + 1e-6;
      evaluate(&up, nullptr);
      weights[i] = kept - 1e-6;
      evaluate(&down, nullptr);
      weights[i] = kept;
      EXPECT_LT(((up - down) / 2e-6 - jacobian.col(i)).norm(), 1e-6 * scale) << size << ", " << i;
    }
  }
}

}  // namespace
}  // namespace pushid
