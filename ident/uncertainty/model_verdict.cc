// ident: score tests of what is taken as known and of parts of the data, and total errors.
#include "ident/uncertainty/model_verdict.h"

#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "datasets/inspection/findings.h"
#include "ident/problem/fit_problem.h"
#include "ident/problem/residual_rows.h"
#include "ident/problem/statistics.h"
#include "ident/uncertainty/assumptions.h"
#include "models/decompositions.h"
#include "residuals/frame_residual.h"

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
  double least = 1.0;
  for (const Test& test : tests) least = std::min(least, test.p);
  return std::min(1.0, least * static_cast<double>(std::max<size_t>(1, num)));
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
    information_ = rows_.robust_jacobian.transpose() * rows_.robust_jacobian;
    beside_ = rows_.InformationBeside();
    scores_ = Scores(rows_, clustering_.first);
    if (clusters_.count() >= kFewestClusters) {
      TestAssumptions();
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

  // Columns of estimates, and of the assumptions of which something is stated, or of the step
  // alone.
  std::vector<Eigen::Index> Free(bool all_stated) const {
    std::vector<Eigen::Index> free(num_estimates());
    std::iota(free.begin(), free.end(), 0);
    for (size_t k = 0; k < assumptions_.size(); ++k) {
      const Assumption& a = assumptions_[k];
      if (a.name == kStepName || (all_stated && a.sigma > 0.0)) {
        free.push_back(num_estimates() + static_cast<Eigen::Index>(k));
      }
    }
    return free;
  }

  void TestAssumptions() {
    const Eigen::Index n = num_estimates(), shared = problem_.map().num_shared();
    for (size_t k = 0; k < assumptions_.size(); ++k) {
      const Assumption& a = assumptions_[k];
      const Eigen::Index column = n + static_cast<Eigen::Index>(k);
      std::vector<Eigen::Index> free = Free(false);
      free.erase(std::remove(free.begin(), free.end(), column), free.end());
      const Eigen::MatrixXd beside = beside_(free, free);
      const Eigen::VectorXd b = information_(free, column);
      const Eigen::VectorXd moves =
          -SolveSymmetric(Eigen::MatrixXd(information_(free, free) + beside), b);
      const double all = information_(column, column), information = all + b.dot(moves);
      AssumptionTest test{a.name, a.unit, a.sigma, 0.0, 0.0, 0.0, 1.0, {}};
      if (a.sigma > 0.0) {
        for (Eigen::Index i = 0; i < shared; ++i) {
          test.moves.push_back(a.sigma * moves[i] * Slope(i));
        }
      }
      if (information > kLeastInformation * all) {
        const Eigen::VectorXd parts =
            scores_.row(column).transpose() + scores_(free, Eigen::all).transpose() * moves;
        // What scores by estimates add up to is balanced by priors and demands.
        const double balanced = moves.head(n).dot(scores_.topRows(n).rowwise().sum());
        test.wanted = (balanced - parts.sum()) / information;
        // Priors scatter about the truth as they say.
        test.error =
            std::hypot(ErrorOfSum(parts), std::sqrt(moves.dot(beside * moves))) / information;
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
    const Eigen::Index all = information_.cols();
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(all, all);
    Eigen::MatrixXd some = Eigen::MatrixXd::Zero(all, clusters_.count());  // scores
    std::set<int> inside, outside;                                         // clusters
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
    const std::vector<Eigen::Index> free = Free(false);
    // Without the estimates' priors: where these pull an estimate from the truth, its score in a
    // part is the part's share of all scores. The step errs as it is stated.
    Eigen::MatrixXd beside = beside_(free, free);
    beside.topLeftCorner(num_estimates(), num_estimates()).setZero();
    const Eigen::MatrixXd share = SolveSymmetric(Eigen::MatrixXd(information_(free, free) + beside),
                                                 Eigen::MatrixXd(information(free, free)))
                                      .transpose();
    const Eigen::MatrixXd parts = some(free, Eigen::all) - share * scores_(free, Eigen::all);
    const Eigen::MatrixXd of_step = share * beside * share.transpose();
    for (Eigen::Index i = 0; i < problem_.map().num_shared(); ++i) {
      const double error =
          std::hypot(ErrorOfSum(parts.row(i).transpose()), std::sqrt(of_step(i, i)));
      // An estimate that priors hold asks for its prior, in parts more than in all.
      if (error <= 0.0 || uncertainty_->estimates[i].shares.data < kLeastShare) continue;
      const double t = parts.row(i).sum() / error;
      verdict_.parts.push_back({columns_[i].name, name, t, StudentTail(t, verdict_.freedom)});
    }
  }

  void TestMotion() {
    verdict_.motion = CompareMotion(problem_, point_, clusters_);
    verdict_.p_motion = Least(verdict_.motion.tests, verdict_.motion.tests.size());
  }

  // With what is stated free as well.
  void AddTotals() {
    const Eigen::Index n = num_estimates();
    const std::vector<Eigen::Index> joint = Free(true);
    Eigen::VectorXd unit(static_cast<Eigen::Index>(joint.size()));
    unit.head(n) = Units(columns_);
    for (size_t i = columns_.size(); i < joint.size(); ++i) {
      unit[static_cast<Eigen::Index>(i)] = assumptions_[joint[i] - n].sigma;
    }
    ResidualRows rows = std::move(rows_);  // the last to ask
    rows.jacobian = rows.jacobian(Eigen::all, joint).eval();
    rows.robust_jacobian = rows.robust_jacobian(Eigen::all, joint).eval();
    clustering_.recordings = {};  // nobody asks for the errors of these people
    const Covariance c = ComputeCovariance(rows, unit, clustering_);
    if (c.scatter.empty()) return;
    Scatter& total = uncertainty_->total = {};
    for (const Scatter::Part& part : c.scatter.parts) {
      total.parts.push_back({part.covariance.topLeftCorner(n, n), part.freedom.head(n)});
    }
    // Moves and pulls of an estimate are known no better than how the recordings scatter.
    const Eigen::VectorXd freedom = total.parts[0].freedom;
    const Eigen::VectorXd moves =
        (c.inverse_hessian * (rows.jacobian.transpose() * rows.residuals)).head(n);
    Eigen::VectorXd pulls = Eigen::VectorXd::Zero(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Shares& shares = uncertainty_->estimates[i].shares;
      if (Slope(i) > 0.0) pulls[i] = (shares.prior_pull + shares.settling_pull) / Slope(i);
    }
    total.parts.push_back({moves * moves.transpose(), freedom});
    total.parts.push_back({pulls * pulls.transpose(), freedom});
    for (Eigen::Index i = 0; i < problem_.map().num_shared(); ++i) {
      Estimate& e = uncertainty_->estimates[i];
      e.total = WidenedTo({e.standard_error, e.lower95, e.upper95},
                          IntervalOf(columns_[i], total.OfColumn(i)));
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
  Eigen::MatrixXd information_, beside_, scores_;  // by estimates, then assumptions
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
  const Verdict verdict = VerdictOf(behaviour);
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
    const Interval shown = e.interval();
    if (!IsNarrow(columns[i].transform, columns[i].width, shown.lower, shown.upper)) {
      e.status = EstimateStatus::kWeak;
    } else if (doubtful || (late && (e.name == "Kd_theta" || e.name == "Kd_phi"))) {
      e.status = EstimateStatus::kModelDependent;
    }
  }
  return verdict;
}

namespace {

constexpr double kDrop = 0.03;     // m: more than what markers' noise does
constexpr double kSmoothed = 0.1;  // s: of the paths whose turns are looked for

// Along the push, m, from where the first frame has them.
struct Motion {
  std::vector<double> hip, feet;
};

struct Compared {
  Motion recorded, predicted;
  double way = 0.0, error = 0.0;  // of the hip, squared, m^2, without the markers' white noise
  bool whole = true;              // every frame was seen
};

Compared MotionOf(const PendulumRecording& r, const std::vector<double>& raw,
                  const ResidualSigmas& sigmas) {
  const Eigen::Vector2d along = PushDirection(r);
  const int n = r.pushed_person;
  Compared c;
  double feet = 0.0;   // predicted less recorded
  double noise = 0.0;  // half the squared changes of errors from frame to frame: what is white
  Eigen::Vector2d before = Eigen::Vector2d::Zero();
  for (int t = 0; t < r.num_frames(); ++t) {
    const Eigen::Vector2d hip = (r.hip[n][t] - r.hip[n][0]).head<2>();
    const Eigen::Vector2d at = (r.states[n][t].q - r.states[n][0].q).head<2>();
    Eigen::Vector2d error = Eigen::Vector2d::Zero();
    const double seen = t > 0 ? r.Weight(n, t) : 1.0;
    c.whole = c.whole && seen > 0.0;
    if (t > 0 && seen > 0.0) {
      const int row = ((t - 1) * r.num_people() + n) * kFrameResiduals;
      const Eigen::Map<const FrameVector<double>> residual(raw.data() + row);
      error = sigmas.hip / seen * residual.head<2>();
      feet += r.scene.dt * sigmas.velocity / seen * along.dot(residual.segment<2>(3));
    }
    c.recorded.hip.push_back(along.dot(hip));
    c.predicted.hip.push_back(along.dot(hip + error));
    c.recorded.feet.push_back(along.dot(at));
    c.predicted.feet.push_back(along.dot(at) + feet);
    if (seen > 0.0) c.way += hip.squaredNorm();
    c.error += error.squaredNorm();
    if (t > 1 && seen > 0.0) noise += 0.5 * (error - before).squaredNorm();
    before = error;
  }
  // The noise of the first frame, where paths begin, is in every frame as well.
  c.error = std::max(0.0, c.error - 2.0 * noise);
  c.way -= 2.0 * noise;
  return c;
}

// The means of the clusters.
class Differences {
 public:
  void Add(int cluster, double difference) {
    sum_[cluster] += difference;
    count_[cluster] += 1;
  }

  // stated: an error that all have in common. step: of what is counted, in whole ones of which all
  // may differ alike.
  std::optional<MotionTest> Test(const char* quantity, const char* unit, double stated,
                                 double step) const {
    if (sum_.size() < 3) return std::nullopt;
    double recordings = 0.0;
    std::vector<double> means;
    for (const auto& [cluster, sum] : sum_) {
      means.push_back(sum / count_.at(cluster));
      recordings += count_.at(cluster);
    }
    const auto [mean, error] = MeanOf(means);
    MotionTest test{quantity, unit, mean, std::max(error, step / std::sqrt(12.0 * recordings))};
    if (test.error <= 0.0) return std::nullopt;  // alike in all: nobody knows how much they scatter
    test.t = mean / std::hypot(test.error, stated);
    test.p = StudentTail(test.t, static_cast<double>(means.size()) - 1.0);
    return test;
  }

 private:
  std::map<int, double> sum_;
  std::map<int, int> count_;
};

}  // namespace

MotionComparison CompareMotion(const FitProblem& problem, const FitPoint& point,
                               const Clusters& clusters) {
  Differences feet, time, turns;
  std::vector<double> explained;
  const ResidualsByRecording all = RawResiduals(problem, point);
  for (size_t i = 0; i < problem.recordings().size(); ++i) {
    const PendulumRecording& r = problem.recordings()[i];
    if (problem.Count(static_cast<int>(i)) == 0 || !r.IsSeen()) continue;
    const std::vector<double>& raw = all[i];
    if (raw.empty()) return {};
    const Compared c = MotionOf(r, raw, problem.options().sigmas);
    if (c.way > 0.0) explained.push_back(1.0 - c.error / c.way);
    if (!c.whole) continue;
    const int cluster = clusters.of[i][r.pushed_person];
    feet.Add(cluster, c.recorded.feet.back() - c.predicted.feet.back());
    const int half = static_cast<int>(std::lround(0.5 * kSmoothed / r.scene.dt));
    const std::vector<int> recorded = TurnsOf(MovingMean(c.recorded.hip, half), kDrop);
    const std::vector<int> predicted = TurnsOf(MovingMean(c.predicted.hip, half), kDrop);
    turns.Add(cluster,
              static_cast<double>(recorded.size()) - static_cast<double>(predicted.size()));
    if (!recorded.empty() && !predicted.empty()) {
      time.Add(cluster, r.scene.dt * (recorded.front() - predicted.front()));
    }
  }
  MotionComparison found;
  for (const std::optional<MotionTest>& test :
       {feet.Test("travel of the feet", "m", Stated(problem.recordings()).drift_m, 0.0),
        time.Test("first turn of the hip", "s", 0.0, problem.recordings()[0].scene.dt),
        turns.Test("number of turns of the hip", "", 0.0, 1.0)}) {
    if (test) found.tests.push_back(*test);
  }
  found.explained =
      explained.empty() ? std::numeric_limits<double>::quiet_NaN() : Median(explained);
  return found;
}

}  // namespace pushid
