// Presets, the flags that edit the table, option names.
#include "ident/parameters/parameter_table.h"

#include <gtest/gtest.h>

#include <set>

#include "datasets/files/names.h"
#include "ident/parameters/fit_options.h"
#include "ident/parameters/presets.h"
#include "ident/problem/folds.h"
#include "ident/uncertainty/uncertainty.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

ParameterTable Tail() { return MakePreset("tail").value().table; }

std::set<std::string> FreeNames(const ParameterTable& table) {
  std::set<std::string> names;
  for (Parameter id : table.Free()) names.insert(table[id].name);
  return names;
}

TEST(Presets, FreeWhatTheyPromise) {
  const FitOptions tail = MakePreset("tail").value(), ldp = MakePreset("ldp").value();
  EXPECT_EQ(FreeNames(tail.table),
            (std::set<std::string>{"mu", "Kp_theta", "Kd_theta", "a_x", "tail_gain", "tail_torque",
                                   "tail_time", "tail_base"}));
  EXPECT_EQ(tail.table[kTailExponent].nominal, 0.0);
  for (const ParameterSpec& spec : tail.table.specs) {
    EXPECT_EQ(spec.pooled, spec.id == kTailBase) << spec.name;
  }
  EXPECT_EQ(FreeNames(ldp.table),
            (std::set<std::string>{"mu", "Kp_theta", "Kp_phi", "Kd_theta", "Kd_phi"}));
  EXPECT_EQ(ldp.model.friction, FrictionKind::kIsotropic);
  EXPECT_EQ(ldp.model.gain_scaling, GainScaling::kNone);
  EXPECT_EQ(ldp.model.posture, Posture::kUpright);
  EXPECT_EQ(ldp.model.push_tail, PushTail::kNone);
  EXPECT_EQ(ldp.table[kKpX].nominal, 30.0);
  EXPECT_GT(tail.settling_weight, 0.0);
  EXPECT_TRUE(Contains(ProblemOf(MakePreset("tial")),
                       "--preset is 'tial'; it must be auto, tail, robot, ldp, "
                       "ldp_published, ldp_published_groups or group"));
}

// The numbers of the paper (Table 3) and the table of its supplement.
TEST(Presets, LdpAsPublished) {
  const FitOptions single = MakePreset("ldp_published").value();
  const FitOptions groups = MakePreset("ldp_published_groups").value();
  for (const FitOptions& o : {single, groups}) {
    EXPECT_EQ(FreeNames(o.table), std::set<std::string>{"mu"}) << o.preset;
    EXPECT_EQ(o.table[kMu].nominal, 100.0);
    EXPECT_EQ(o.table[kKpX].nominal, 30.0);
    EXPECT_EQ(o.table[kKpTheta].nominal, 1500.0);
    EXPECT_NEAR(60.0 * o.table[kKdTheta].nominal, 200.0, 1e-12) << "per frame";
    EXPECT_NEAR(60.0 * o.table[kKdX].nominal, 4.0, 1e-12);
    EXPECT_EQ(o.model.push, PushUse::kAdded);
    EXPECT_EQ(o.model.posture, Posture::kUpright);
    EXPECT_EQ(o.sigmas.loss, FrameLoss::kLdp);
    EXPECT_EQ(o.model.learned->rod_at(), 298244);
    EXPECT_FALSE(o.estimate_weights);
    EXPECT_EQ(o.effective_weight, 1.0);
    std::string error;
    EXPECT_TRUE(o.IsValid(&error)) << error;
  }
  EXPECT_FALSE(single.model.interaction.Any());
  EXPECT_EQ(groups.model.learned->pair.num_weights(), 270340);
  EXPECT_EQ(groups.table[kLeanTheta].nominal, 100.0);
  EXPECT_EQ(groups.table[kLeanPhi].nominal, 50.0);
  EXPECT_EQ(groups.table[kPotentialStrength].nominal, 150.0);
  EXPECT_EQ(groups.table[kPotentialLength].nominal, 0.5);
  EXPECT_EQ(groups.table[kNeighbourRange].nominal, 0.5);
  EXPECT_EQ(InteractionText(groups.model), "ldp_published,ldp_network:512-512");
  std::vector<PendulumRecording> recordings(2);
  recordings[0].hip.resize(1), recordings[1].hip.resize(1);
  EXPECT_EQ(PresetFor("ldp_published", recordings), "ldp_published");
  recordings[1].hip.resize(4);
  EXPECT_EQ(PresetFor("ldp_published", recordings), "ldp_published_groups");
}

