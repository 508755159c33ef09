// Faults that a verdict finds, and faults that it does not.
#include "ident/uncertainty/model_verdict.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "ident/fit/fit.h"
#include "ident/problem/fit_problem.h"
#include "ident/problem/statistics.h"
#include "ident/uncertainty/assumptions.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

SyntheticOptions Study(uint64_t seed) {
  SyntheticOptions study;
  study.subjects = 6;
  study.recordings_per_subject = 5;
  study.frames = 90;
  study.push_kind = PushKind::kExternal;
  study.joint_noise_m = 0.002;
  study.subject_spread = 0.1;
  study.seed = seed;
  return study;
}

FitResult FitOf(const std::vector<PendulumRecording>& recordings) {
  FitOptions options = MakePreset("tail").value();
  EXPECT_FALSE(PrepareFit(recordings, &options));
  FitResult result = Fit(recordings, options);
  EXPECT_TRUE(result.ok()) << result.message;
  return result;
}

const AssumptionTest* Find(const ModelVerdict& verdict, const std::string& name) {
  const auto found = std::find_if(verdict.assumptions.begin(), verdict.assumptions.end(),
                                  [&name](const AssumptionTest& t) { return t.name == name; });
  return found == verdict.assumptions.end() ? nullptr : &*found;
}

int Count(const FitResult& result, EstimateStatus status) {
  return static_cast<int>(
      std::count_if(result.estimates.begin(), result.estimates.end(),
                    [status](const Estimate& e) { return e.status == status; }));
}

// Derivatives of raw residuals give the gradient that the solver's Jacobian gives; the parts of
// recordings sum up to them.
void ExpectTheGradientOfTheCost(const SyntheticOptions& study, const char* preset,
                                double tolerance) {
  const auto recordings = MakePendulums(study);
  FitOptions options = MakePreset(preset).value();
  ASSERT_FALSE(PrepareFit(recordings, &options));
  const FitProblem problem(recordings, options);
  const FitPoint point = problem.NominalPoint();
  const ResidualRows by_horizon = EvaluateRows(problem, point, {}, {8, 16});
  const ResidualRows condensed = EvaluateRows(problem, point, true);
  const auto gradient = [](const ResidualRows& rows) {
    return Eigen::VectorXd(rows.jacobian.transpose() * rows.residuals);
  };
  const Eigen::VectorXd a = gradient(by_horizon), b = gradient(condensed);
  ASSERT_EQ(a.size(), b.size());
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a[i], b[i], tolerance * (tolerance + std::abs(b[i]))) << i;
  }
  Eigen::VectorXd score = Eigen::VectorXd::Zero(a.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(a.size(), a.size());
  for (const DataPart& part : by_horizon.parts) {
    score += part.score;
    information += part.information;
  }
  const auto is_data = [&](int row) { return by_horizon.cluster_of_row[row] >= 0; };
  Eigen::VectorXd of_data = by_horizon.residuals;
  for (int row = 0; row < of_data.size(); ++row) of_data[row] *= is_data(row);
  const Eigen::MatrixXd& robust = by_horizon.robust_jacobian;
  EXPECT_TRUE(score.isApprox(by_horizon.jacobian.transpose() * of_data, 1e-9));
  EXPECT_TRUE(information.isApprox(robust.transpose() * robust, 1e-9));
}

TEST(ModelVerdict, RowsByHorizonHaveTheGradientOfTheCost) {
  ExpectTheGradientOfTheCost(TinyStudy(), "tail", 1e-3);  // by differences
}

TEST(ModelVerdict, RowsOfPeopleWhoTouchHaveTheGradientOfTheCost) {
  SyntheticOptions study = TinyStudy();
  study.people_in_row = 2;
  ExpectTheGradientOfTheCost(study, "group", 1e-8);  // by sensitivities
}

