// A user's own force laws: in the table, in a fit, in files, and what is refused.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "ident/fit/fit.h"
#include "ident/model/model_json.h"
#include "ident/parameters/parameter_table.h"
#include "ident/parameters/presets.h"
#include "ident/prediction/prediction.h"
#include "residuals/autodiff_force_law.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

// Feet that brake with one force, whatever the speed: F = -M b tanh(v / 0.2 m/s).
struct Brake {
  template <typename T>
  Vector4<T> operator()(const LawPerson& person, const PendulumState<T>& s, const T* own) const {
    using std::tanh;
    const T brake = -person.body.mass * own[0];
    return {brake * tanh(s.qd[0] / 0.2), brake * tanh(s.qd[1] / 0.2), T(0.0), T(0.0)};
  }
};

std::shared_ptr<const ForceLaw> BrakeLaw(std::string_view parameter = "brake") {
  return MakeForceLaw("brake", {{parameter, "b", "m/s^2", 0.1, 0.0, 5.0, 0.1}}, Brake{});
}

// A law of so many parameters, which does nothing.
class Idle : public ForceLaw {
 public:
  Idle(const std::string& name, int parameters) : ForceLaw(name, Rows(parameters)) {}
  Vector4<double> Force(const LawPerson&, const Inputs&, Jacobian* jacobian) const override {
    if (jacobian != nullptr) jacobian->setZero();
    return Vector4<double>::Zero();
  }

 private:
  static std::vector<ParameterFacts> Rows(int count) {
    static constexpr std::string_view kNames[] = {"i0",  "i1",  "i2",  "i3", "i4",  "i5",
                                                  "i6",  "i7",  "i8",  "i9", "i10", "i11",
                                                  "i12", "i13", "i14", "i15"};
    std::vector<ParameterFacts> rows;
    for (int i = 0; i < count; ++i) rows.push_back({kNames[i], "i", "1", 1.0, 0.0, 2.0, 1.0});
    return rows;
  }
};

struct Given {
  ModelOptions model;
  ParameterTable table = MakePreset("tail").value().table;

  MaybeError Add(std::shared_ptr<const ForceLaw> law) {
    return AddForceLaw(std::move(law), &model, &table);
  }
};

TEST(OwnLaws, TakeTheSlotsInOrder) {
  Given given;
  ASSERT_FALSE(given.Add(std::make_shared<Idle>("idle", 2)));
  ASSERT_FALSE(given.Add(BrakeLaw()));
  const ParameterSpec* brake = given.table.Find("brake");
  ASSERT_NE(brake, nullptr);
  EXPECT_EQ(brake->id, kFirstOwnParameter + 2);
  EXPECT_EQ(&given.table[brake->id], brake);
  EXPECT_TRUE(brake->free);
  EXPECT_EQ(brake->nominal, 0.1);
  EXPECT_EQ(brake->unit, "m/s^2");
  EXPECT_EQ(LawNames(given.model), (std::vector<std::string>{"idle", "brake"}));
  EXPECT_TRUE(Acts(brake->id, given.model));
  EXPECT_FALSE(Acts(static_cast<Parameter>(brake->id + 1), given.model));
}

TEST(OwnLaws, RefusalsSayWhatToDoAndAddNothing) {
  Given given;
  ASSERT_FALSE(given.Add(BrakeLaw()));
  const auto refused = [&given](std::shared_ptr<const ForceLaw> law, const std::string& why) {
    const size_t rows = given.table.specs.size();
    const std::string error = ProblemOf(given.Add(std::move(law)));
    EXPECT_TRUE(Contains(error, why)) << error;
    EXPECT_EQ(given.table.specs.size(), rows);
    EXPECT_EQ(given.model.own_laws.size(), 1u);
  };
  refused(BrakeLaw("other"), "force law 'brake': the model has one of that name; rename it");
  refused(std::make_shared<Idle>("idle", kNumOwnParameters),
          "has 16 parameters; there is room for 15");
  refused(MakeForceLaw("again", {{"mu", "b", "1", 0.1, 0.0, 5.0, 0.1}}, Brake{}),
          "there is a parameter 'mu' already");
}

