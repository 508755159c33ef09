// The adjoint gradient against J'r of the jets, for every kind of network and
// several recordings of several people, in three regimes.
#include "residuals/adjoint/adjoint_gradient.h"

#include "residuals/autodiff_force_law.h"
#include "tests/residuals/adjoint/gradients.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

struct Learned {
  NetworkShape self;
  RodShape rod = {};

  // Differences of tanh stand in both.
  bool mlp() const { return self.kind == NetworkKind::kMlp; }
  std::string Name() const { return NetworkName(self) + ", rod " + RodName(rod); }
};

std::vector<Learned> EveryLearned() {
  const RodShape rod{RodKind::kLdp, {5}}, deep{RodKind::kLdp, {4, 9, 3}};
  std::vector<Learned> all = {
      {{}, rod}, {{}, deep}, {{NetworkKind::kMlp, 2}, rod}, {{NetworkKind::kLdp, 3, 2}, deep}};
  for (const NetworkShape& shape : std::vector<NetworkShape>{{NetworkKind::kMlp, 4},
                                                             {NetworkKind::kMlp, 13},
                                                             {NetworkKind::kLdp, 4, 3},
                                                             {NetworkKind::kLdp, 17, 9}}) {
    all.push_back({shape});
  }
  return all;
}

struct NetworkRegime {
  std::string name;
  double lean, push, noise, weight;
  double mlp;  // tolerance of what tanh(W x + C k) - tanh(C k) leaves of the digits of W x
};

std::ostream& operator<<(std::ostream& out, const NetworkRegime& regime) {
  return out << regime.name;
}

// Recordings of 23, 40, 31 and 1 + 11 frames, of one, two, three and one person.
std::vector<PendulumRecording> SomeRecordings(const ModelOptions& options,
                                              const NetworkRegime& regime, Random* random) {
  std::vector<PendulumRecording> recordings;
  const int frames[] = {23, 40, 31, 12}, people[] = {1, 2, 3, 1};
  for (int i = 0; i < 4; ++i) {
    Scene scene = SceneOfPeople(people[i], regime.lean, random);
    scene.pushes.push_back(RandomPush(0, i, 4, PushKind::kNet, regime.push, random));
    if (people[i] > 1) {
      scene.pushes.push_back(
          RandomPush(1, 2, 5, PushKind::kNetWithoutFriction, regime.push, random));
    }
    recordings.push_back(
        RecordRollout(scene, options, std::vector(people[i], RecoveringParameters()), frames[i]));
    recordings.back().id = "recording " + std::to_string(i);
    AddNoise(regime.noise, random, &recordings.back());
  }
  recordings[1].weight = {std::vector<double>(40, 0.5), {}};
  return recordings;
}

class AdjointTwins : public testing::TestWithParam<NetworkRegime> {};

TEST_P(AdjointTwins, GradientEqualsForwardSensitivities) {
  const NetworkRegime& regime = GetParam();
  Random random(6);
  for (const Learned& learned : EveryLearned()) {
    for (PushUse use : {PushUse::kAdded, PushUse::kAsRecorded}) {
      for (CartDerivative derivative : {CartDerivative::kNone, CartDerivative::kBackward}) {
        SCOPED_TRACE(learned.Name());
        ModelOptions options = WithNetwork(learned.self, regime.weight, &random, learned.rod);
        options.push = use;
        options.cart_derivative = derivative;
        ParameterMap map = EveryParameterMap({});
        map.num_weights = options.learned->num_weights();
        const std::vector<PendulumRecording> made = SomeRecordings(options, regime, &random);
        const std::vector<AdjointRecording> recordings = {
            {&made[0], 1.0}, {&made[1], 0.7}, {&made[2], 1.3, 25}, {&made[3], 1.0}};
        const std::vector<double> shared =
            SharedBlock(map, RandomRecoveringParameters(&random, 0.1));
        std::vector<double> weights;
        for (int i = 0; i < map.num_weights; ++i) {
          weights.push_back(random.Uniform(-regime.weight, regime.weight));
        }
        const Gradient expected = ByJets(recordings, options, map, shared, weights);
        const double tolerance = learned.mlp() ? regime.mlp : 1e-10;
        auto adjoint = Unwrapped(AdjointGradient::Create(recordings, options, map, {}));
        const Gradient actual = ByAdjoint(&adjoint, shared, weights);
        // Products round otherwise than a person's alone, and a rollout carries that along.
        EXPECT_NEAR(actual.cost, expected.cost, 1e-11 * expected.cost);
        ExpectSameVector(actual.shared, expected.shared, tolerance, "parameter");
        ExpectSameVector(actual.weights, expected.weights, tolerance, "weight");
        const Gradient again = ByAdjoint(&adjoint, shared, weights);
        EXPECT_EQ(again.cost, actual.cost);
        EXPECT_EQ(again.shared, actual.shared);
        EXPECT_EQ(again.weights, actual.weights);
        if (HasFailure()) return;
      }
    }
  }
}