TEST(ModelVerdict, PassesWhatTheModelMade) {
  int failed = 0;
  for (uint64_t seed = 1; seed <= 8; ++seed) {
    const FitResult result = FitOf(MakePendulums(Study(seed)));
    EXPECT_TRUE(result.verdict.checked()) << result.verdict.not_checked;
    failed += result.verdict.fails();
  }
  EXPECT_LE(failed, 1);
}

TEST(ModelVerdict, FindsPushesOfAnotherScale) {
  std::vector<PendulumRecording> recordings = MakePendulums(Study(3));
  for (PendulumRecording& r : recordings) r.scene = ScalePushes(r.scene, 1.5);
  const FitResult result = FitOf(recordings);
  EXPECT_TRUE(result.verdict.fails());
  EXPECT_EQ(Count(result, EstimateStatus::kIdentified), 0);
  const AssumptionTest* scale = Find(result.verdict, "scale of the pushes");
  ASSERT_NE(scale, nullptr);
  EXPECT_LT(scale->wanted, -0.1);
}

// The total error holds what is stated of pushes and held gains as well.
TEST(ModelVerdict, TotalErrorsAreLargerThanThoseOfTheDataAlone) {
  const FitResult result = FitOf(MakePendulums(Study(2)));
  for (const Estimate& e : result.estimates) {
    if (e.status == EstimateStatus::kFixed) continue;
    ASSERT_TRUE(e.total.has_value()) << e.name;
    EXPECT_GT(e.total->standard_error, 0.9 * e.standard_error) << e.name;
    EXPECT_LT(e.total->lower, e.value) << e.name;
    EXPECT_GT(e.total->upper, e.value) << e.name;
  }
  for (const Combination& c : result.derived) {
    ASSERT_TRUE(c.total.has_value()) << c.name;
    EXPECT_LE(c.interval().lower, c.lower95) << c.name;
    EXPECT_GE(c.interval().upper, c.upper95) << c.name;
  }
}

// People react late whether their feet hold or slide; of a robot nothing is stated.
TEST(ModelVerdict, AReactionDelayIsStatedOfFeetThatSlide) {
  const auto recordings = MakePendulums(TinyStudy());
  FitOptions options = MakePreset("tail").value();
  ASSERT_FALSE(PrepareFit(recordings, &options));
  const auto stated = [&](BodyModel body) {
    options.model.body = body;
    const FitProblem problem(recordings, options);
    double sigma = 0.0;
    for (const Assumption& a : AssumptionsOf(problem, problem.NominalPoint())) {
      if (a.name == kReactionDelayName) sigma = a.sigma;
    }
    return sigma;
  };
  EXPECT_EQ(stated(options.model.body), StatedErrors().reaction_delay_s);
  EXPECT_EQ(stated(BodyModel::kTable), 0.0);
}

// A laboratory that knows more of its pushes and clocks knows more of its people.
TEST(ModelVerdict, TotalErrorsFollowWhatIsStated) {
  std::vector<PendulumRecording> recordings = MakePendulums(Study(2));
  const FitResult plain = FitOf(recordings);
  for (PendulumRecording& r : recordings) {
    for (const StatedErrorRow& row : kStatedErrors) r.stated_errors.*row.value *= 1e-3;
  }
  const FitResult sure = FitOf(recordings);
  for (const char* name : {"mu", "Kp_theta"}) {
    EXPECT_LT(FindEstimate(sure.estimates, name)->total->standard_error,
              0.95 * FindEstimate(plain.estimates, name)->total->standard_error)
        << name;
  }
}

// The recordings' wish is the planted value, within the error that the test states.
void ExpectRecovered(const FitResult& result, const char* name, double planted) {
  const AssumptionTest* test = Find(result.verdict, name);
  ASSERT_NE(test, nullptr) << name;
  EXPECT_LE(std::abs(test->wanted - planted),
            StudentQuantile95(result.verdict.freedom) * test->error)
      << name << ": " << test->wanted << " +- " << test->error;
}

constexpr int kFiner = 64;