class FittedLaw : public TempDirTest {
 protected:
  static void SetUpTestSuite() {
    SyntheticOptions study = TinyStudy();
    study.joint_noise_m = 0.0;
    Given given;
    given.model = study.model;
    ASSERT_FALSE(given.Add(BrakeLaw()));
    study.model = given.model;
    brake_ = given.table.Find("brake")->id;
    study.parameters[brake_] = 0.35;
    FitOptions options = ExactFit(study);
    options.table = given.table;
    for (ParameterSpec& spec : options.table.specs) {
      spec.prior.reset();
      spec.tied_to.reset();
      if (!spec.free) spec.nominal = study.parameters[spec.id];
    }
    recordings_ = MakePendulums(study);
    model_.fit = Fit(recordings_, options);
  }
  static inline Parameter brake_{};
  static inline std::vector<PendulumRecording> recordings_;
  static inline FittedModel model_;
};

TEST(OwnLaws, RowsThatCannotBeFittedAreRefused) {
  const auto refused = [](const ParameterFacts& facts, const std::string& why) {
    Given given;
    const MaybeError error = given.Add(MakeForceLaw("brake", {facts}, Brake{}));
    EXPECT_TRUE(error && Contains(error->ToString(), why)) << why;
    EXPECT_TRUE(given.model.own_laws.empty());
  };
  refused({"drag", "d", "1/m", 0.1}, "must have a lower bound below its upper one");
  refused({"drag", "d", "1/m", 3.0, 0.0, 2.0}, "must start within its bounds");
  refused({"drag", "d", "1/m", 1.0, 0.0, 2.0, 0.0}, "must have a positive scale");
  refused({"drag", "d", "1/m", 1.0, 0.0, 2.0, 1.0, Transform::kLog}, "positive lower bound");
  refused({"drag", "d", "", 1.0, 0.0, 2.0}, "must have a name and a unit");
}

TEST_F(FittedLaw, RecoversWhatWasPlanted) {
  ASSERT_TRUE(model_.fit.ok());
  EXPECT_NEAR(model_.fit.parameters[brake_], 0.35, 1e-6);
  EXPECT_NEAR(model_.fit.parameters[kMu], PublishedTailParameters()[kMu], 1e-4);
  const Estimate* estimate = FindEstimate(model_.fit.estimates, "brake");
  ASSERT_NE(estimate, nullptr);
  EXPECT_EQ(estimate->value, model_.fit.parameters[brake_]);
  EXPECT_EQ(estimate->unit, "m/s^2");
  // The free modes know it.
  ModelOptions without = model_.fit.options.model;
  without.own_laws.clear();
  EXPECT_NE(ComputeBehaviour(without, model_.fit.parameters).fastest_growth,
            model_.fit.behaviour.fastest_growth);
}

TEST_F(FittedLaw, StandsInTheFileByNameAndIsAskedForThere) {
  const auto json = ToJson(model_, {});
  EXPECT_EQ(json.at("force_laws").dump(), "[\"brake\"]");
  EXPECT_EQ(ProblemOf(FittedModelFromJson(json, "model.json")),
            "model.json: the model was fitted with the force law 'brake', which is not part of "
            "pushid; read it with a program that has that law and gives it to ReadFittedModel");
  const FittedModel read = Unwrapped(FittedModelFromJson(json, "model.json", {BrakeLaw()}));
  EXPECT_EQ(read.fit.parameters[brake_], model_.fit.parameters[brake_]);
  EXPECT_EQ(ToJson(read, {}).dump(), json.dump());
}

TEST_F(FittedLaw, IsAColumnOfTheTrajectories) {
  const IdentifiedModel model = ModelOf(model_.fit);
  const Prediction prediction = Predict(model, recordings_[0]);
  ASSERT_TRUE(prediction.status.ok);
  ASSERT_FALSE(WriteTrajectoryCsv(Path("t.csv"), recordings_[0], prediction));
  const std::string text = ReadText(Path("t.csv"));
  EXPECT_TRUE(Contains(text.substr(0, text.find('\n')), ",network_phi_Nm,own_x_N,own_y_N"));
  double strongest = 0.0;
  for (int t = 0; t < prediction.path.num_frames(); ++t) {
    strongest = std::max(strongest, prediction.forces.At(t, 0)[ForcePart::kOwn].norm());
  }
  EXPECT_GT(strongest, 5.0);
}

}  // namespace
}  // namespace pushid
