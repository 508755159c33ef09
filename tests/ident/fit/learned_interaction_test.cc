// Fits with a learned interaction: a planted one is found again (its predictions, not its weights),
// people of any order give the same fit, and files that contradict themselves are named.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ident/fit/fit.h"
#include "ident/fit/fit_setup.h"
#include "ident/model/model_json.h"
#include "ident/parameters/fit_options.h"
#include "ident/parameters/presets.h"
#include "ident/prediction/evaluation.h"
#include "ident/problem/fit_problem.h"
#include "ident/report/report_text.h"
#include "ident/solver/solver.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

// Rows of three who touch, and give each other more than contact does.
struct Rows {
  std::vector<PendulumRecording> training, held_out;
  FitOptions options;  // nothing learned

  Rows() {
    SyntheticOptions study;
    study.people_in_row = 3;
    study.recordings_per_subject = 6;
    study.frames = 60;
    study.joint_noise_m = 0.0;
    study.lean_sigma_rad = 0.01;
    study.model.interaction.spring = study.model.interaction.damping = true;
    const ParameterTable table = MakePreset("tail").value().table;
    for (int i = kFirstPairParameter; i < kFirstOwnParameter; ++i) {
      study.parameters[i] = table.specs[i].nominal;
    }
    study.parameters[kContactStiffness] = 2800.0;
    study.parameters[kContactDistance] = 0.42;
    options = UnbiasedFit(study);
    FreeTerms(&options);
    for (ParameterSpec& spec : options.table.specs) {
      spec.prior.reset();
      spec.free = spec.id == kContactStiffness || spec.id == kContactDamping || spec.id == kMu;
    }
    options.network_prior = 30.0;
    LearnedTerms planted = *InitialNetwork({}, 99, {}, PairShape{{3}});
    Random random(98);
    for (size_t i = planted.weights.size() - 16; i < planted.weights.size(); ++i) {
      planted.weights[i] = random.Uniform(-0.8, 0.8);
    }
    study.model.learned = std::make_shared<const LearnedTerms>(planted);
    study.model.interaction.learned = true;
    const std::vector<PendulumRecording> all = MakePendulums(study);
    for (size_t i = 0; i < all.size(); ++i) {
      (i % 4 == 0 ? held_out : training).push_back(all[i]);
    }
  }

  FitOptions With(const PairShape& pair) const {
    FitOptions with = options;
    with.model.interaction.learned = pair.any();
    if (pair.any()) with.model.learned = InitialNetwork({}, 1, {}, pair);
    return with;
  }
  FitResult Fitted(const PairShape& pair) const { return Fit(training, With(pair)); }
  double HeldOutAde(const FitResult& result) const {
    return Evaluate(ModelOf(result), held_out).model.mean.value[kHipAde];
  }
};

TEST(LearnedInteraction, PredictsUnseenPushesAsTheTruthDoes) {
  const Rows rows;
  const double without = rows.HeldOutAde(rows.Fitted({}));
  const FitResult learned = rows.Fitted({{3}});
  EXPECT_GT(without, 0.002);
  EXPECT_LT(rows.HeldOutAde(learned), 0.25 * without);
  EXPECT_TRUE(Contains(NetworkText(learned), "interaction network:3 (49 weights"));
}

// One of too many weights for a Jacobian learns by its gradient, beside what people differ in; the
// physical parameters are fitted again after it, and the file keeps all of it.
TEST(LearnedInteraction, LargeOnesLearnByTheirGradient) {
  Rows rows;
  rows.options.max_iterations = 100;
  const double without = rows.HeldOutAde(rows.Fitted({}));
  const PairShape large{{48, 32}};
  ASSERT_GT(large.num_weights(), kMostGaussNewtonWeights);
  const FitResult learned = rows.Fitted(large);
  ASSERT_TRUE(learned.ok()) << learned.message;
  EXPECT_GT(without, 0.002);
  EXPECT_LT(rows.HeldOutAde(learned), without);
  EXPECT_TRUE(Contains(NetworkText(learned), "interaction network:48-32 (2228 weights"));
  const nlohmann::ordered_json json = ToJson({learned, {}, {}, {}, {}}, RunInfo{});
  const FittedModel read = Unwrapped(FittedModelFromJson(json, "model.json"));
  EXPECT_EQ(rows.HeldOutAde(read.fit), rows.HeldOutAde(learned));
}

// Where contact is learned alone, its parameters act through the network's gate and nothing else:
// physics alone is without them.
TEST(LearnedInteraction, LargeOnesLearnWithoutContact) {
  Rows rows;
  rows.options.max_iterations = 20;
  FitOptions options = rows.With({{48, 32}});
  options.model.interaction.spring = options.model.interaction.damping = false;
  FreeTerms(&options);
  options.table[kContactDamping].free = options.table[kContactStiffness].free = false;
  options.table[kContactDistance].free = true;
  ASSERT_FALSE(PrepareFit(rows.training, &options));
  EXPECT_FALSE(PhysicsAlone(options).table[kContactDistance].free);
  const FitResult learned = Fit(rows.training, options);
  ASSERT_TRUE(learned.ok()) << learned.message;
  EXPECT_NE(learned.parameters[kContactDistance], options.table[kContactDistance].nominal);
}

