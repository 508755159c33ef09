// Clusters of independent errors, and how well the scatter over them is known.

#include <Eigen/Core>

#include "ident/problem/fit_problem.h"
#include "ident/problem/residual_rows.h"
#include "ident/uncertainty/covariance.h"
#include "models/decompositions.h"
#include "tests/ident/fit_samples.h"

namespace pushid {
namespace {

// Rows r = y - m of clusters of given sizes; the least-squares m is their mean.
ResidualRows MeanProblem(const std::vector<std::vector<double>>& clusters) {
  ResidualRows score;
  double sum = 0.0;
  int rows = 0;
  for (const auto& y : clusters) {
    for (double value : y) sum += value, ++rows;
  }
  score.jacobian = Eigen::MatrixXd::Constant(rows, 1, -1.0);
  score.residuals.resize(rows);
  int row = 0;
  for (size_t g = 0; g < clusters.size(); ++g) {
    score.clusters.push_back(static_cast<int>(g));
    for (double value : clusters[g]) {
      score.residuals[row++] = value - sum / rows;
      score.cluster_of_row.push_back(static_cast<int>(g));
      score.person_of_row.push_back(0);
    }
  }
  score.num_data_rows = rows;
  return score;
}

Covariance Of(const ResidualRows& score) {
  return ComputeCovariance(score, Eigen::VectorXd::Ones(1), {ClusterByRecording(score), {}, 0});
}

// Clusters of one size: the textbook's variance of a mean of cluster means, with G - 1 degrees of
// freedom.
TEST(Clusters, BalancedMeanIsTheTextbooks) {
  const Covariance c = Of(MeanProblem({{1.0, 1.2}, {2.0, 2.4}, {0.5, 0.1}, {1.5, 1.1}}));
  const Eigen::Vector4d means(1.1, 2.2, 0.3, 1.3);
  const double expected = (means.array() - means.mean()).square().sum() / (4.0 * 3.0);
  EXPECT_NEAR(c.scatter.Covariance()(0, 0), expected, 1e-12);
  EXPECT_NEAR(c.scatter.parts[0].freedom[0], 3.0, 1e-9);
}

// One cluster holds most rows: the mean leans on it, and fewer degrees of freedom are left.
TEST(Clusters, AnUnevenClusterCostsFreedom) {
  std::vector<std::vector<double>> clusters(4, {1.0});
  clusters[0].assign(20, 1.3);
  EXPECT_LT(Of(MeanProblem(clusters)).scatter.parts[0].freedom[0], 1.6);
}

// Two clusters and a prior that settles most: what the two say still has one degree of freedom.
TEST(Clusters, HaveOneFreedomLessThanTheirNumberBesideAPrior) {
  ResidualRows score = MeanProblem({{1.0, 1.1, 0.9}, {2.0}});
  const Eigen::Index rows = score.residuals.size();
  score.jacobian.conservativeResize(rows + 1, Eigen::NoChange);
  score.residuals.conservativeResize(rows + 1);
  score.jacobian(rows, 0) = -100.0;
  score.residuals[rows] = 0.0;
  score.cluster_of_row.push_back(FitProblem::kPriorCluster);
  score.person_of_row.push_back(0);
  const RowClusters clusters = ClusterByRecording(score);
  const Covariance c = ComputeCovariance(score, Eigen::VectorXd::Ones(1), {clusters, {}, 0, true});
  EXPECT_EQ(c.scatter.OfColumn(0).freedom, 1.0);
  EXPECT_NEAR(c.scatter.parts[1].covariance(0, 0), 1e-4, 1e-7);  // the prior's width
}

// One recording whose four rows scatter by 1e-3, and a prior of +- 40 that they say little beside:
// H = 4 w + 1 / 1600 with w the weight of a row. Only rows of data are scaled by their scatter.
TEST(Clusters, ThePriorIsNotScaledByTheScatterOfTheData) {
  ResidualRows score = MeanProblem({{1e-3, -1e-3, 1e-3, -1e-3}});
  constexpr double kRow = 1e-4;  // d residual / d parameter
  score.jacobian *= kRow;
  score.jacobian.conservativeResize(5, Eigen::NoChange);
  score.residuals.conservativeResize(5);
  score.jacobian(4, 0) = 1.0 / 40.0;
  score.residuals[4] = 0.0;
  score.cluster_of_row.push_back(FitProblem::kPriorCluster);
  score.person_of_row.push_back(0);
  const Covariance c = Of(score);
  EXPECT_TRUE(c.scatter.empty());
  EXPECT_NEAR(std::sqrt(c.inverse_hessian(0, 0)), 39.999, 1e-3);
  EXPECT_NEAR(std::sqrt(c.naive(0, 0)), 39.997, 1e-3);
}

// Degrees of freedom by Pustejovsky and Tipton's formula, written out over rows.
TEST(Clusters, FreedomIsSatterthwaites) {
  Random random(5);
  ResidualRows score;
  const int sizes[] = {3, 5, 2, 7};
  for (int g = 0; g < 4; ++g) {
    score.clusters.push_back(g);
    for (int k = 0; k < sizes[g]; ++k) {
      score.cluster_of_row.push_back(g);
      score.person_of_row.push_back(0);
    }
  }
  const int n = static_cast<int>(score.cluster_of_row.size());
  score.jacobian = Eigen::MatrixXd(n, 2);
  score.residuals = Eigen::VectorXd(n);
  for (int i = 0; i < n; ++i) {
    score.jacobian.row(i) << 1.0, random.Normal();
    score.residuals[i] = random.Normal();
  }
  score.num_data_rows = n;
  const Eigen::MatrixXd& j = score.jacobian;
  const Eigen::MatrixXd inverse = Inverse(j.transpose() * j);
  const Eigen::MatrixXd rest =
      Eigen::MatrixXd::Identity(n, n) - j * inverse * j.transpose();  // 1 - P
  const Covariance c =
      ComputeCovariance(score, Eigen::VectorXd::Ones(2), {ClusterByRecording(score), {}, 0});
  for (int coefficient = 0; coefficient < 2; ++coefficient) {
    Eigen::MatrixXd p = Eigen::MatrixXd::Zero(n, 4);
    int first = 0;
    for (int g = 0; g < 4; first += sizes[g++]) {
      const Eigen::MatrixXd own = rest.block(first, first, sizes[g], sizes[g]);
      p.col(g).segment(first, sizes[g]) = DecomposeSymmetric(own).InverseSqrt() *
                                          j.middleRows(first, sizes[g]) * inverse.col(coefficient);
    }
    const Eigen::MatrixXd w = p.transpose() * rest * p;
    EXPECT_NEAR(c.scatter.parts[0].freedom[coefficient], w.trace() * w.trace() / w.squaredNorm(),
                1e-6);
  }
}

TEST(Clusters, ArePeopleWhereTheyRepeat) {
  const auto recordings = MakePendulums(TinyStudy());  // two people, three pushes each
  const Clusters people = MakeClusters(recordings, ClusterBy::kAuto);
  EXPECT_EQ(people.by, ClusterBy::kSubject);
  EXPECT_EQ(people.count(), 2);
  EXPECT_FALSE(people.two_way);
  EXPECT_EQ(MakeClusters(recordings, ClusterBy::kRecording).count(), 6);
}

TEST(Clusters, AreRecordingsWhereNobodyRepeats) {
  SyntheticOptions study = TinyStudy();
  study.recordings_per_subject = 1;
  const Clusters clusters = MakeClusters(MakePendulums(study), ClusterBy::kAuto);
  EXPECT_EQ(clusters.by, ClusterBy::kRecording);
  EXPECT_TRUE(clusters.draws_people);  // each is a person
}

// The recordings of people who repeat are draws from these people; so are those of one person.
TEST(Clusters, OfRecordingsAreAboutThesePeople) {
  const auto recordings = MakePendulums(TinyStudy());
  EXPECT_TRUE(MakeClusters(recordings, ClusterBy::kAuto).draws_people);
  EXPECT_FALSE(MakeClusters(recordings, ClusterBy::kRecording).draws_people);
  const Clusters one = MakeClusters({recordings[0], recordings[1]}, ClusterBy::kAuto);
  EXPECT_EQ(one.people, 1);
  EXPECT_FALSE(one.draws_people);
}

// A person who is weighed anew before each session stays one person.
TEST(Clusters, AnIdWithTwoMassesIsOnePerson) {
  auto recordings = MakePendulums(TinyStudy());
  recordings[0].scene.people[0].body.mass *= 1.006;
  EXPECT_EQ(MakeClusters(recordings, ClusterBy::kSubject).count(), 2);
  for (PendulumRecording& r : recordings) r.subject_ids = {"S01"};
  const Clusters one = MakeClusters(recordings, ClusterBy::kAuto);
  EXPECT_EQ(one.people, 1);
  EXPECT_FALSE(one.draws_people) << "six recordings of one person say nothing of others";
}

TEST(Clusters, PeopleWhoShareRecordingsAreClusteredTwoWays) {
  SyntheticOptions study = TinyStudy();
  study.people_in_row = 2;
  study.model.interaction.spring = study.model.interaction.damping = true;
  study.parameters[kContactStiffness] = 2000.0;
  study.parameters[kContactDistance] = 0.4;
  study.parameters[kContactKappa] = 0.6;
  study.parameters[kContactDamping] = 100.0;
  study.parameters[kContactHeight] = 0.5;
  const auto recordings = MakePendulums(study);
  const Clusters clusters = MakeClusters(recordings, ClusterBy::kAuto);
  EXPECT_TRUE(clusters.two_way);
  EXPECT_EQ(clusters.of[0].size(), 2u);
  EXPECT_EQ(clusters.line_up, (std::vector<int>{0, 1, 2, 3, 4, 5}));  // of two line-ups alone
  study.subjects = 4;
  study.recordings_per_subject = 2;
  EXPECT_EQ(MakeClusters(MakePendulums(study), ClusterBy::kAuto).line_up,
            (std::vector<int>{0, 0, 1, 1, 2, 2, 3, 3}));
}

// A and B in two recordings, B and C in a third: two line-ups. The mean's variance is that of
// people, and of line-ups, less that of people in line-ups.
TEST(Clusters, LineUpsAreTheSecondWay) {
  const ResidualRows score = MeanProblem({{1.0, 2.0}, {2.0, 1.5}, {0.5, 3.5}});
  const RowClusters people{{0, 1, 0, 1, 1, 2}, 3}, line_ups{{0, 0, 0, 0, 1, 1}, 2};
  const Eigen::VectorXd unit = Eigen::VectorXd::Ones(1);
  const auto variance = [&](const Clustering& clustering) {
    return ComputeCovariance(score, unit, clustering).scatter.Covariance()(0, 0);
  };
  const Eigen::VectorXd& r = score.residuals;
  const double both =
      std::pow(r[0] + r[2], 2) + std::pow(r[1] + r[3], 2) + r[4] * r[4] + r[5] * r[5];
  const RowClusters recordings = ClusterByRecording(score);
  EXPECT_NEAR(variance({people, recordings, 0, false, line_ups}),
              variance({people, {}, 0}) + variance({line_ups, {}, 0}) - both / 36.0, 1e-12);
}

}  // namespace
}  // namespace pushid