TEST(Presets, EveryRowIsSound) {
  for (const char* name : {"tail", "ldp"}) {
    const ParameterTable table = MakePreset(name).value().table;
    ASSERT_EQ(table.specs.size(), static_cast<size_t>(kFirstOwnParameter));
    for (int i = 0; i < kFirstOwnParameter; ++i) {
      const ParameterSpec& spec = table.specs[i];
      EXPECT_EQ(spec.id, i);
      EXPECT_EQ(spec.name, kParameterNames[i]);
      EXPECT_EQ(table.Find(spec.name), &spec);
      EXPECT_LT(spec.lower, spec.upper) << spec.name;
      EXPECT_GE(spec.nominal, spec.lower) << spec.name;
      EXPECT_LE(spec.nominal, spec.upper) << spec.name;
      EXPECT_GT(spec.scale, 0.0) << spec.name;
      EXPECT_TRUE(spec.transform != Transform::kLog || spec.lower > 0.0) << spec.name;
      EXPECT_FALSE(spec.meaning.empty()) << spec.name;
      EXPECT_FALSE(spec.unit.empty()) << spec.name;
    }
    EXPECT_EQ(table.Find("nothing"), nullptr);
  }
}

TEST(Presets, LinearSelfForceComesWithPriors) {
  FitOptions options = MakePreset("tail").value();
  const ParameterTable& table = options.table;
  FreeTerms(&options);
  EXPECT_EQ(FreeNames(table), FreeNames(Tail()));
  options.self_force = SelfForceKind::kLinear;
  FreeTerms(&options);
  EXPECT_EQ(table[kAy].tied_to, kAx);  // alike in all directions
  options.model.directions = Directions::kAxes;
  FreeTerms(&options);
  for (Parameter id : {kAx, kAy, kBx, kBy, kTx, kTy, kCq, kDq}) {
    EXPECT_TRUE(table[id].free) << table[id].name;
    EXPECT_TRUE(table[id].prior.has_value()) << table[id].name;
  }
  EXPECT_EQ(table[kAx].prior->mean, -10.0);  // the preset's own stays
}

TEST(ParameterTable, MapHoldsTheFreeOnesInOrder) {
  ParameterTable table = Tail();
  table[kTailBase].pooled = false;
  table[kKpTheta].pooled = table[kTailTime].pooled = true;
  const ParameterMap map = table.Map();
  ASSERT_EQ(map.fitted.size(), 8u);
  EXPECT_EQ(map.num_deviations, 2);
  for (size_t i = 1; i < map.fitted.size(); ++i) {
    EXPECT_LT(map.fitted[i - 1].parameter, map.fitted[i].parameter);
  }
  for (const FittedParameter& f : map.fitted) {
    const int expected = f.parameter == kKpTheta ? 0 : f.parameter == kTailTime ? 1 : -1;
    EXPECT_EQ(f.deviation, expected) << kParameterNames[f.parameter];
  }
  EXPECT_EQ(map.values[kKpPhi], table[kKpTheta].nominal);  // tied to it
}

TEST(TableEdits, FixFreePriorSetPool) {
  ParameterTable table = Tail();
  TableEdits edits;
  table[kTailExponent].free = true;
  edits.fix = "tail_exponent=1.4,a_x";
  edits.free = "Kp_x=12,Kd_theta";
  edits.prior = "mu:80:15,Kp_x:0:50";
  edits.set = "Kp_phi=900";
  edits.pool = "mu,Kd_theta";
  ASSERT_EQ(ProblemOf(EditTable(edits, &table)), "no error");
  EXPECT_FALSE(table[kTailExponent].free);
  EXPECT_EQ(table[kTailExponent].nominal, 1.4);
  EXPECT_FALSE(table[kAx].free);
  EXPECT_EQ(table[kAx].nominal, -10.0);
  EXPECT_TRUE(table[kKpX].free);
  EXPECT_EQ(table[kKpX].nominal, 12.0);
  EXPECT_TRUE(table[kKdTheta].free);
  EXPECT_EQ(table[kMu].prior->mean, 80.0);
  EXPECT_EQ(table[kMu].prior->sigma, 15.0);
  EXPECT_EQ(table[kKpPhi].nominal, 900.0);
  EXPECT_FALSE(table[kKpPhi].free);
  EXPECT_TRUE(table[kMu].pooled);
  EXPECT_TRUE(table[kKdTheta].pooled);
  EXPECT_FALSE(table[kKpTheta].pooled);
}

TEST(TableEdits, PoolsAllButOne) {
  ParameterTable table = Tail();
  TableEdits edits;
  edits.pool = "all,-mu,-Kp_phi";  // Kp_phi is fixed: nothing to leave out
  ASSERT_FALSE(EditTable(edits, &table));
  for (const ParameterSpec& spec : table.specs) {
    EXPECT_EQ(spec.pooled, spec.free && spec.id != kMu) << spec.name;
  }
  edits.pool = "all,-nu";
  EXPECT_TRUE(Contains(ProblemOf(EditTable(edits, &table)), "--pool names 'nu'"));
}