TEST(LearnedInteraction, OrderOfPeopleDoesNotMatter) {
  Rows rows, mixed;
  for (PendulumRecording& r : mixed.training) {
    const int last = r.num_people() - 1;
    const auto swap = [last](auto* list) { std::swap((*list)[0], (*list)[last]); };
    swap(&r.scene.people), swap(&r.states), swap(&r.hip), swap(&r.subject_ids);
    if (!r.rod_length.empty()) swap(&r.rod_length);
    if (!r.weight.empty()) swap(&r.weight);
    const auto swapped = [last](int person) {
      return person == 0 ? last : person == last ? 0 : person;
    };
    for (ScenePush& push : r.scene.pushes) push.person = swapped(push.person);
    r.pushed_person = swapped(r.pushed_person);
  }
  const auto solve = [](const Rows& of) {
    FitOptions with = of.With({{2}});
    with.max_iterations = 4;
    const FitProblem problem(of.training, with);
    return SolveFrom(problem, problem.NominalPoint(), "nominal", nullptr);
  };
  const SolveStart one = solve(rows), other = solve(mixed);
  EXPECT_GT(one.cost, 0.0);
  EXPECT_NEAR(one.cost, other.cost, 1e-6 * one.cost);
  ASSERT_EQ(one.to.weights.size(), other.to.weights.size());
  for (size_t i = 0; i < one.to.weights.size(); ++i) {
    EXPECT_NEAR(one.to.weights[i], other.to.weights[i], 1e-5);
  }
}

TEST(LearnedInteraction, ComesBackFromItsFile) {
  Rows rows;
  rows.options.max_iterations = 5;
  const FitResult fitted = rows.Fitted({{2, 2}});
  const nlohmann::ordered_json json = ToJson({fitted, {}, {}, {}, {}}, RunInfo{});
  EXPECT_EQ(json.at("model").at("interaction"), "spring,damping,network:2-2");
  const FittedModel read = Unwrapped(FittedModelFromJson(json, "model.json"));
  EXPECT_EQ(rows.HeldOutAde(read.fit), rows.HeldOutAde(fitted));
  nlohmann::ordered_json without = json;
  without["self_network"].erase("interaction");
  without["self_network"]["rod"]["kind"] = "mlp";
  EXPECT_FALSE(FittedModelFromJson(without, "model.json").ok());
  nlohmann::ordered_json other = json;
  other["model"]["interaction"] = "spring,damping,network:4";
  EXPECT_TRUE(Contains(ProblemOf(FittedModelFromJson(other, "model.json")),
                       "interaction is spring,damping,network:4"));
}

TEST(LearnedInteraction, ByName) {
  const InteractionChoice choice =
      Unwrapped(ParseInteraction("--interaction", "spring,network:8-3"));
  EXPECT_TRUE(choice.terms.spring && choice.terms.learned);
  EXPECT_FALSE(choice.terms.damping);
  EXPECT_EQ(choice.pair.hidden, std::vector<int>({8, 3}));
  EXPECT_FALSE(ParseInteraction("--interaction", "none").value().terms.Any());
  const InteractionTerms touching = ParseInteraction("f", "network:4").value().terms;
  EXPECT_TRUE(touching.learned && touching.Contact() && !touching.AtCarts());
  const InteractionTerms in_range = ParseInteraction("f", "ldp_network:4").value().terms;
  EXPECT_TRUE(in_range.learned && in_range.AtCarts() && !in_range.Contact());
  for (const char* bad :
       {"network", "network:", "network:0", "network:4-", "network:9999", "network:x",
        "network:4,network:4", "none,network:4", "ldp_network:", "network:4,ldp_network:4"}) {
    EXPECT_TRUE(Contains(ProblemOf(ParseInteraction("--interaction", bad)), "--interaction"));
  }
  const FitOptions ldp = MakePreset("ldp_published_groups").value();
  EXPECT_EQ(InteractionText(ldp.model), "ldp_published,ldp_network:512-512");
  std::string error;
  EXPECT_TRUE(ldp.IsValid(&error)) << error;
  // Another interaction takes the network of the preset away.
  const FitOptions changed =
      MakeFitOptions({{"preset", "ldp_published_groups"}, {"interaction", "contact"}}).value();
  EXPECT_FALSE(changed.model.learned->pair.any());
  EXPECT_EQ(LearnedName(*InitialNetwork({NetworkKind::kMlp, 4}, 1, {RodKind::kLdp, {3}}, {{4}})),
            "mlp:4 and rod ldp:3 and interaction network:4");
}

}  // namespace
}  // namespace pushid
