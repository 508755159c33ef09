// The adjoint gradient of people who touch: against J'r of the jets in three
// regimes, against finite differences, in any order of people, and where one falls.
#include "residuals/adjoint/adjoint_gradient.h"
#include "tests/residuals/adjoint/gradients.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

struct GroupRegime {
  std::string name;
  double lean, push, noise, weight;
  double falling;  // N m, on one of each group towards the next
  bool touching;   // must some do?
};

std::ostream& operator<<(std::ostream& out, const GroupRegime& regime) {
  return out << regime.name;
}

const GroupRegime kQuiet{"quiet", 0.0, 0.0, 0.01, 0.5, 0.0, false};
const GroupRegime kPushed{"pushed", 0.03, 120.0, 0.02, 0.6, 0.0, true};
const GroupRegime kFalling{"falling", 0.05, 150.0, 0.05, 0.8, 250.0, true};

// Recordings of 34, 40, 25 and 20 frames, of two, five, four and one person.
std::vector<PendulumRecording> Groups(const ModelOptions& options, const GroupRegime& regime,
                                      Random* random) {
  std::vector<PendulumRecording> groups;
  const int frames[] = {34, 40, 25, 20}, people[] = {2, 5, 4, 1};
  for (int i = 0; i < 4; ++i) {
    Scene scene = SceneOfPeople(people[i], regime.lean, random);
    scene.pushes.push_back(RandomPush(0, i, 4, PushKind::kNet, regime.push, random));
    if (people[i] > 1) {
      scene.pushes.push_back(
          RandomPush(1, 2, 5, PushKind::kNetWithoutFriction, 0.3 * regime.push, random));
      scene.pushes.push_back(MakeScenePush(0, 6, PushKind::kExternal,
                                           {8, Vector4<double>(0.0, 0.0, regime.falling, 0.0)}));
    }
    groups.push_back(
        RecordRollout(scene, options, std::vector(people[i], RecoveringParameters()), frames[i]));
    groups.back().id = "group " + std::to_string(i);
    AddNoise(regime.noise, random, &groups.back());
  }
  groups[1].weight = std::vector(5, std::vector<double>(40, 0.5));
  groups[1].weight[2] = std::vector<double>(40, 0.0);  // seen by nobody, felt by neighbours
  return groups;
}

std::vector<AdjointRecording> Weighted(const std::vector<PendulumRecording>& made) {
  return {{&made[0], 1.0}, {&made[1], 0.7}, {&made[2], 1.3, 18}, {&made[3], 0.4}};
}

struct Model {
  ModelOptions options;
  ParameterMap map;
  std::vector<double> shared, weights;
};

// weight: the largest of the network's.
Model MakeModel(const std::string& terms, const NetworkShape& self, const RodShape& rod,
                const PairShape& pair, double weight, Random* random) {
  Model model;
  model.options = WithNetwork(self, weight, random, rod, pair);
  InteractionTerms& on = model.options.interaction;
  for (const InteractionTermName& term : kInteractionTerms) {
    if (terms.find(term.name) != std::string::npos) on.*term.member = true;
  }
  model.map = EveryParameterMap({});
  model.map.num_weights = model.options.learned->num_weights();
  model.shared = SharedBlock(model.map, RandomRecoveringParameters(random, 0.1));
  for (int i = 0; i < model.map.num_weights; ++i) {
    model.weights.push_back(random->Uniform(-weight, weight));
  }
  return model;
}

// Contact alone, the network alone, beside contact and beside LDP's terms, and all that is learned.
std::vector<Model> EveryModel(double weight, Random* random) {
  const NetworkShape mlp{NetworkKind::kMlp, 3};
  const RodShape rod{RodKind::kLdp, {2}};
  std::vector<Model> models = {MakeModel("spring,damping", mlp, {}, {}, weight, random),
                               MakeModel("", {}, {}, {{4}}, weight, random),
                               MakeModel("spring,damping", {}, {}, {{4}}, weight, random),
                               MakeModel("spring,damping", {}, {}, {{13, 6, 9}}, weight, random),
                               MakeModel("damping", {}, {}, {{3, 2}}, weight, random),
                               MakeModel("spring,damping", mlp, rod, {{5}}, weight, random),
                               MakeModel("ldp_published", {NetworkKind::kLdp, 3, 2},
                                         {RodKind::kLdp, {3}}, {{5, 4}, true}, weight, random)};
  models[3].options.push = PushUse::kAsRecorded;
  models[5].options.push = PushUse::kAsRecorded;
  models[2].options.cart_derivative = CartDerivative::kBackward;
  return models;
}

