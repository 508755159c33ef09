// The bootstrap draws whole recordings and repeats itself.
#include "ident/uncertainty/bootstrap.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "ident/checks/model_checks.h"
#include "ident/fit/fit.h"
#include "ident/problem/fit_problem.h"
#include "ident/problem/statistics.h"
#include "ident/report/report_text.h"
#include "ident/solver/solver.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

TEST(Bootstrap, DrawsAsManyAsThereAre) {
  const ResamplingUnits eight = {
      ClusterBy::kRecording, false, {{0}, {1}, {2}, {3}, {4}, {5}, {6}, {7}}};
  std::vector<double> mean(8, 0.0);
  for (int k = 0; k < 2000; ++k) {
    const std::vector<int> counts = DrawRecordings(eight, 5, k);
    EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0), 8);
    for (int i = 0; i < 8; ++i) mean[i] += counts[i] / 2000.0;
  }
  for (double m : mean) EXPECT_NEAR(m, 1.0, 0.1);
  EXPECT_NE(DrawRecordings(eight, 5, 0), DrawRecordings(eight, 5, 1));
  EXPECT_NE(DrawRecordings(eight, 5, 0), DrawRecordings(eight, 6, 0));
}

// Three recordings of each of two people, and what (2n - 1 choose n) makes of it.
TEST(Bootstrap, RecordingsOfAPersonAreDrawnTogether) {
  const std::vector<PendulumRecording> recordings = MakePendulums(TinyStudy());
  const ResamplingUnits people = MakeResamplingUnits(recordings, ClusterBy::kAuto);
  EXPECT_EQ(people.by, ClusterBy::kSubject);
  EXPECT_FALSE(people.people_shared);
  ASSERT_EQ(people.units.size(), 2u);
  std::set<std::vector<int>> seen;
  for (int k = 0; k < 200; ++k) {
    const std::vector<int> counts = DrawRecordings(people, 1, k);
    EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0), 6);
    for (const std::vector<int>& unit : people.units) {
      for (int recording : unit) {
        EXPECT_EQ(recordings[recording].subject_ids, recordings[unit[0]].subject_ids);
        EXPECT_EQ(counts[recording], counts[unit[0]]);
      }
    }
    seen.insert(counts);
  }
  EXPECT_EQ(seen.size(), 3u);
  EXPECT_EQ(DistinctResamples(2), 3.0);
  EXPECT_EQ(DistinctResamples(4), 35.0);
  const ResamplingUnits single = MakeResamplingUnits(recordings, ClusterBy::kRecording);
  EXPECT_EQ(single.units.size(), 6u);
}

// Nobody can be drawn without the others in the recording.
TEST(Bootstrap, WherePeopleShareRecordingsRecordingsAreDrawn) {
  std::vector<PendulumRecording> recordings = MakePendulums(TinyStudy());
  for (PendulumRecording& r : recordings) {  // somebody else is in all of them
    r.subject_ids.push_back("other");
    r.scene.people.push_back(r.scene.people[0]);
    r.hip.push_back(r.hip[0]);
  }
  const ResamplingUnits from = MakeResamplingUnits(recordings, ClusterBy::kSubject);
  EXPECT_TRUE(from.people_shared);
  EXPECT_EQ(from.by, ClusterBy::kRecording);
  EXPECT_EQ(from.units.size(), 6u);
}

TEST(Bootstrap, SaysWhatItDrewAndHowFewResamplesThereAre) {
  Bootstrap bootstrap;
  bootstrap.replicas = 199;
  bootstrap.drawn_by = ClusterBy::kSubject;
  bootstrap.drawn_from = 4;
  EXPECT_TRUE(Contains(ResamplingText(bootstrap), "resampling 4 people: 0 of 199"));
  EXPECT_TRUE(Contains(ResamplingText(bootstrap), "only 35 distinct resamples"));
  bootstrap.drawn_from = 5;
  EXPECT_FALSE(Contains(ResamplingText(bootstrap), "distinct"));
  bootstrap.drawn_by = ClusterBy::kRecording;
  bootstrap.people_shared = true;
  EXPECT_TRUE(Contains(ResamplingText(bootstrap), "5 recordings"));
  EXPECT_TRUE(Contains(ResamplingText(bootstrap), "people share recordings"));
}

TEST(Bootstrap, QuantilesAreThoseOfTheSample) {
  std::vector<double> values(199);
  std::iota(values.begin(), values.end(), 1.0);
  std::reverse(values.begin(), values.end());
  EXPECT_DOUBLE_EQ(Quantile(values, 0.025), 5.0);
  EXPECT_DOUBLE_EQ(Quantile(values, 0.975), 195.0);
  EXPECT_DOUBLE_EQ(Quantile({7.0}, 0.025), 7.0);
}

