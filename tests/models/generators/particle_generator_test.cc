// Particles: one step by hand, samples around forecasts, blends, bones.
#include "models/generators/particle_generator.h"

#include <gtest/gtest.h>

#include "tests/models/generators/generator_samples.h"

namespace pushid {
namespace {

Trajectories Moved(const ParticleNetwork& network, const ObservedMotion& person, int frames) {
  const std::vector<ObservedMotion> people = {person};
  ParticleRollout rollout(network, people);
  Trajectories motion(person.frames.rows(), frames);
  for (int t = 0; t < frames; ++t) motion.col(t) = rollout.Step();
  return motion;
}

// Without drift a network of the first training step carries the last displacement on.
TEST(ParticleRolloutTest, AnUntrainedNetworkGoesOnAtConstantVelocity) {
  ParticleNetwork network = RandomParticles(1);
  network.drift.weights.setZero(), network.drift.bias.setZero();
  network.skip.setZero();
  network.skip.leftCols(12).setIdentity();
  const Trajectories seen = SwayingMotion(12, 0.3f);
  const Trajectories next = Moved(network, {seen}, 4);
  const Eigen::VectorXf step = seen.col(11) - seen.col(10);
  for (int t = 0; t < 4; ++t) {
    EXPECT_LT((next.col(t) - seen.col(11) - (t + 1) * step).norm(), 1e-5f) << t;
  }
}

// A bias alone: p = b, and S moves by step_spread b. A cell of zero weights stays at h = 0.
TEST(ParticleRolloutTest, OneStepByHand) {
  ParticleStructure structure;
  structure.skip = false;
  ParticleNetwork network = RandomParticles(1, structure);
  for (DenseLayer* layer : {&network.input, &network.recurrent}) {
    layer->weights.setZero(), layer->bias.setZero();
  }
  network.drift.bias.setConstant(0.5f);
  network.noise.bias.setConstant(std::log(2.0f));
  const std::vector<ObservedMotion> people = {{SwayingMotion(3, 0.0f)}};
  ParticleRollout rollout(network, people);
  const Eigen::MatrixXf noise = Eigen::MatrixXf::Constant(12, 1, -1.0f);
  const Eigen::VectorXf moved = rollout.Step(&noise) - people[0].frames.col(2);
  EXPECT_LT((moved.array() - 0.01f * (0.5f - 2.0f)).abs().maxCoeff(), 1e-6f);
  // log N(-2; 0, 2^2) for twelve coordinates.
  const double density = -std::log(2.0) - 0.5 - 0.5 * std::log(2.0 * M_PI);
  EXPECT_NEAR(rollout.log_likelihood()(0), 12 * density, 1e-4);
}

TEST(ParticleRolloutTest, NoiseIsHeldWithinItsBounds) {
  ParticleNetwork network = RandomParticles(1);
  network.noise.weights.setZero();
  network.noise.bias.setConstant(50.0f);
  const std::vector<ObservedMotion> people = {{SwayingMotion(12, 0.0f)}};
  ParticleRollout still(network, people), moved(network, people);
  const Eigen::MatrixXf noise = Eigen::MatrixXf::Ones(12, 1);
  const Eigen::VectorXf difference = moved.Step(&noise) - still.Step();
  EXPECT_LT((difference.array() / 0.01f - std::exp(2.0f)).abs().maxCoeff(), 1e-2f);
}

// M = [1 0; 0.6 0.8] for the first two coordinates: e = (1, 1) moves them by 1 and 1.4 of a step,
// and the likelihood is that of N(0, M M^T), whose determinant is 0.8^2.
TEST(ParticleRolloutTest, NoiseMovesCoordinatesTogether) {
  ParticleNetwork network = RandomParticles(1);
  network.noise.weights.setZero(), network.noise.bias.setZero();
  network.noise_mix.topLeftCorner<2, 2>() << 1.0f, 0.0f, 0.6f, 0.8f;
  const std::vector<ObservedMotion> people = {{SwayingMotion(12, 0.0f)}};
  ParticleRollout still(network, people), moved(network, people);
  const Eigen::MatrixXf noise = Eigen::MatrixXf::Ones(12, 1);
  const Eigen::VectorXf difference = (moved.Step(&noise) - still.Step()) / 0.01f;
  EXPECT_NEAR(difference[0], 1.0f, 1e-3f);
  EXPECT_NEAR(difference[1], 1.4f, 1e-3f);
  EXPECT_NEAR(difference[2], 1.0f, 1e-3f);
  EXPECT_NEAR(moved.log_likelihood()(0), -6.0 * (1.0 + std::log(2.0 * M_PI)) - std::log(0.8), 1e-4);
}

// SDE's w_1:K: of two frames, with a cell that takes its input as it is. g^00 = 2, g^10 = 0.5 and
// other diagonals 1, so w = 1 adds 2, 1.5, 1, ... to what goes in, and log N(w) - log 2 a frame.
TEST(ParticleRolloutTest, NoiseGoesInByHand) {
  ParticleStructure structure;
  structure.skip = structure.poses = false;
  structure.noisy_input = true;
  ParticleNetwork network = RandomParticles(1, structure);
  for (DenseLayer* layer :
       {&network.input, &network.recurrent, &network.drift, &network.noise, &network.noise_below}) {
    layer->weights.setZero(), layer->bias.setZero();
  }
  // h = (1 - z) tanh(0.01 x) with z = 1/2 of the first twelve units, and f = h.
  network.input.weights.block(2 * kParticleHidden, 0, 12, 12).diagonal().setConstant(0.01f);
  network.drift.weights.leftCols(12).setIdentity();
  network.noise.bias[0] = std::log(2.0f);
  network.noise_below.bias[12] = 0.5f;
  network.noise_below.bias[1] = 9.0f;  // above the diagonal
  const std::vector<ObservedMotion> people = {
      {Trajectories(SwayingMotion(1, 0.0f).replicate(1, 2))}};
  const NormalSource ones = [] { return 1.0; };
  ParticleRollout rollout(network, people, 1, nullptr, &ones);
  EXPECT_NEAR(rollout.log_likelihood()(0),
              2.0 * (-6.0 * (1.0 + std::log(2.0 * M_PI)) - std::log(2.0)), 1e-4);
  const Eigen::VectorXf moved = (rollout.Step() - people[0].frames.col(1)) / 0.01f;
  // h_1 = 0.5 tanh(0.01 x), h_2 = 0.5 tanh(0.01 x) + 0.5 h_1.
  EXPECT_NEAR(moved[0], 0.75 * std::tanh(0.02), 1e-5);
  EXPECT_NEAR(moved[1], 0.75 * std::tanh(0.015), 1e-5);
  EXPECT_NEAR(moved[2], 0.75 * std::tanh(0.01), 1e-5);
  ParticleRollout quiet(network, people);
  EXPECT_TRUE(quiet.Step() == people[0].frames.col(1)) << "the forecast has no noise";
}

TEST(ParticleRolloutTest, PeopleTogetherAreAsPeopleAlone) {
  const ParticleNetwork network = RandomParticles(2);
  const std::vector<ObservedMotion> people = {{SwayingMotion(12, 0.0f)}, {SwayingMotion(12, 1.0f)}};
  ParticleRollout together(network, people, 2);
  for (int t = 0; t < 5; ++t) together.Step();
  for (int n = 0; n < 4; ++n) {
    const Eigen::VectorXf alone = Moved(network, people[n / 2], 5).col(4);
    EXPECT_LT((together.pose().col(n) - alone).norm(), 1e-5f) << n;
  }
}

// A correction of one term alone, c_0 = 1 for every coordinate: pose_spread sin(pi u / 8) over four
// frames, and what is fed back knows nothing of it.
TEST(ParticleRolloutTest, CorrectionByHand) {
  ParticleStructure structure;
  structure.corrected_frames = 4;
  ParticleNetwork network = RandomParticles(1, structure);
  network.correction.weights.setZero(), network.correction.bias.setZero();
  const ObservedMotion person = {SwayingMotion(12, 0.0f)};
  const Trajectories plain = Moved(network, person, 6);
  network.correction.bias.head(12).setOnes();
  const Trajectories corrected = Moved(network, person, 6);
  for (int u = 1; u <= 6; ++u) {
    const double wave = 0.1 * std::sin(M_PI / 8.0 * std::min(u, 4));
    for (int i = 0; i < 12; ++i) {
      ASSERT_NEAR(corrected(i, u - 1) - plain(i, u - 1), wave, 1e-5) << u << " " << i;
    }
  }
}

class ParticleGeneratorTest : public ::testing::Test {
 protected:
  ParticleGeneratorTest() {
    RidgeFit fit;
    for (float phase : {0.0f, 1.0f, 2.0f}) fit.Add(SwayingMotion(100, phase), 12, 6);
    ridge_ = fit.Solve(1e-4);
  }
  ParticleGenerator Generator(double ridge_share, bool project_bones,
                              double simlpe_share = 0.0) const {
    const ParticleGeneratorOptions options = {ridge_share, simlpe_share, project_bones, 0.0};
    return {FourParticles(),
            {RandomParticles(1), RandomParticles(2)},
            {ridge_, {RandomSimlpe(1), RandomSimlpe(2)}},
            options};
  }
  RidgeForecast ridge_;
  std::vector<ObservedMotion> people_ = {{SwayingMotion(12, 0.4f)}};
};

// Shares by hand: the ridge fades by 1/e in ten frames, and siMLPe comes in as it goes.
TEST_F(ParticleGeneratorTest, BlendsMembersTheLinearForecastAndSimlpe) {
  const Trajectories mean =
      0.5f * (Moved(RandomParticles(1), people_[0], 6) + Moved(RandomParticles(2), people_[0], 6));
  EXPECT_LT((Generator(0.0, false).Forecast(people_, 6)[0] - mean).norm(), 1e-5f);
  const Trajectories& seen = people_[0].frames;
  const Trajectories ridge = ridge_.Forecast(seen);
  const Trajectories simlpe =
      0.5f * (RandomSimlpe(1).Forecast(seen, 6) + RandomSimlpe(2).Forecast(seen, 6));
  const Trajectories blend = Generator(0.4, false, 0.5).Forecast(people_, 6)[0];
  for (int t = 1; t <= 6; ++t) {
    const float fading = std::exp(-0.1f * static_cast<float>(t));
    const float r = 0.4f * fading, s = 0.5f * (1.0f - fading);
    const Eigen::VectorXf expected =
        (1.0f - r - s) * mean.col(t - 1) + r * ridge.col(t - 1) + s * simlpe.col(t - 1);
    EXPECT_LT((blend.col(t - 1) - expected).norm(), 1e-5f) << t;
  }
}

TEST_F(ParticleGeneratorTest, BonesKeepTheLengthsThatWereSeen) {
  const ParticleGenerator generator = Generator(0.3, true, 0.5);
  const Eigen::VectorXf seen = BoneLengths(people_[0].frames.rightCols(1), FourParticles());
  Random random(1);
  std::vector<Trajectories> motions = generator.Forecast(people_, 6);
  const auto futures = generator.Sample(people_, 6, 3, [&] { return random.Normal(); });
  for (const SampledFuture& future : futures[0]) {
    motions.push_back(future.motion);
  }
  ASSERT_EQ(motions.size(), 4u);
  for (const Trajectories& motion : motions) {
    const Eigen::MatrixXf lengths = BoneLengths(motion, FourParticles());
    EXPECT_LT((lengths.colwise() - seen).cwiseAbs().maxCoeff(), 1e-5f);
  }
}

TEST_F(ParticleGeneratorTest, SamplesSpreadAroundTheForecastAndRepeatThemselves) {
  const ParticleGenerator generator = Generator(0.3, false, 0.5);
  const auto sample = [&](uint64_t seed) {
    Random random(seed);
    return generator.Sample(people_, 6, 400, [&] { return random.Normal(); })[0];
  };
  const auto futures = sample(1), again = sample(1), other = sample(2);
  Trajectories mean = Trajectories::Zero(12, 6);
  for (const SampledFuture& future : futures) mean += future.motion / 400.0f;
  const Trajectories forecast = generator.Forecast(people_, 6)[0];
  EXPECT_LT((mean.col(0) - forecast.col(0)).norm(), 5e-3f);
  EXPECT_GT((futures[0].motion - forecast).norm(), 1e-3f);
  EXPECT_EQ(futures[7].motion, again[7].motion);
  EXPECT_NE(futures[7].motion, other[7].motion);
  EXPECT_NE(futures[0].log_likelihood, futures[1].log_likelihood);
}

// Jitter alone spreads the futures too, and the forecast knows nothing of it.
TEST_F(ParticleGeneratorTest, JitterOfThePoseSpreadsFutures) {
  const auto ends = [&](double jitter) {
    const ParticleGenerator generator(FourParticles(), {RandomParticles(1)}, {},
                                      {0.0, 0.0, false, jitter});
    Random random(1);
    const auto futures = generator.Sample(people_, 6, 2, [&] { return random.Normal(); });
    const Trajectories forecast = generator.Forecast(people_, 6)[0];
    return std::make_pair(forecast, Trajectories(futures[0][0].motion - forecast));
  };
  EXPECT_EQ(ends(0.0).first, ends(0.7).first);
  EXPECT_NE(ends(0.0).second, ends(0.7).second);
  const Eigen::MatrixXf jitter = Eigen::MatrixXf::Constant(12, 1, 0.5f);
  const ParticleNetwork network = RandomParticles(1);
  ParticleRollout moved(network, people_, 1, &jitter);
  Trajectories shifted = people_[0].frames;
  shifted.array() += 0.5f * 0.1f;  // half a spread
  const std::vector<ObservedMotion> other = {{shifted}};
  ParticleRollout as_if(network, other);
  const Eigen::VectorXf a = moved.Step() - people_[0].frames.col(11);
  const Eigen::VectorXf b = as_if.Step() - shifted.col(11);
  EXPECT_LT((a - b).norm(), 1e-5f);
}

// Noise of nothing: a future is its member's forecast, moved as the blend moves their mean.
TEST_F(ParticleGeneratorTest, WithoutNoiseTheMembersThemselvesAreSampled) {
  for (const double share : {0.0, 0.5}) {
    const ParticleGenerator generator = Generator(share, false, share);
    const Trajectories moved =
        generator.Forecast(people_, 6)[0] - Generator(0.0, false).Forecast(people_, 6)[0];
    const auto futures = generator.Sample(people_, 6, 2, [] { return 0.0; })[0];
    for (uint64_t m = 0; m < 2; ++m) {
      const Trajectories expected = Moved(RandomParticles(m + 1), people_[0], 6) + moved;
      EXPECT_LT((futures[m].motion - expected).norm(), 1e-5f);
    }
  }
}

// Noise that remembers: after two frames, of steps g e_1 and g e_2 with a correlation of 0.5, the
// spread is sqrt(3) g, against sqrt(2) g of white noise; the likelihood is that of the fresh
// draws.
TEST_F(ParticleGeneratorTest, NoiseMayLast) {
  ParticleNetwork network = RandomParticles(1);
  for (DenseLayer* layer : {&network.input, &network.recurrent, &network.drift, &network.noise}) {
    layer->weights.setZero(), layer->bias.setZero();
  }
  network.skip.setZero();
  const auto spread = [&](double memory) {
    const ParticleGenerator generator(FourParticles(), {network}, {},
                                      {0.0, 0.0, false, 0.0, memory});
    Random random(1);
    const auto futures = generator.Sample(people_, 2, 2000, [&] { return random.Normal(); });
    double square = 0.0;
    for (const SampledFuture& future : futures[0]) {
      square += (future.motion.col(1) - people_[0].frames.col(11)).squaredNorm() / (12 * 2000);
    }
    return std::sqrt(square) / 0.01;
  };
  EXPECT_NEAR(spread(0.0), std::sqrt(2.0), 0.03);
  EXPECT_NEAR(spread(0.5), std::sqrt(3.0), 0.04);
  const ParticleGenerator generator(FourParticles(), {network}, {}, {0.0, 0.0, false, 0.0, 0.5});
  const auto still = generator.Sample(people_, 2, 1, [] { return 1.0; });
  // g is 1: -log(share) - 1/2 - log(2 pi) / 2 for each coordinate and frame.
  const double constant = -0.5 - 0.5 * std::log(2.0 * M_PI);
  EXPECT_NEAR(still[0][0].log_likelihood, 12 * (2 * constant - 0.5 * std::log(0.75)), 1e-3);
}

TEST_F(ParticleGeneratorTest, NobodyHasNoFuture) {
  EXPECT_TRUE(Generator(0.3, true).Forecast({}, 6).empty());
  EXPECT_TRUE(Generator(0.3, true).Sample({}, 6, 3, [] { return 0.0; }).empty());
}

}  // namespace
}  // namespace pushid