// Every 64th frame; a row of a push is the mean about its frame.
std::vector<PendulumRecording> Thinned(const std::vector<PendulumRecording>& recordings) {
  std::vector<PendulumRecording> thinned = recordings;
  for (PendulumRecording& r : thinned) {
    const PendulumRecording all = r;
    r.scene.dt *= kFiner;
    r.states[0].clear(), r.hip[0].clear(), r.rod_length[0].clear();
    for (int t = 0; t < all.num_frames(); t += kFiner) {
      r.hip[0].push_back(all.hip[0][t]);
      r.rod_length[0].push_back(all.rod_length[0][t]);
      r.states[0].push_back(all.states[0][t]);
      const Vector4<double> way = all.states[0][t].q - all.states[0][std::max(0, t - kFiner)].q;
      r.states[0].back().qd = way / r.scene.dt;
    }
    for (ScenePush& push : r.scene.pushes) {
      const int size = static_cast<int>(push.force.size()), half = kFiner / 2;
      std::vector<Vector4<double>> rows;
      for (int at = 0; at - half < size; at += kFiner) {
        rows.emplace_back(Vector4<double>::Zero());
        for (int k = std::max(0, at - half); k <= std::min(size - 1, at + half); ++k) {
          rows.back() += (std::abs(k - at) == half ? 0.5 : 1.0) / kFiner * push.force[k];
        }
      }
      push = MakeScenePush(push.person, push.start_frame / kFiner, push.kind, rows);
    }
  }
  return thinned;
}

// Rolled out in steps of a 64th, recordings ask for that step.
TEST(ModelVerdict, TheIntegratorIsAStatedError) {
  SyntheticOptions study = Study(2);
  study.fps *= kFiner;
  study.frames *= kFiner;
  study.joint_noise_m = 1e-4;
  study.subject_spread = 0.01;
  study.lean_sigma_rad = 0.0;
  const FitResult result = FitOf(Thinned(MakePendulums(study)));
  ExpectRecovered(result, kStepName, 1.0 / kFiner - 1.0);
  EXPECT_EQ(Find(result.verdict, kStepName)->stated, 1.0);
  const Estimate& mu = *FindEstimate(result.estimates, "mu");
  EXPECT_LT(mu.total->lower, study.parameters[kMu]);
  EXPECT_GT(mu.total->upper, study.parameters[kMu]);
}

// Half of a step has the impulse of the whole, and its rates are the means of both halves.
TEST(ModelVerdict, HalfStepsEndWhereWholeOnesDo) {
  SyntheticOptions study = TinyStudy();
  study.push_kind = PushKind::kExternal;
  const auto recordings = MakePendulums(study);
  FitOptions options = MakePreset("tail").value();
  ASSERT_FALSE(PrepareFit(recordings, &options));
  const FitProblem problem(recordings, options);
  for (const Assumption& a : AssumptionsOf(problem, problem.NominalPoint())) {
    if (!a.halves_steps) continue;
    for (PendulumRecording halved : recordings) {
      const PendulumRecording whole = halved;
      a.of_recording(a.step, &halved);
      EXPECT_EQ(halved.num_frames(), 2 * whole.num_frames() - 1);
      EXPECT_EQ(halved.hip[0][2], whole.hip[0][1]);
      EXPECT_EQ(halved.hip[0][1], whole.hip[0][1]);
      const ScenePush &a_push = halved.scene.pushes[0], &b_push = whole.scene.pushes[0];
      EXPECT_LT((a_push.mean - b_push.mean).norm(), 1e-9 * b_push.mean.norm());
      EXPECT_EQ(a_push.EndFrame(), 2 * b_push.EndFrame());
    }
  }
}