TEST(TableEdits, AFixedGainMayBeZero) {
  ParameterTable table = Tail();
  EXPECT_FALSE(EditTable({"tail_gain=0", "", "", "", ""}, &table));
  EXPECT_EQ(table[kTailGain].nominal, 0.0);
  // On its log scale a free one may not.
  EXPECT_TRUE(EditTable({"", "tail_gain=0", "", "", ""}, &table));
}

TEST(TableEdits, BadInputIsNamed) {
  struct Case {
    TableEdits edits;
    const char* part;
  };
  for (const Case& c : {
           Case{{"nu", "", "", "", ""},
                "--fix names 'nu', which is not a parameter; there are mu,"},
           Case{{"", "Kp", "", "", ""}, "--free names 'Kp'"},
           Case{{"mu=fast", "", "", "", ""}, "--fix: 'mu=fast' has no number"},
           Case{{"mu=", "", "", "", ""}, "no number after '='"},
           Case{{"mu=nan", "", "", "", ""}, "no number"},
           Case{{"mu=1e9", "", "", "", ""}, "mu = 1e+09 lies outside its bounds [-2000, 2000]"},
           Case{{"", "Kp_theta=-3", "", "", ""}, "Kp_theta = -3 lies outside"},
           // A divisor is not zero, fixed or not.
           Case{{"support_back=0", "", "", "", ""}, "support_back = 0 lies outside"},
           Case{{"", "", "", "step_onset=0", ""}, "step_onset = 0 lies outside"},
           Case{{"", "", "mu:3", "", ""}, "--prior: 'mu:3' is not name:mean:sigma"},
           Case{{"", "", "mu:3:0", "", ""}, "sigma > 0"},
           Case{{"", "", "mu:3:x", "", ""}, "is not name:mean:sigma"},
           Case{{"", "", "nu:3:1", "", ""}, "--prior names 'nu'"},
           Case{{"", "", "Kp_theta:-5:1", "", ""}, "lies outside its bounds"},
           Case{{"", "", "", "mu", ""}, "--set: 'mu' needs a value"},
           Case{{"mu=3,mu=4", "", "", "", ""}, "--fix names mu twice"},
           Case{{"mu,Kp_x,mu", "", "", "", ""}, "--fix names mu twice"},
           Case{{"", "mu,mu=40", "", "", ""}, "--free names mu twice"},
           Case{{"", "", "mu:3:1,mu:4:1", "", ""}, "--prior names mu twice"},
           Case{{"", "", "", "mu=3,mu=3", ""}, "--set names mu twice"},
           Case{{"", "", "", "", "nu"}, "--pool names 'nu'"},
           Case{{"", "", "", "", "Kp_phi"}, "--pool names Kp_phi, which is fixed"},
       }) {
    ParameterTable table = Tail();
    EXPECT_TRUE(Contains(ProblemOf(EditTable(c.edits, &table)), c.part));
  }
}

TEST(Assignments, NamesAndValues) {
  const auto values = Unwrapped(ParseAssignments("mu=20,Kp_theta=1.5e3", "--set"));
  ASSERT_EQ(values.size(), 2u);
  EXPECT_EQ(values[1].name, "Kp_theta");
  EXPECT_EQ(values[1].value, 1500.0);
  EXPECT_TRUE(ParseAssignments("", "--set").value().empty());
  EXPECT_FALSE(ParseAssignments("mu", "--set").ok());
  EXPECT_FALSE(ParseAssignments("mu=2x", "--set").ok());
}

template <typename E>
void ExpectRoundTrip() {
  std::set<std::string> names;
  const auto& rows = Names(E{});
  for (const auto& row : rows) {
    E parsed{};
    EXPECT_FALSE(ParseName("--flag", row.name, &parsed));
    EXPECT_EQ(parsed, row.value) << row.name;
    EXPECT_EQ(NameOf(row.value), row.name);
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
  }
  const E last = std::prev(std::end(rows))->value;
  E untouched = last;
  EXPECT_TRUE(
      Contains(ProblemOf(ParseName("--flag", "no such name", &untouched)),
               std::string("--flag is 'no such name'; it must be ") + std::begin(rows)->name));
  EXPECT_EQ(untouched, last);
}

TEST(OptionNames, RoundTrip) {
  ExpectRoundTrip<Posture>();
  ExpectRoundTrip<GainScaling>();
  ExpectRoundTrip<FrictionKind>();
  ExpectRoundTrip<PushUse>();
  ExpectRoundTrip<PushTail>();
  ExpectRoundTrip<CartDerivative>();
  ExpectRoundTrip<SelfForceKind>();
  ExpectRoundTrip<FoldScheme>();
  ExpectRoundTrip<Transform>();
  ExpectRoundTrip<EstimateStatus>();
}

}  // namespace
}  // namespace pushid