class BootstrapRun : public ::testing::Test {
 protected:
  BootstrapRun()
      : recordings_(MakePendulums(TinyStudy())),
        options_(UnbiasedFit(TinyStudy())),
        problem_(recordings_, options_),
        estimate_(Solve(problem_).start.to) {}

  Result<Bootstrap> Run(int replicas, int threads, uint64_t seed = 1) const {
    return ComputeBootstrap(problem_, estimate_, {replicas, seed, threads});
  }

  std::vector<PendulumRecording> recordings_;
  FitOptions options_;
  FitProblem problem_;
  FitPoint estimate_;
};

// Counting a recording twice is fitting two copies of it, and never counting it leaving it out.
TEST_F(BootstrapRun, CountsAreCopies) {
  const FitProblem counted(recordings_, options_, {2, 0, 1, 1, 1, 1});
  std::vector<PendulumRecording> copies = {recordings_[0], recordings_[0]};
  copies.insert(copies.end(), recordings_.begin() + 2, recordings_.end());
  const FitProblem copied(copies, options_);
  const SolveStart a = Refit(counted, estimate_), b = Refit(copied, estimate_);
  EXPECT_NEAR(a.cost, b.cost, 1e-9 * b.cost);
  for (size_t i = 0; i < a.to.shared.size(); ++i) {
    EXPECT_NEAR(a.to.shared[i], b.to.shared[i], 1e-5 * std::abs(b.to.shared[i]) + 1e-6);
  }
}

TEST_F(BootstrapRun, ThreadsChangeNothing) {
  const Bootstrap one = Run(12, 1).value();
  ASSERT_EQ(one.values.size(), 12u);
  EXPECT_EQ(one.names.front(), "mu");
  EXPECT_EQ(one.values, Run(12, 2).value().values);
  for (size_t i = 0; i < one.names.size(); ++i) {
    EXPECT_GT(one.standard_error[i], 0.0) << one.names[i];
    EXPECT_LT(one.lower95[i], one.upper95[i]) << one.names[i];
  }
}

// Three recordings can be drawn in ten ways: so many fits, however many replicas.
TEST_F(BootstrapRun, EachDrawIsFittedOnce) {
  const std::vector<PendulumRecording> three(recordings_.begin(), recordings_.begin() + 3);
  const FitProblem problem(three, options_);
  int fits = 0;
  const Bootstrap many = ComputeBootstrap(problem, estimate_, {300, 1, 1}, [&fits](int, int total) {
                           fits = total;
                         }).value();
  EXPECT_EQ(fits, 10);
  EXPECT_EQ(many.values.size() + many.failed, 300u);
  const ResamplingUnits from = MakeResamplingUnits(three, ClusterBy::kAuto);
  FitOptions as_replicas = options_;
  as_replicas.function_tolerance = 1e-6;
  for (int k : {0, 150, 299}) {  // what is known of each recording at the estimate changes nothing
    const std::vector<int> counts = DrawRecordings(from, 1, k);
    SolveStart alone = Refit(FitProblem(three, as_replicas, counts), estimate_);
    ASSERT_TRUE(alone.usable);
    EXPECT_NEAR(many.values[k][0], alone.to.shared[0], 1e-7 * many.values[k][0]);
  }
}

TEST_F(BootstrapRun, NeedsTwoRecordings) {
  const std::vector<PendulumRecording> one(recordings_.begin(), recordings_.begin() + 1);
  const FitProblem problem(one, options_);
  EXPECT_FALSE(ComputeBootstrap(problem, estimate_, {}).ok());
}

TEST(IntervalTable, HasOneRowPerNumber) {
  const std::vector<PendulumRecording> recordings = MakePendulums(TinyStudy());
  FittedModel model{Fit(recordings, UnbiasedFit(TinyStudy())), {}, {}, {}, {}};
  EXPECT_TRUE(IntervalTable(model).empty());
  ASSERT_FALSE(AddProfiles(recordings, {"mu"}, 1, nullptr, &model));
  ASSERT_FALSE(AddBootstrap(recordings, {20, 1, 2}, nullptr, &model));
  const TextTable table = IntervalTable(model);
  const std::vector<std::string>& mu = table.rows()[1];
  EXPECT_EQ(mu[0], "mu, N s/m");
  EXPECT_NE(mu[3], "-");
  EXPECT_NE(mu[4], "-");
  EXPECT_EQ(mu[5], "identifiable");
  EXPECT_EQ(table.rows()[2][3], "-");
  EXPECT_NE(table.rows()[2][4], "-");
}

}  // namespace
}  // namespace pushid