// A second push, or more of the mass in the feet, is named; a drag that grows with speed
// is the term c_q. One Newton step tells how much, where it is little.
TEST(ModelVerdict, NamesSecondPushesCartSharesAndQuadraticDrag) {
  SyntheticOptions study = Study(3);
  study.subject_spread = 0.02;
  study.joint_noise_m = 5e-4;
  std::vector<PendulumRecording> recordings = MakePendulums(study);
  for (PendulumRecording& r : recordings) {  // by so much less than the scene says
    r.scene.pushes.push_back(ScalePushes(r.scene, 0.05).pushes[0]);
    r.scene.pushes.back().start_frame = r.scene.pushes[0].EndFrame() + 18;
  }
  const FitResult pushed = FitOf(recordings);
  ExpectRecovered(pushed, "second pushes", -0.05);
  EXPECT_LT(Find(pushed.verdict, "second pushes")->t, -3.0);

  recordings = MakePendulums(study);
  for (PendulumRecording& r : recordings) r.scene.people[0].body.point_share = 0.7;
  const FitResult loaded = FitOf(recordings);
  const AssumptionTest* share = Find(loaded.verdict, "share of the masses in the carts");
  ASSERT_NE(share, nullptr);
  EXPECT_LT(share->wanted, 0.0);
  EXPECT_LT(share->p, 0.05);

  study.parameters[kCq] = 0.1;
  const FitResult dragged = FitOf(MakePendulums(study));
  ExpectRecovered(dragged, "c_q", 0.1);
  EXPECT_LT(Find(dragged.verdict, "c_q")->p, 0.05);
}

// Much noise on little motion: what is measured of rates is noise, and asks for nothing.
TEST(ModelVerdict, NoiseAsksForNoOtherFrameRate) {
  SyntheticOptions study = Study(1);
  study.joint_noise_m = 0.01;
  study.subject_spread = 0.02;
  study.strengths = {{"weak", 0.4}};
  const ModelVerdict verdict = FitOf(MakePendulums(study)).verdict;
  const AssumptionTest* rate = Find(verdict, "frame rate");
  ASSERT_NE(rate, nullptr);
  EXPECT_LT(std::abs(rate->wanted), 0.15);  // where rates are scaled with their noise: -0.5
}

TEST(ModelVerdict, TurnsOfAPath) {
  EXPECT_TRUE(TurnsOf({}, 0.1).empty());
  EXPECT_TRUE(TurnsOf({0.0, 1.0, 0.95, 2.0, 1.95}, 0.1).empty()) << "too little";
  EXPECT_EQ(TurnsOf({0.0, 1.0, 3.0, 2.0, 1.0, 4.0, 4.05, 4.0}, 0.1), (std::vector<int>{2, 4}));
  EXPECT_TRUE(TurnsOf({0.0, -1.0, -2.0}, 0.1).empty()) << "a start is no turn";
}

// Feet that end elsewhere, hips that turn at another time and as often.
TEST(ModelVerdict, MotionByHand) {
  SyntheticOptions study = Study(2);
  study.subject_spread = 0.03;
  const FitResult result = FitOf(MakePendulums(study));
  const MotionComparison& motion = result.verdict.motion;
  EXPECT_GT(motion.explained, 0.9);
  ASSERT_FALSE(motion.tests.empty());
  EXPECT_EQ(motion.tests[0].quantity, "travel of the feet");
  EXPECT_LT(std::abs(motion.tests[0].difference), 0.02);

  std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions options = MakePreset("tail").value();
  ASSERT_FALSE(PrepareFit(recordings, &options));
  const auto compare = [&] {
    const FitProblem problem(recordings, options);
    const Clusters clusters = MakeClusters(recordings, ClusterBy::kSubject);
    return CompareMotion(problem, problem.NominalPoint(), clusters).tests;
  };
  const std::vector<MotionTest> before = compare();
  for (PendulumRecording& r : recordings) {  // 12 cm farther along the push, evenly
    const Eigen::Vector2d along = 0.12 * PushDirection(r);
    const double frames = r.num_frames() - 1;
    for (int t = 0; t < r.num_frames(); ++t) {
      r.states[0][t].q.head<2>() += t / frames * along;
      if (t > 0) r.states[0][t].qd.head<2>() += along / (frames * r.scene.dt);
    }
  }
  EXPECT_NEAR(compare()[0].difference - before[0].difference, 0.12, 1e-6);
  for (PendulumRecording& r : recordings) {  // everybody turns once there and once back, 6 cm
    const Eigen::Vector2d along = PushDirection(r);
    for (int t = 0; t < r.num_frames(); ++t) {
      const double back = 60 <= t && t < 75 ? 0.5 * std::min(t - 60, 75 - t) / 7.5 : 0.0;
      r.hip[0][t].head<2>() -= back * along;
    }
  }
  const std::vector<MotionTest> turned = compare();
  const auto turns = std::find_if(turned.begin(), turned.end(), [](const MotionTest& test) {
    return test.quantity == "number of turns of the hip";
  });
  ASSERT_NE(turns, turned.end()) << "alike in all, and tested";
  EXPECT_GT(turns->difference, 0.9);
  EXPECT_LT(turns->p, 1e-3);
}

