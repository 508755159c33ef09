// What learned forces take over: known where a network is a gain in disguise; for contact, the
// regression by other means.
#include "residuals/takeover.h"

#include <Eigen/Core>

#include "models/decompositions.h"
#include "models/neighbours.h"
#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

PendulumRecording BothPushed(const ModelOptions& options, Random* random) {
  Scene scene = SceneOfPeople(2, 0.05, random);
  scene.pushes = {RandomPush(0, 0, 6, PushKind::kExternal, 150.0, random),
                  RandomPush(1, 4, 6, PushKind::kExternal, 120.0, random)};
  return RecordRollout(scene, options, std::vector(2, RecoveringParameters()), 60);
}

// An MLP of one unit so small that it is linear: output `row` answers to input `column` alone.
std::shared_ptr<const LearnedTerms> OneGain(int row, int column, double size) {
  constexpr double kSmall = 1e-5;
  LearnedTerms network{{NetworkKind::kMlp, 1}, {}};
  network.weights.assign(network.shape.num_weights(), 0.0);
  network.weights[column] = kSmall;
  network.weights[network.shape.output_at() + row] = size / kSmall;
  return std::make_shared<const LearnedTerms>(network);
}

struct Disguise {
  std::string name;
  int row, column;
  Eigen::Vector3d taken;  // mu, Kp, Kd by a size of 1, for the scales of the header
};

// Two people, and a network of the mass alone: without scaling of the gains by body, one person's
// M would not be the other's, so that the mass is all that counts here.
TEST(NetworkTakeover, NamesTheGainThatANetworkPlays) {
  Random random(61);
  ModelOptions options;
  options.gain_scaling = GainScaling::kMass;
  const double f = kNetworkAcceleration * kReferenceMass;
  for (const Disguise& d : {Disguise{"stiffness", 2, 0, {0.0, -f / kNetworkAngle, 0.0}},
                            Disguise{"damping", 2, 4, {0.0, 0.0, -f / kNetworkRate}}}) {
    SCOPED_TRACE(d.name);
    options.learned = OneGain(d.row, d.column, -0.3);
    const std::vector<PendulumRecording> recordings = {BothPushed(options, &random)};
    const Takeover t = TakeoverOf(recordings, options);
    const Eigen::Vector3d taken(t.mu, t.kp_theta, t.kd_theta);
    EXPECT_LT((taken + 0.3 * d.taken).norm(), 1e-3 * d.taken.norm()) << taken.transpose();
    EXPECT_EQ(t.rms_force, 0.0);
  }
}

TEST(NetworkTakeover, FrictionInOneDirection) {
  Random random(62);
  ModelOptions options;
  options.gain_scaling = GainScaling::kMass;
  options.learned = OneGain(0, 2, -0.2);
  PendulumRecording recording = BothPushed(options, &random);
  for (auto& states : recording.states) {
    for (PendulumState<double>& state : states) state.qd[1] = 0.0;  // no person moves sideways
  }
  const Takeover t = TakeoverOf({recording}, options);
  const double mu = 0.2 * kNetworkAcceleration * kReferenceMass / kNetworkSpeed;
  EXPECT_NEAR(t.mu, mu, 1e-3 * mu);
  EXPECT_GT(t.rms_force, 0.0);
}

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
  const Eigen::Vector2d expected = SolveLeastNorm(Eigen::MatrixXd(matrix), Eigen::VectorXd(right));
  const ContactTakeover taken = ContactTakeoverOf({recording}, options, p);
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
  const auto of = [&] { return ContactTakeoverOf({recording}, options, RecoveringParameters()); };
  const ContactTakeover whole = of();
  recording.weight.assign(2, std::vector<double>(60, 0.5));
  EXPECT_NEAR(of().stiffness, whole.stiffness, 1e-9 * std::abs(whole.stiffness));
  EXPECT_NEAR(of().rms_force, whole.rms_force, 1e-12);
  recording.weight.assign(2, std::vector<double>(60, 0.0));
  EXPECT_EQ(of().stiffness, 0.0);
  EXPECT_EQ(of().rms_force, 0.0);
}

}  // namespace
}  // namespace pushid
