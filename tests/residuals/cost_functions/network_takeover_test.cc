// What a network takes over: known where it is a gain in disguise; its derivatives.
#include "residuals/cost_functions/network_takeover.h"

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
    const Takeover t = TakeoverResidual(recordings, options, 1.0).Of(options.learned->weights);
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
  const Takeover t = TakeoverResidual({recording}, options, 1.0).Of(options.learned->weights);
  const double mu = 0.2 * kNetworkAcceleration * kReferenceMass / kNetworkSpeed;
  EXPECT_NEAR(t.mu, mu, 1e-3 * mu);
  EXPECT_GT(t.rms_force, 0.0);
}

TEST(NetworkTakeover, JacobianAgainstNumericDifferentiation) {
  Random random(63);
  for (const NetworkShape& shape :
       {NetworkShape{NetworkKind::kMlp, 3}, {NetworkKind::kGru, 2}, {NetworkKind::kLstm, 2, 3}}) {
    for (double size : {0.0, 1e-8, 1.0}) {
      SCOPED_TRACE(NetworkName(shape) + " " + std::to_string(size));
      ModelOptions options;
      const PendulumRecording recording = BothPushed(options, &random);
      LearnedTerms network{shape, std::vector<double>(shape.num_weights())};
      for (double& w : network.weights) w = size * random.Uniform(-1.0, 1.0);
      options.learned = std::make_shared<const LearnedTerms>(network);
      const std::vector<PendulumRecording> recordings = {recording};
      ExpectCorrectJacobian(TakeoverResidual(recordings, options, 0.8), {network.weights});
    }
  }
}

}  // namespace
}  // namespace pushid
