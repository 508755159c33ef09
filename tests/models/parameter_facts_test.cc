// The rows of parameters, and the parts of the net force.
#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>

#include "models/learned_terms.h"
#include "models/options.h"
#include "models/parameters.h"
#include "models/self_terms.h"

namespace pushid {
namespace {

// One row by hand, column by column.
TEST(ParameterFacts, TheFirstRow) {
  const ParameterFacts& mu = kParameterRows[kMu].facts;
  EXPECT_EQ(mu.name, "mu");
  EXPECT_EQ(mu.symbol, "mu");
  EXPECT_EQ(mu.unit, "N s/m");
  EXPECT_EQ(mu.nominal, 100.0);
  EXPECT_EQ(mu.lower, -2000.0);
  EXPECT_EQ(mu.upper, 2000.0);
  EXPECT_EQ(mu.scale, 100.0);
  EXPECT_EQ(mu.transform, Transform::kIdentity);
  EXPECT_EQ(mu.meaning, "drag of the stepping feet (not floor friction)");
  EXPECT_FALSE(mu.when_to_free.empty());
  EXPECT_EQ(kParameterNames[kContactHeight], "contact_height");
  EXPECT_EQ(kParameterRows[kContactHeight].facts.transform, Transform::kIdentity);
}

TEST(ParameterFacts, EveryRowIsSound) {
  std::set<std::string_view> names;
  for (int i = 0; i < kFirstOwnParameter; ++i) {
    const ParameterFacts& facts = kParameterRows[i].facts;
    EXPECT_EQ(facts.name, kParameterNames[i]);
    EXPECT_TRUE(names.insert(facts.name).second) << facts.name << " stands twice";
    EXPECT_EQ(Violation(facts), "") << facts.name;
    for (std::string_view text : {facts.symbol, facts.unit, facts.meaning, facts.when_to_free}) {
      EXPECT_FALSE(text.empty()) << facts.name;
    }
  }
}

// What one option switches on is what acts, and no more.
std::set<std::string_view> ActingOnlyWith(const ModelOptions& with, const ModelOptions& without) {
  std::set<std::string_view> names;
  for (int i = 0; i < kFirstOwnParameter; ++i) {
    const auto id = static_cast<Parameter>(i);
    if (Acts(id, with) && !Acts(id, without)) names.insert(kParameterNames[i]);
    EXPECT_TRUE(Acts(id, with) || !FreedByItsTerm(id, with)) << kParameterNames[i];
  }
  return names;
}

TEST(ParameterFacts, ActWhereTheirTermsAre) {
  using Names = std::set<std::string_view>;
  ModelOptions none;
  none.push_tail = PushTail::kNone;
  const auto adds = [&none](auto change) {
    ModelOptions with = none;
    change(&with);
    return ActingOnlyWith(with, none);
  };
  EXPECT_EQ(adds([](ModelOptions* m) { m->friction = FrictionKind::kAnisotropic; }), Names{"mu_y"});
  EXPECT_EQ(adds([](ModelOptions* m) { m->cart_derivative = CartDerivative::kBackward; }),
            (Names{"Kd_x", "Kd_y"}));
  EXPECT_EQ(adds([](ModelOptions* m) { m->push_tail = PushTail::kExponential; }),
            (Names{"tail_gain", "tail_torque", "tail_time", "tail_exponent", "tail_base"}));
  EXPECT_EQ(adds([](ModelOptions* m) { m->interaction.spring = true; }),
            (Names{"contact_stiffness", "contact_distance", "contact_kappa", "contact_height"}));
  EXPECT_EQ(adds([](ModelOptions* m) { m->interaction.damping = true; }),
            (Names{"contact_damping", "contact_distance", "contact_kappa", "contact_height"}));
  EXPECT_EQ(adds([](ModelOptions* m) { m->interaction.ldp_published = true; }),
            (Names{"potential_strength", "potential_length", "neighbour_range", "lean_theta",
                   "lean_phi"}));
  EXPECT_FALSE(Acts(static_cast<Parameter>(kFirstOwnParameter), none));
}

TEST(CartDampings, AreMuPlusKp) {
  ParameterSet<double> p{};
  p[kMu] = 40.0, p[kMuY] = 90.0, p[kKpX] = 1.0, p[kKpY] = 2.0;
  const auto same = CartDampings(FrictionKind::kIsotropic);
  EXPECT_EQ(same[0].name, "c_x");
  EXPECT_EQ(same[1].name, "c_y");
  EXPECT_EQ(same[0].Of(p), 41.0);
  EXPECT_EQ(same[1].Of(p), 42.0);
  const auto each = CartDampings(FrictionKind::kAnisotropic);
  EXPECT_EQ(each[0].Of(p), 41.0);
  EXPECT_EQ(each[1].Of(p), 92.0);
  for (const CartDamping& c : each) {
    EXPECT_TRUE(HeldByConvention(c.gain));
    EXPECT_FALSE(HeldByConvention(c.friction));
  }
}

// A switch says where its term acts: at points of contact or at carts, and not at both.
TEST(InteractionTerms, EverySwitchActsSomewhere) {
  for (const InteractionTermName& term : kInteractionTerms) {
    InteractionTerms terms;
    terms.*term.member = true;
    EXPECT_TRUE(terms.Any()) << term.name;
    EXPECT_NE(terms.Contact(), terms.AtCarts()) << term.name;
  }
  EXPECT_FALSE(InteractionTerms().Any());
}

TEST(ForceParts, HaveNamesOfTheirOwnAndOwnIsTheLast) {
  std::set<std::string_view> names;
  for (const auto& part : kForceParts) names.insert(part.name);
  EXPECT_EQ(names.size(), static_cast<size_t>(kNumForceParts));
  EXPECT_EQ(NameOf(ForcePart::kInteraction), "interaction");
  EXPECT_EQ(kForceParts[kNumForceParts - 2].value, ForcePart::kOwn);
  EXPECT_EQ(kForceParts.back().value, ForcePart::kInertia);
}

}  // namespace
}  // namespace pushid