std::string ModelName(const Model& model) {
  return DescribeTerms(model.options.interaction) + " " + PairName(model.options.learned->pair);
}

class AdjointOfPeople : public testing::TestWithParam<GroupRegime> {};

TEST_P(AdjointOfPeople, GradientEqualsForwardSensitivities) {
  const GroupRegime& regime = GetParam();
  Random random(6);
  for (const Model& model : EveryModel(regime.weight, &random)) {
    SCOPED_TRACE(ModelName(model));
    const std::vector<PendulumRecording> made = Groups(model.options, regime, &random);
    const std::vector<AdjointRecording> recordings = Weighted(made);
    const Gradient expected =
        ByJets(recordings, model.options, model.map, model.shared, model.weights);
    const Parameter apart =
        model.options.interaction.Contact() ? kContactDistance : kPotentialLength;
    EXPECT_TRUE(!regime.touching || expected.shared[apart] != 0.0);
    auto adjoint = Unwrapped(AdjointGradient::Create(recordings, model.options, model.map, {}));
    const Gradient actual = ByAdjoint(&adjoint, model.shared, model.weights);
    EXPECT_NEAR(actual.cost, expected.cost, 1e-10 * expected.cost);
    ExpectSameVector(actual.shared, expected.shared, 1e-9, "parameter");
    ExpectSameVector(actual.weights, expected.weights, 1e-9, "weight");
    const Gradient again = ByAdjoint(&adjoint, model.shared, model.weights);
    EXPECT_EQ(again.cost, actual.cost);
    EXPECT_EQ(again.shared, actual.shared);
    EXPECT_EQ(again.weights, actual.weights);
    if (HasFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(ThreeRegimes, AdjointOfPeople, testing::Values(kQuiet, kPushed, kFalling),
                         [](const auto& test) { return test.param.name; });

// (cost(x + h) - cost(x - h)) / 2 h of some entries of x: every `stride`-th.
void ExpectFiniteDifferences(AdjointGradient* adjoint, const Gradient& gradient, Model model,
                             std::vector<double> Model::*of, const std::vector<double>& by,
                             size_t stride) {
  double largest = 0.0;
  for (double value : by) largest = std::max(largest, std::abs(value));
  for (size_t i = 0; i < by.size(); i += stride) {
    double& x = (model.*of)[i];
    const double at = x, step = 1e-5 * std::max(1.0, std::abs(at));
    const auto cost = [&](double value) {
      x = value;
      return adjoint->Evaluate(model.shared.data(), model.weights.data(), nullptr, nullptr).cost;
    };
    const double difference = (cost(at + step) - cost(at - step)) / (2.0 * step);
    x = at;
    EXPECT_NEAR(by[i], difference, 1e-6 * largest + 1e-9 * gradient.cost) << i;
  }
}

// Networks too large for jets to be quick, and each person with parameters of its own.
TEST(AdjointOfPeople, GradientEqualsFiniteDifferences) {
  for (const GroupRegime& regime : {kQuiet, kPushed, kFalling}) {
    SCOPED_TRACE(regime.name);
    Random random(82);
    Model model = MakeModel("spring,damping", {}, {}, {{40, 30}}, 0.4, &random);
    const std::vector<PendulumRecording> made = Groups(model.options, regime, &random);
    std::vector<AdjointRecording> recordings = Weighted(made);
    for (AdjointRecording& r : recordings) {
      for (int n = 0; n < r.recording->num_people(); ++n) {
        r.held.push_back(RandomRecoveringParameters(&random, 0.1));
      }
    }
    model.map.fitted = {{kMu, Transform::kLog, -1}, {kContactStiffness, Transform::kLog, -1}};
    model.shared = {std::log(25.0), std::log(2000.0)};
    auto adjoint = Unwrapped(AdjointGradient::Create(recordings, model.options, model.map, {}));
    const Gradient gradient = ByAdjoint(&adjoint, model.shared, model.weights);
    ExpectFiniteDifferences(&adjoint, gradient, model, &Model::shared, gradient.shared, 1);
    ExpectFiniteDifferences(&adjoint, gradient, model, &Model::weights, gradient.weights, 37);
  }
}

// What differs by setting is held: one set of parameters for each recording.
TEST(AdjointOfPeople, HeldParametersAreThoseOfTheRecording) {
  Random random(83);
  Model model = MakeModel("spring,damping", {}, {}, {{4}}, 0.6, &random);
  model.map.fitted = {{kKpTheta, Transform::kLog, -1}};
  model.shared = {std::log(1700.0)};
  const std::vector<PendulumRecording> made = Groups(model.options, kPushed, &random);
  std::vector<AdjointRecording> recordings = Weighted(made);
  for (AdjointRecording& r : recordings) r.held = {RandomRecoveringParameters(&random, 0.2)};
  const Gradient expected =
      ByJets(recordings, model.options, model.map, model.shared, model.weights);
  auto adjoint = Unwrapped(AdjointGradient::Create(recordings, model.options, model.map, {}));
  const Gradient actual = ByAdjoint(&adjoint, model.shared, model.weights);
  EXPECT_NEAR(actual.cost, expected.cost, 1e-10 * expected.cost);
  ExpectSameVector(actual.shared, expected.shared, 1e-9, "parameter");
  ExpectSameVector(actual.weights, expected.weights, 1e-9, "weight");

  recordings[1].held = {3, RecoveringParameters()};
  EXPECT_TRUE(Contains(ProblemOf(AdjointGradient::Create(recordings, model.options, model.map, {})),
                       "'group 1' has 5 people, but held values of 3"));
}

PendulumRecording Reversed(PendulumRecording r) {
  const int last = r.num_people() - 1;
  const auto reverse = [](auto* list) { std::reverse(list->begin(), list->end()); };
  reverse(&r.scene.people), reverse(&r.states), reverse(&r.hip), reverse(&r.subject_ids);
  reverse(&r.rod_length), reverse(&r.weight);
  for (ScenePush& push : r.scene.pushes) push.person = last - push.person;
  return r;
}

TEST(AdjointOfPeople, OrderOfPeopleAndOfRecordingsDoesNotMatter) {
  Random random(84);
  const Model model = MakeModel("spring,damping", {}, {}, {{9, 5}}, 0.6, &random);
  const std::vector<PendulumRecording> made = Groups(model.options, kFalling, &random);
  std::vector<PendulumRecording> reversed;
  for (const PendulumRecording& r : made) reversed.push_back(Reversed(r));
  const std::vector<AdjointRecording> one = Weighted(made);
  std::vector<AdjointRecording> other = Weighted(reversed);
  std::reverse(other.begin(), other.end());
  auto a = AdjointGradient::Create(one, model.options, model.map, {});
  auto b = AdjointGradient::Create(other, model.options, model.map, {});
  ASSERT_TRUE(a.ok() && b.ok());
  const Gradient expected = ByAdjoint(&a.value(), model.shared, model.weights);
  const Gradient actual = ByAdjoint(&b.value(), model.shared, model.weights);
  EXPECT_NEAR(actual.cost, expected.cost, 1e-12 * expected.cost);
  ExpectSameVector(actual.shared, expected.shared, 1e-11, "parameter");
  ExpectSameVector(actual.weights, expected.weights, 1e-11, "weight");
}

// The frames before a fall count, for everybody whom the one who falls touches; others go on.
TEST(AdjointOfPeople, CountsTheFramesBeforeAFall) {
  Random random(85);
  for (const Model& model : EveryModel(0.6, &random)) {
    SCOPED_TRACE(ModelName(model));
    std::vector<PendulumRecording> made = Groups(model.options, kPushed, &random);
    made[1].scene.pushes.push_back(
        MakeScenePush(1, 8, PushKind::kExternal, {20, Vector4<double>(0.0, 0.0, 3000.0, 0.0)}));
    const std::vector<AdjointRecording> recordings = Weighted(made);
    auto adjoint = Unwrapped(AdjointGradient::Create(recordings, model.options, model.map, {}));
    Gradient actual{0.0, std::vector<double>(model.shared.size()),
                    std::vector<double>(model.weights.size())};
    const AdjointCost cost = adjoint.Evaluate(model.shared.data(), model.weights.data(),
                                              actual.shared.data(), actual.weights.data());
    std::vector<AdjointRecording> shortened = recordings;
    for (size_t i = 0; i < made.size(); ++i) {
      ASSERT_EQ(cost.status[i].ok, i != 1) << i;
    }
    ASSERT_GT(cost.status[1].frame, 9);
    shortened[1].horizon = cost.status[1].frame;
    const Gradient right = ByJets(shortened, model.options, model.map, model.shared, model.weights);
    EXPECT_NEAR(cost.cost, right.cost, 1e-10 * right.cost);
    ExpectSameVector(actual.shared, right.shared, 1e-9, "parameter");
    ExpectSameVector(actual.weights, right.weights, 1e-9, "weight");
  }
}

}  // namespace
}  // namespace pushid
