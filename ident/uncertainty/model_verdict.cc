// ident: score tests of what is taken as known and of parts of the data, and total errors.
#include "ident/uncertainty/model_verdict.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "datasets/inspection/findings.h"
#include "ident/problem/behaviour_text.h"
#include "ident/problem/fit_problem.h"
#include "ident/uncertainty/assumptions.h"
#include "ident/uncertainty/clusters.h"
#include "ident/uncertainty/covariance.h"
#include "models/decompositions.h"

namespace pushid {
namespace {

constexpr int kMostEstimates = 120;
constexpr int kFewestClusters = 3;
const std::vector<int> kHorizons = {8, 16, 32, 64};  // frames
constexpr double kLeastShare = 0.5;         // of the data, of an estimate that parts are asked for
constexpr double kReach = 30.0;             // errors of stated ones, beyond which nothing is told
constexpr double kLeastInformation = 1e-6;  // of an assumption, beside what estimates explain

std::string WhyNot(const FitOptions& options, size_t estimates) {
  if (options.likelihood != Likelihood::kTrajectory) return "the likelihood is of single steps";
  if (options.sigmas.loss != FrameLoss::kHip) return "the loss is LDP's";
  if (options.model.learned != nullptr) return "a network is fitted";
  if (estimates > kMostEstimates) return "there are more than 120 fitted numbers";
  return "";
}

// s_g, a column for each cluster.
Eigen::MatrixXd Scores(const ResidualRows& rows, const RowClusters& clusters) {
  Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(rows.jacobian.cols(), clusters.count);
  for (size_t i = 0; i < clusters.of_row.size(); ++i) {
    if (clusters.of_row[i] < 0) continue;
    const Eigen::Index row = static_cast<Eigen::Index>(i);
    scores.col(clusters.of_row[i]) += rows.residuals[row] * rows.jacobian.row(row).transpose();
  }
  return scores;
}

// Whether a push comes more from the side than from ahead or behind.
bool FromTheSide(const PendulumRecording& r) {
  const Eigen::Vector2d facing(std::cos(r.facing), std::sin(r.facing));
  return std::abs(PushDirection(r).dot(facing)) < std::sqrt(0.5);
}

// Findings about how pushes and motion agree that at least half of the recordings have.
std::vector<std::string> OfMostPushes(const std::vector<PendulumRecording>& recordings) {
  std::vector<Finding> most;
  const std::vector<Finding> all = FindingsOf(recordings);
  for (FindingKind kind : {FindingKind::kAgainst, FindingKind::kAside, FindingKind::kGain,
                           FindingKind::kNetGain, FindingKind::kLate, FindingKind::kEarly}) {
    std::vector<Finding> same;
    for (const Finding& finding : all) {
      if (finding.kind == kind) same.push_back(finding);
    }
    if (2 * same.size() >= recordings.size()) most.insert(most.end(), same.begin(), same.end());
  }
  return FindingTexts(most);
}

// The smallest p-value after `num` tests of a family.
template <typename Test>
double Least(const std::vector<Test>& tests, size_t num) {
  if (num == 0) return 1.0;  // nothing could be tested
  double least = 1.0;
  for (const Test& test : tests) least = std::min(least, test.p);
  return std::min(1.0, least * static_cast<double>(num));
}

// The error of a sum over clusters.
double ErrorOfSum(const Eigen::VectorXd& parts) {
  const double n = static_cast<double>(parts.size());
  return std::sqrt(n / (n - 1.0) * (parts.array() - parts.mean()).matrix().squaredNorm());
}

class ModelJudge {
 public:
  ModelJudge(const FitProblem& problem, const FitPoint& point)
      : problem_(problem),
        point_(point),
        clusters_(MakeClusters(problem.recordings(), ClusterBy::kAuto, problem.counts())),
        columns_(FittedColumns(problem, point)) {
    verdict_.not_checked = WhyNot(problem.options(), columns_.size());
    if (!verdict_.checked()) return;
    assumptions_ = AssumptionsOf(problem, point);
    rows_ = EvaluateRows(problem, point, assumptions_, kHorizons);
    if (rows_.jacobian.cols() == 0) verdict_.not_checked = "a rollout fails at the optimum";
  }

  ModelVerdict Run(Uncertainty* uncertainty) {
    uncertainty_ = uncertainty;
    if (!verdict_.checked()) return verdict_;
    verdict_.freedom = clusters_.count() - 1;
    clustering_ = ClusterRows(problem_, clusters_, rows_);
    const Eigen::Index n = num_estimates();
    const Eigen::MatrixXd own = rows_.robust_jacobian.leftCols(n);
    beside_ = InformationBeside(rows_).topLeftCorner(n, n);
    const Eigen::MatrixXd hessian = own.transpose() * own + beside_;
    inverse_ = SolveSymmetric(hessian, Eigen::MatrixXd(Eigen::MatrixXd::Identity(n, n)));
    scores_ = Scores(rows_, clustering_.first);
    if (clusters_.count() >= kFewestClusters) {
      TestAssumptions(own);
      TestParts();
      TestMotion();
      verdict_.of_pushes = OfMostPushes(problem_.recordings());
    } else {
      const bool people = clusters_.by == ClusterBy::kSubject;
      verdict_.not_checked = std::to_string(clusters_.count()) +
                             (people ? " people" : " recordings") +
                             " cannot tell, three or more could";
    }
    if (clusters_.count() > 1) AddTotals();
    return verdict_;
  }

