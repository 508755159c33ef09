// Learned self forces and rods by name, by seed and by file.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "ident/parameters/fit_options.h"
#include "ident/parameters/option_table.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

TEST(SelfNetworkIo, NamesAreReadAndWritten) {
  for (const char* text : {"none", "linear", "mlp:4", "ldp:256:32", "linear,mlp:4"}) {
    const auto choice = ParseSelfForce("--self_force", text);
    ASSERT_TRUE(choice.ok()) << text;
    const LearnedTerms network{choice.value().network, {}};
    EXPECT_EQ(SelfForceText(choice.value().kind, choice.value().network.any() ? &network : nullptr),
              text);
  }
  EXPECT_EQ(ParseSelfForce("f", "mlp").value().network.hidden, 4);
  EXPECT_EQ(ParseSelfForce("f", "ldp:8").value().network.embedding, 32) << "it takes the mass";
  EXPECT_EQ(NetworkName(ParseSelfForce("f", "ldp").value().network), "ldp:256:32");
  EXPECT_EQ(ParseSelfForce("f", "mlp:4,none,linear,linear").value().kind, SelfForceKind::kLinear);
  for (const char* text : {"rnn", "mlp:", "mlp:0", "mlp:x", "mlp:4:2", "ldp:4:0", "mlp:99999",
                           "mlp:4,ldp:4", "ldp:4:2:1", "mlp:-1", "gru:4"}) {
    EXPECT_TRUE(Contains(ProblemOf(ParseSelfForce("--self_force", text)), "--self_force"));
  }
}

TEST(SelfNetworkIo, HelpAndMessageNameEveryKind) {
  EXPECT_EQ(FindFitOption("self_force")->help,
            "additional self force: none, linear (cross terms, quadratic), a network by kind and "
            "hidden size (mlp:4, or LDP's ldp:256:32 with its embedding), or linear and a network, "
            "comma-separated");
  EXPECT_EQ(ParseSelfForce("f", "rnn").error().ToString(),
            "f is 'rnn'; it must be none, linear, mlp:4 or ldp:256:32 (hidden size, of ldp an "
            "embedding; 1 to 4096), or linear and a network, as linear,mlp:4");
}

TEST(SelfNetworkIo, StartsWithoutForceAndFromItsSeed) {
  const NetworkShape shape{NetworkKind::kLdp, 3, 2};
  const std::vector<double> weights = InitialWeights(shape, 5);
  ASSERT_EQ(static_cast<int>(weights.size()), shape.num_weights());
  for (int i = shape.output_at(); i < shape.num_weights(); ++i) EXPECT_EQ(weights[i], 0.0);
  EXPECT_EQ(weights, InitialWeights(shape, 5));
  EXPECT_NE(weights, InitialWeights(shape, 6));
}

TEST(SelfNetworkIo, RodsAreReadAndWritten) {
  for (const char* text : {"constant", "ldp:4", "ldp:256-128-256"}) {
    const auto shape = ParseRod("--rod", text);
    ASSERT_TRUE(shape.ok()) << text;
    EXPECT_EQ(RodName(shape.value()), text);
  }
  EXPECT_EQ(RodName(ParseRod("f", "ldp").value()), "ldp:128-128");
  for (const char* text : {"", "none", "linear", "mlp:4", "constant:1", "ldp:", "ldp:0", "ldp:4-",
                           "ldp:-4", "ldp:4--4", "ldp:4:4", "ldp:99999", "ldp:1-1-1-1-1-1-1-1-1"}) {
    EXPECT_TRUE(Contains(ProblemOf(ParseRod("--rod", text)), "--rod is '" + std::string(text)));
  }
}

TEST(SelfNetworkIo, RodsStartConstantAndBesideTheSelfForce) {
  const NetworkShape shape{NetworkKind::kMlp, 2};
  const RodShape rod{RodKind::kLdp, {3, 2}};
  const auto both = InitialNetwork(shape, 5, rod);
  const std::vector<double> self = InitialWeights(shape, 5);
  ASSERT_EQ(static_cast<int>(both->weights.size()), shape.num_weights() + rod.num_weights());
  EXPECT_TRUE(std::equal(self.begin(), self.end(), both->weights.begin()));
  for (size_t i = both->weights.size() - 2; i < both->weights.size(); ++i) {
    EXPECT_EQ(both->weights[i], 0.0);
  }
  EXPECT_NE(both->weights[both->rod_at()], 0.0);
  EXPECT_NE(both->weights[both->rod_at()], self[0]);
  EXPECT_EQ(LearnedName(*both), "mlp:2 and rod ldp:3-2");
  EXPECT_EQ(LearnedName(*InitialNetwork({}, 5, rod)), "rod ldp:3-2");
}

TEST(SelfNetworkIo, FilesKeepEverything) {
  const RodShape rod{RodKind::kLdp, {3, 2}};
  for (const LearnedTerms& network :
       {*InitialNetwork({NetworkKind::kMlp, 3}, 1, rod), *InitialNetwork({}, 3, rod),
        *InitialNetwork({NetworkKind::kMlp, 2}, 4),
        *InitialNetwork({NetworkKind::kLdp, 2, 3}, 5, {RodKind::kLdp, {3}}, {{4}, true})}) {
    const auto read = LearnedFromJson(nlohmann::ordered_json::parse(ToJson(network).dump()));
    EXPECT_EQ(LearnedName(*read), LearnedName(network));
    EXPECT_EQ(read->weights, network.weights);
  }
}

TEST(SelfNetworkIo, DamageIsNamed) {
  const nlohmann::ordered_json good = ToJson(*InitialNetwork({NetworkKind::kMlp, 2}, 1));
  EXPECT_NO_THROW(LearnedFromJson(good));
  const auto broken = [&](const char* key, const nlohmann::ordered_json& value) {
    nlohmann::ordered_json json = good;
    json[key] = value;
    return json;
  };
  EXPECT_THROW(LearnedFromJson(broken("kind", "rnn")), std::runtime_error);
  EXPECT_THROW(LearnedFromJson(broken("hidden", 0)), std::runtime_error);
  EXPECT_THROW(LearnedFromJson(broken("hidden", 3)), std::runtime_error);
  EXPECT_THROW(LearnedFromJson(broken("hidden", 2.7)), std::runtime_error);
  EXPECT_THROW(LearnedFromJson(broken("weights", {1.0})), std::runtime_error);
  EXPECT_THROW(LearnedFromJson(broken("kind", "none")), std::runtime_error);
  using Rod = nlohmann::ordered_json;
  for (const Rod& rod :
       {Rod{{"kind", "linear"}, {"hidden", Rod::array()}},
        Rod{{"kind", "ldp"}, {"hidden", Rod::array()}}, Rod{{"kind", "constant"}, {"hidden", {2}}},
        Rod{{"kind", "ldp"}, {"hidden", {0}}}, Rod{{"kind", "mlp"}, {"hidden", {2}}},
        Rod{{"kind", "ldp"}}}) {
    EXPECT_ANY_THROW(LearnedFromJson(broken("rod", rod))) << rod;
  }
}

}  // namespace
}  // namespace pushid