// At rest every derivative vanishes in the network; without noise all of it would be zero.
INSTANTIATE_TEST_SUITE_P(ThreeRegimes, AdjointTwins,
                         testing::Values(NetworkRegime{"at_rest", 0.0, 0.0, 0.01, 0.5, 1e-10},
                                         NetworkRegime{"tiny", 0.0, 1e-6, 0.01, 0.5, 1e-6},
                                         NetworkRegime{"large", 0.1, 100.0, 0.05, 0.8, 1e-10}),
                         [](const auto& test) { return test.param.name; });

// A person falls: the frames before count, for all people of the recording, and others go on.
TEST(AdjointGradient, CountsTheFramesBeforeAFailure) {
  Random random(62);
  for (const Learned& learned : EveryLearned()) {
    SCOPED_TRACE(learned.Name());
    const ModelOptions options = WithNetwork(learned.self, 0.8, &random, learned.rod);
    ParameterMap map = EveryParameterMap({});
    map.num_weights = options.learned->num_weights();
    std::vector<PendulumRecording> made =
        SomeRecordings(options, {"", 0.1, 100.0, 0.05, 0.8, 0.0}, &random);
    made[1].scene.pushes.push_back(
        MakeScenePush(1, 8, PushKind::kExternal, {20, Vector4<double>(0.0, 0.0, 3000.0, 0.0)}));
    made[2].scene = ScalePushes(made[2].scene, 1e9);  // at once, and beyond any number
    const std::vector<double> shared = SharedBlock(map, RecoveringParameters());
    const std::vector<double>& weights = options.learned->weights;

    std::vector<AdjointRecording> recordings, shortened;
    std::vector<RolloutStatus> expected;
    for (const PendulumRecording& recording : made) {
      recordings.push_back({&recording});
      RolloutPath<double> path;
      expected.push_back(Rollout<double>(recording.scene, options, {RecoveringParameters()},
                                         InitialVelocities(recording.scene), recording.num_frames(),
                                         &path));
      shortened.push_back({&recording, 1.0, expected.back().ok ? 0 : expected.back().frame});
    }
    ASSERT_FALSE(expected[1].ok || expected[2].ok);
    ASSERT_TRUE(expected[0].ok && expected[3].ok);
    ASSERT_GT(expected[1].frame, 9);
    auto adjoint = Unwrapped(AdjointGradient::Create(recordings, options, map, {}));
    Gradient actual{0.0, std::vector<double>(shared.size()), std::vector<double>(weights.size())};
    const AdjointCost cost = adjoint.Evaluate(shared.data(), weights.data(), actual.shared.data(),
                                              actual.weights.data());
    EXPECT_FALSE(cost.ok());
    for (size_t i = 0; i < made.size(); ++i) {
      EXPECT_EQ(cost.status[i].ok, expected[i].ok) << i;
      if (expected[i].ok) continue;
      EXPECT_EQ(cost.status[i].frame, expected[i].frame) << i;
      EXPECT_EQ(cost.status[i].person, expected[i].person) << i;
      EXPECT_EQ(cost.status[i].quantity, expected[i].quantity) << i;
    }
    if (expected[2].frame == 1) shortened.erase(shortened.begin() + 2);  // nothing to compare
    const Gradient right = ByJets(shortened, options, map, shared, weights);
    EXPECT_NEAR(cost.cost, right.cost, 1e-12 * right.cost);
    ExpectSameVector(actual.shared, right.shared, 1e-10, "parameter");
    ExpectSameVector(actual.weights, right.weights, 1e-10, "weight");
  }
}

// More people than go side by side, and each gradient alone.
TEST(AdjointGradient, AddsUpManyRecordings) {
  Random random(63);
  const ModelOptions options = WithNetwork({NetworkKind::kMlp, 5}, 0.8, &random);
  const std::vector<PendulumRecording> made =
      SomeRecordings(options, {"", 0.1, 100.0, 0.05, 0.8, 0.0}, &random);
  ParameterMap map = EveryParameterMap({});
  map.num_weights = options.learned->shape.num_weights();
  std::vector<AdjointRecording> once, often;
  for (const PendulumRecording& recording : made) once.push_back({&recording});
  for (int i = 0; i < 40; ++i) often.insert(often.end(), once.begin(), once.end());
  auto one = AdjointGradient::Create(once, options, map, {});
  auto forty = AdjointGradient::Create(often, options, map, {});
  ASSERT_TRUE(one.ok() && forty.ok());
  const std::vector<double> shared = SharedBlock(map, RecoveringParameters());
  Gradient small = ByAdjoint(&one.value(), shared, options.learned->weights);
  const Gradient large = ByAdjoint(&forty.value(), shared, options.learned->weights);
  for (double& value : small.shared) value *= 40.0;
  for (double& value : small.weights) value *= 40.0;
  EXPECT_NEAR(large.cost, 40.0 * small.cost, 1e-12 * large.cost);
  ExpectSameVector(large.shared, small.shared, 1e-12, "parameter");
  ExpectSameVector(large.weights, small.weights, 1e-12, "weight");

  std::vector<double> shared_alone(shared.size(), NAN), weights_alone(map.num_weights, NAN);
  const double* weights = options.learned->weights.data();
  EXPECT_EQ(forty.value().Evaluate(shared.data(), weights, nullptr, nullptr).cost, large.cost);
  forty.value().Evaluate(shared.data(), weights, shared_alone.data(), nullptr);
  forty.value().Evaluate(shared.data(), weights, nullptr, weights_alone.data());
  EXPECT_EQ(shared_alone, large.shared);
  EXPECT_EQ(weights_alone, large.weights);
}

