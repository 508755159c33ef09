// From Ceres' blocks to each person's parameters, and back to columns.
#include "residuals/parameter_map.h"

#include <ceres/jet.h>

#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

constexpr Transform kTransforms[] = {Transform::kIdentity, Transform::kLog, Transform::kLogit};

TEST(Transform, FittedAndNaturalAreInverse) {
  for (Transform transform : kTransforms) {
    for (double natural : {1e-6, 0.03, 0.5, 0.97}) {
      EXPECT_NEAR(ToNatural(transform, ToFitted(transform, natural)), natural, 1e-14);
    }
  }
  EXPECT_NEAR(ToNatural(Transform::kLog, ToFitted(Transform::kLog, 1560.0)), 1560.0, 1e-10);
  EXPECT_EQ(ToNatural(Transform::kIdentity, -3.5), -3.5);
}

TEST(Transform, StaysInItsRangeFarOut) {
  EXPECT_EQ(ToNatural(Transform::kLogit, 800.0), 1.0);
  EXPECT_EQ(ToNatural(Transform::kLogit, -800.0), 0.0);
  EXPECT_EQ(ToNatural(Transform::kLog, -800.0), 0.0);
}

TEST(Transform, SlopeIsTheDerivative) {
  using Jet = ceres::Jet<double, 1>;
  for (Transform transform : kTransforms) {
    for (double fitted : {-8.0, -1.3, 0.0, 0.4, 7.0}) {
      const Jet natural = ToNatural(transform, Jet(fitted, 0));
      // Near 1 a logit's natural value holds few digits of 1 - natural.
      EXPECT_NEAR(TransformSlope(transform, natural.a), natural.v[0], 1e-12 * natural.v[0])
          << static_cast<int>(transform) << " at " << fitted;
    }
  }
}

TEST(ParameterMap, HoldsWhatIsNotFitted) {
  ParameterMap map;
  for (int i = 0; i < kNumParameters; ++i) map.values[i] = 100.0 + i;
  map.fitted = {{kKpTheta, Transform::kLog, 0}, {kAx, Transform::kIdentity, -1}};
  map.num_deviations = 1;
  const double shared[] = {std::log(1500.0), -9.0}, deviation[] = {std::log(1.2)};
  const ParameterSet<double> set = map.Apply(shared, deviation);
  for (int i = 0; i < kNumParameters; ++i) {
    if (i != kKpTheta && i != kAx) {
      EXPECT_EQ(set[i], 100.0 + i) << kParameterNames[i];
    }
  }
  EXPECT_NEAR(set[kKpTheta], 1800.0, 1e-9);  // a deviation of a log is a factor
  EXPECT_EQ(set[kAx], -9.0);                 // not pooled
  EXPECT_NEAR(map.Apply<double>(shared, nullptr)[kKpTheta], 1500.0, 1e-9);
}

TEST(ParameterMap, EntriesAreTheDerivativesByColumn) {
  Random random(11);
  const ParameterMap map = EveryParameterMap({kMu, kKpTheta, kAx, kTailTorque});
  constexpr int kColumns = kNumParameters + 4;
  using Jet = ceres::Jet<double, kColumns>;
  const auto values = SharedBlock(map, RandomRecoveringParameters(&random, 0.5));
  std::vector<Jet> shared, deviation;
  for (int i = 0; i < kNumParameters; ++i) shared.emplace_back(values[i], i);
  for (int i = 0; i < 4; ++i) deviation.emplace_back(random.Uniform(-1, 1), kNumParameters + i);
  const ParameterSet<Jet> jets = map.Apply(shared.data(), deviation.data());
  ParameterSet<double> set;
  for (int i = 0; i < kNumParameters; ++i) set[i] = jets[i].a;

  Eigen::Matrix<double, kNumParameters, kColumns> by_column;
  by_column.setZero();
  for (const ColumnEntry& entry : map.Entries(set)) {
    by_column(entry.parameter, entry.column) += entry.derivative;
    const int own = map.fitted[entry.column].deviation;
    if (own >= 0) by_column(entry.parameter, kNumParameters + own) += entry.derivative;
  }
  for (int i = 0; i < kNumParameters; ++i) {
    for (int c = 0; c < kColumns; ++c) {
      EXPECT_NEAR(by_column(i, c), jets[i].v[c], 1e-13 * std::max(1.0, std::abs(jets[i].v[c])))
          << kParameterNames[i] << ", column " << c;
    }
  }
  EXPECT_EQ(map.Entries(set).size(), static_cast<size_t>(kNumParameters));
}