 private:
  Eigen::Index num_estimates() const { return static_cast<Eigen::Index>(columns_.size()); }

  double Slope(Eigen::Index i) const {
    return TransformSlope(columns_[i].transform, columns_[i].natural);
  }

  void TestAssumptions(const Eigen::MatrixXd& own) {
    const Eigen::Index n = num_estimates(), shared = problem_.map().num_shared();
    for (size_t k = 0; k < assumptions_.size(); ++k) {
      const Assumption& a = assumptions_[k];
      const Eigen::Index column = n + static_cast<Eigen::Index>(k);
      const auto by = rows_.robust_jacobian.col(column);
      const Eigen::VectorXd b = own.transpose() * by;
      const Eigen::VectorXd moves = -inverse_ * b;
      const double all = by.squaredNorm(), information = all + b.dot(moves);
      AssumptionTest test{a.name, a.unit, a.sigma, 0.0, 0.0, 0.0, 1.0, {}};
      if (a.sigma > 0.0) {
        for (Eigen::Index i = 0; i < shared; ++i) {
          test.moves.push_back(a.sigma * moves[i] * Slope(i));
        }
      }
      if (information > kLeastInformation * all) {
        const Eigen::VectorXd parts =
            scores_.row(column).transpose() + scores_.topRows(n).transpose() * moves;
        test.wanted = -scores_.row(column).sum() / information;
        // Priors scatter about the truth as they say.
        test.error =
            std::hypot(ErrorOfSum(parts), std::sqrt(moves.dot(beside_ * moves))) / information;
        test.t = test.wanted / std::hypot(test.error, a.sigma);
        test.p = StudentTail(test.t, verdict_.freedom);
        const double reach = a.sigma > 0.0 ? kReach * a.sigma : kReach * a.step / kScaleStep;
        if (test.error > reach) test = {a.name, a.unit, a.sigma, 0.0, 0.0, 0.0, 1.0, test.moves};
      }
      verdict_.assumptions.push_back(std::move(test));
    }
    verdict_.p_assumptions = Least(verdict_.assumptions, verdict_.NumTested());
  }

  // The parts of the data that are asked.
  void TestParts() {
    for (size_t h = 0; h < kHorizons.size(); ++h) {
      TestPart("the first " + std::to_string(kHorizons[h]) + " frames from the push on",
               [&](const DataPart& part) { return part.part <= static_cast<int>(h); });
    }
    // Only where sideways is as forwards must pushes from the side ask for the same.
    if (problem_.options().model.directions == Directions::kIsotropic) {
      TestPart(kFromTheSide, [&](const DataPart& part) {
        return FromTheSide(problem_.recordings()[part.recording]);
      });
    }
    verdict_.p_parts = Least(verdict_.parts, verdict_.parts.size());
  }

  template <typename Holds>
  void TestPart(const std::string& name, const Holds& holds) {
    const Eigen::Index n = num_estimates(), shared = problem_.map().num_shared();
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixXd some = Eigen::MatrixXd::Zero(n, clusters_.count());  // scores
    std::set<int> inside, outside;                                       // clusters
    for (const DataPart& part : rows_.parts) {
      const int cluster = clusters_.of[part.recording][part.person];
      const bool held = holds(part);
      (held ? inside : outside).insert(cluster);
      if (!held) continue;
      information += part.information;
      some.col(cluster) += part.score;
    }
    // Fewer know nothing of their own scatter.
    if (static_cast<int>(std::min(inside.size(), outside.size())) < kFewestClusters) return;
    const Eigen::MatrixXd share = information * inverse_;
    const Eigen::MatrixXd parts = some - share * scores_.topRows(n);
    // What priors and demands pull at the optimum is balanced by all rows, and by their share of
    // these.
    const Eigen::VectorXd sum = some.rowwise().sum() - share * scores_.topRows(n).rowwise().sum();
    for (Eigen::Index i = 0; i < shared; ++i) {
      const double error = ErrorOfSum(parts.row(i).transpose());
      // What priors hold asks for its prior, in parts more than in all.
      if (error <= 0.0 || uncertainty_->estimates[i].shares.data < kLeastShare) continue;
      const double t = sum[i] / error;
      verdict_.parts.push_back({columns_[i].name, name, t, StudentTail(t, verdict_.freedom)});
    }
  }