// Values held per person are the gradient's own: the list it was made of may be gone.
TEST(AdjointGradient, KeepsHeldValues) {
  Random random(66);
  const ModelOptions options = WithNetwork({NetworkKind::kMlp, 2}, 0.5, &random);
  const std::vector<PendulumRecording> made =
      SomeRecordings(options, {"", 0.1, 100.0, 0.05, 0.5, 0.0}, &random);
  ParameterMap map;
  map.num_weights = options.learned->num_weights();
  std::vector<AdjointRecording> recordings = {{&made[0]}, {&made[1]}};
  for (AdjointRecording& r : recordings) r.held = {RecoveringParameters()};
  auto adjoint = Unwrapped(AdjointGradient::Create(recordings, options, map, {}));
  const double* weights = options.learned->weights.data();
  const double cost = adjoint.Evaluate(nullptr, weights, nullptr, nullptr).cost;
  for (AdjointRecording& r : recordings) r.held[0].fill(NAN);
  recordings.clear();
  EXPECT_EQ(adjoint.Evaluate(nullptr, weights, nullptr, nullptr).cost, cost);
}

// F_x = -M b tanh(xd / 0.2 m/s): a law of a user's own.
struct Brake {
  template <typename T>
  Vector4<T> operator()(const LawPerson& person, const PendulumState<T>& s, const T* own) const {
    using std::tanh;
    Vector4<T> force = Vector4<T>::Zero();
    force[0] = -person.body.mass * own[0] * tanh(s.qd[0] / 0.2);
    return force;
  }
};

TEST(AdjointGradient, KnowsAUsersOwnLaw) {
  Random random(65);
  const NetworkRegime regime{"", 0.1, 100.0, 0.05, 0.5, 0.0};
  ModelOptions options =
      WithNetwork({NetworkKind::kMlp, 2}, regime.weight, &random, {RodKind::kLdp, {2}});
  options.own_laws = {
      MakeForceLaw("brake", {{"brake", "b", "m/s^2", 0.1, 0.0, 5.0, 0.1}}, Brake{})};
  ParameterMap map = EveryParameterMap({});
  map.num_weights = options.learned->num_weights();
  const std::vector<PendulumRecording> made = SomeRecordings(options, regime, &random);
  const std::vector<AdjointRecording> recordings = {{&made[0]}, {&made[1]}};
  ParameterSet<double> p = RecoveringParameters();
  p[kFirstOwnParameter] = 0.3;
  const std::vector<double> shared = SharedBlock(map, p), weights = options.learned->weights;
  const Gradient expected = ByJets(recordings, options, map, shared, weights);
  auto adjoint = Unwrapped(AdjointGradient::Create(recordings, options, map, {}));
  const Gradient actual = ByAdjoint(&adjoint, shared, weights);
  EXPECT_NE(expected.shared[kFirstOwnParameter], 0.0);
  ExpectSameVector(actual.shared, expected.shared, 1e-10, "parameter");
  ExpectSameVector(actual.weights, expected.weights, 1e-10, "weight");
}

TEST(AdjointGradient, RefusesWhatItDoesNotKnow) {
  Random random(64);
  ModelOptions options = WithNetwork({NetworkKind::kMlp, 2}, 0.5, &random);
  std::vector<PendulumRecording> made =
      SomeRecordings(options, {"", 0.1, 100.0, 0.05, 0.5, 0.0}, &random);
  made[0].id = "freely";
  const ParameterMap map = EveryParameterMap({});
  const auto complaint = [&](const ModelOptions& o, const ParameterMap& m) {
    const auto created = AdjointGradient::Create({{&made[0]}, {&made[1]}}, o, m, {});
    return created.ok() ? "" : created.error().ToString();
  };
  EXPECT_EQ(complaint(options, map), "");
  EXPECT_TRUE(Contains(complaint({}, map), "needs a network"));
  ModelOptions standing = options;
  standing.stance = Stance::kSteps;
  EXPECT_TRUE(Contains(complaint(standing, map), "feet that slide"));
  EXPECT_TRUE(Contains(complaint(options, EveryParameterMap({kMu})), "deviations"));
  made[0].initial_velocity = InitialVelocity::kFree;
  EXPECT_TRUE(Contains(complaint(options, map), "'freely' has a free initial velocity"));
}

}  // namespace
}  // namespace pushid