TEST(BlockLayout, PeopleOfTheSameSubjectShareABlock) {
  const ParameterMap map = EveryParameterMap({kMu, kKpTheta, kAx});
  const BlockLayout layout(map, {"anna", "bert", "anna", "carl"}, true);
  EXPECT_EQ(layout.BlockSizes(), (std::vector<int>{kNumParameters, 3, 3, 3, 16}));
  EXPECT_EQ(layout.num_blocks(), 5);
  EXPECT_EQ(layout.num_columns(), kNumParameters + 9 + 16);
  EXPECT_EQ(layout.units, (std::vector<std::string>{"anna", "bert", "carl"}));
  // Three columns instead of one for each parameter that the three subjects differ in.
  EXPECT_EQ(layout.VelocityColumn(), kNumParameters + 6);
  EXPECT_EQ(layout.num_acting(), kNumParameters + 6 + 16);

  Random random(3);
  const ParameterBlocks blocks =
      RandomBlocks(map, layout, RecoveringParameters(), 0.3, 0.2, &random);
  std::vector<const double*> pointers;
  for (const auto& block : blocks) pointers.push_back(block.data());
  const auto sets = layout.Parameters<double>(map, pointers.data());
  ASSERT_EQ(sets.size(), 4u);
  EXPECT_EQ(sets[0], sets[2]);
  EXPECT_NE(sets[0][kMu], sets[1][kMu]);
  EXPECT_EQ(sets[0][kKdTheta], sets[3][kKdTheta]);
  EXPECT_EQ(sets[1], map.Apply(blocks[0].data(), blocks[2].data()));
  EXPECT_EQ(layout.VelocityBlock(pointers.data()), blocks[4].data());
}

// By hand: of a, b and c, units x and y differ in b. Acting are a, b of x, b of y and c.
TEST(BlockLayout, ASharedColumnIsTheSumOfItsUnits) {
  ParameterMap map;
  map.fitted = {{kMu, Transform::kIdentity, -1},
                {kAx, Transform::kIdentity, 0},
                {kBx, Transform::kIdentity, -1}};
  map.num_deviations = 1;
  const BlockLayout layout(map, {"x", "y", "x"}, false);
  using Range = std::pair<int, int>;
  EXPECT_EQ(layout.num_acting(), 4);
  EXPECT_EQ(layout.ActingOfColumns(), (std::vector<Range>{{0, 0}, {1, 2}, {3, 3}, {1, 1}, {2, 2}}));
  const auto columns = [&](int person) {
    std::vector<int> of;
    for (const ColumnEntry& entry : layout.Entries(map, {}, person)) of.push_back(entry.column);
    return of;
  };
  EXPECT_EQ(columns(0), (std::vector<int>{0, 1, 3}));
  EXPECT_EQ(columns(1), (std::vector<int>{0, 2, 3}));
}

TEST(BlockLayout, BlocksThatAreNotThereHaveNoColumn) {
  const ParameterMap plain = EveryParameterMap({});
  const BlockLayout shared(plain, {"anna", "bert"}, false);
  EXPECT_EQ(shared.BlockSizes(), (std::vector<int>{kNumParameters}));
  EXPECT_EQ(shared.num_blocks(), 1);
  EXPECT_EQ(shared.num_acting(), kNumParameters);
  EXPECT_LT(shared.VelocityColumn(), 0);
  const double* block = nullptr;
  EXPECT_EQ(shared.VelocityBlock(&block), nullptr);

  const BlockLayout velocities(plain, {"anna", "bert"}, true);
  EXPECT_EQ(velocities.BlockSizes(), (std::vector<int>{kNumParameters, 8}));
  EXPECT_EQ(velocities.VelocityColumn(), kNumParameters);

  const BlockLayout pooled(EveryParameterMap({kMu}), {"anna"}, false);
  EXPECT_EQ(pooled.BlockSizes(), (std::vector<int>{kNumParameters, 1}));
  EXPECT_EQ(pooled.num_acting(),
            kNumParameters);  // one person's deviation moves as the shared value
}

}  // namespace
}  // namespace pushid