  void TestMotion() {
    verdict_.motion = CompareMotion(problem_, point_, clusters_);
    verdict_.p_motion = Least(verdict_.motion.tests, verdict_.motion.tests.size());
  }

  void AddTotals() {
    const int n = static_cast<int>(num_estimates());
    std::vector<int> joint;
    std::vector<double> unit;
    const Eigen::VectorXd own = Units(columns_);
    for (int i = 0; i < n; ++i) joint.push_back(i), unit.push_back(own[i]);
    for (size_t k = 0; k < assumptions_.size(); ++k) {
      if (assumptions_[k].sigma <= 0.0) continue;
      joint.push_back(n + static_cast<int>(k));
      unit.push_back(assumptions_[k].sigma);
    }
    ResidualRows rows = std::move(rows_);  // the last to ask
    rows.jacobian = rows.jacobian(Eigen::all, joint).eval();
    rows.robust_jacobian = rows.robust_jacobian(Eigen::all, joint).eval();
    clustering_.recordings = {};  // nobody asks for the errors of these people
    const Covariance c = ComputeCovariance(
        rows, Eigen::Map<const Eigen::VectorXd>(unit.data(), unit.size()), clustering_);
    const Eigen::VectorXd moves = -c.inverse_hessian * (rows.jacobian.transpose() * rows.residuals);
    for (Eigen::Index i = 0; i < problem_.map().num_shared(); ++i) {
      const FittedColumn& column = columns_[i];
      const ScatterOf of = c.scatter.OfColumn(i);
      Estimate& e = uncertainty_->estimates[i];
      const double slope = Slope(i);
      const double pull =
          slope > 0.0 ? (e.shares.prior_pull + e.shares.settling_pull) / slope : 0.0;
      const double error = std::hypot(std::hypot(of.standard_error, moves[i]), pull);
      const double width = of.quantile * error;
      TotalError& total = e.total.emplace();
      total.error = Slope(i) * error;
      // Never less than that of the data alone, which may have fewer degrees of freedom.
      total.lower95 = std::min(e.lower95, ToNatural(column.transform, column.fitted - width));
      total.upper95 = std::max(e.upper95, ToNatural(column.transform, column.fitted + width));
    }
  }

  const FitProblem& problem_;
  const FitPoint& point_;
  Uncertainty* uncertainty_ = nullptr;
  Clusters clusters_;
  std::vector<FittedColumn> columns_;
  std::vector<Assumption> assumptions_;
  ResidualRows rows_;
  Clustering clustering_;
  Eigen::MatrixXd beside_, inverse_, scores_;
  ModelVerdict verdict_;
};

// Whether people may react late for all that the recordings say: damping is then less by the delay
// times the stiffness. The test tells a delay from none, and underrates how long it is.
bool MayBeLate(const ModelVerdict& verdict) {
  constexpr double kExcluded = 0.03;  // s
  for (const AssumptionTest& test : verdict.assumptions) {
    if (test.name != kReactionDelayName) continue;
    return test.error <= 0.0 || test.wanted > 2.0 * test.error ||
           test.wanted + 2.0 * test.error > kExcluded;
  }
  return false;
}

std::string WhyNoneIsIdentified(const Uncertainty& uncertainty, const Behaviour& behaviour,
                                const ModelOptions& model) {
  if (!uncertainty.clustered) {
    return "there is one recording, so that errors between people and between recordings are "
           "unknown; intervals are those of the posterior, priors included";
  }
  const Verdict verdict = VerdictOf(behaviour, model);
  if (verdict != Verdict::kSettles && verdict != Verdict::kSlowToSettle) {
    return VerdictSentence(verdict, behaviour, model);
  }
  return uncertainty.settling.dropped()
             ? "the fitted person does not settle in time, and the demand to settle was dropped"
             : "";
}

}  // namespace

ModelVerdict JudgeModel(const FitProblem& problem, const FitPoint& point,
                        const Behaviour& behaviour, Uncertainty* uncertainty) {
  const std::vector<FittedColumn> columns = FittedColumns(problem, point);
  ModelVerdict verdict = ModelJudge(problem, point).Run(uncertainty);
  verdict.none_identified = WhyNoneIsIdentified(*uncertainty, behaviour, problem.options().model);
  const bool late = MayBeLate(verdict);
  const bool doubtful = verdict.fails() || !verdict.none_identified.empty();
  for (size_t i = 0; i < columns.size(); ++i) {
    Estimate& e = uncertainty->estimates[i];
    if (e.status != EstimateStatus::kIdentified) continue;
    const bool damping = e.name == "Kd_theta" || e.name == "Kd_phi";
    if (e.total && !IsNarrow(columns[i], e.total->lower95, e.total->upper95)) {
      e.status = EstimateStatus::kWeak;
    } else if (doubtful || (late && damping)) {
      e.status = EstimateStatus::kModelDependent;
    }
  }
  return verdict;
}

}  // namespace pushid