// Where people hardly move, the markers' noise at the first frame is in all of a path.
TEST(ModelVerdict, NoiseOfTheFirstFrameIsNotUnexplained) {
  SyntheticOptions study = Study(1);
  study.joint_noise_m = 0.02;
  study.strengths = {{"weak", 0.15}};
  EXPECT_GT(FitOf(MakePendulums(study)).verdict.motion.explained, kLeastExplained);
}

// Stiffer to the side than forwards, fitted as one: pushes from the side say so.
TEST(ModelVerdict, PushesFromTheSideAskForAnotherGain) {
  SyntheticOptions study = Study(4);
  study.direction_sigma_rad = 1.2;
  study.subject_spread = 0.02;
  study.parameters[kKpPhi] = 2.5 * study.parameters[kKpTheta];
  const FitResult result = FitOf(MakePendulums(study));
  const auto from_the_side = [](const PartTest& test) { return test.part == kFromTheSide; };
  const std::vector<PartTest>& parts = result.verdict.parts;
  EXPECT_TRUE(std::any_of(parts.begin(), parts.end(), from_the_side));
  EXPECT_TRUE(result.verdict.fails());
  const auto surest = std::min_element(parts.begin(), parts.end(),
                                       [](const auto& a, const auto& b) { return a.p < b.p; });
  EXPECT_TRUE(from_the_side(*surest)) << surest->part;
}

TEST(ModelVerdict, SaysWhyNothingWasChecked) {
  SyntheticOptions study = TinyStudy();
  const FitResult result = FitOf(MakePendulums(study));  // two people
  EXPECT_FALSE(result.verdict.checked());
  EXPECT_TRUE(Contains(result.verdict.not_checked, "2 people cannot tell"));
}

// The numbers of a person who is driven, or who settled only on demand, are not called identified.
TEST(ModelVerdict, IdentifiesNothingOfWhoDoesNotComeToRest) {
  const auto recordings = MakePendulums(Study(1));
  const FitResult result = FitOf(recordings);
  ASSERT_GT(Count(result, EstimateStatus::kIdentified), 0);
  EXPECT_EQ(result.verdict.none_identified, "");
  const FitProblem problem(recordings, result.options);
  const FitPoint& optimum = result.starts[result.best_start].to;
  const auto identified = [](const Uncertainty& u) {
    return std::count_if(u.estimates.begin(), u.estimates.end(),
                         [](const Estimate& e) { return e.status == EstimateStatus::kIdentified; });
  };
  Uncertainty u = result.uncertainty;
  Behaviour driven = result.behaviour;
  driven.settles = false;
  driven.self_propelling = true;
  EXPECT_NE(JudgeModel(problem, optimum, driven, &u).none_identified, "");
  EXPECT_EQ(identified(u), 0);
  u = result.uncertainty;
  u.settling.binds = u.settling.contradicted = true;
  EXPECT_NE(JudgeModel(problem, optimum, result.behaviour, &u).none_identified, "");
  EXPECT_EQ(identified(u), 0);
}

}  // namespace
}  // namespace pushid
