// ident: people, recordings and line-ups as clusters; the weight of the data; CR2.
#include "ident/uncertainty/covariance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "datasets/files/names.h"
#include "datasets/files/numeric_table.h"
#include "ident/problem/fit_problem.h"
#include "ident/problem/residual_rows.h"
#include "ident/problem/statistics.h"
#include "models/decompositions.h"
#include "residuals/plate_residual.h"

namespace pushid {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr size_t kFewestLineUps = 4;  // the scatter of fewer cannot be estimated

}  // namespace

Clusters MakeClusters(const std::vector<PendulumRecording>& recordings, ClusterBy by,
                      const std::vector<int>& counts) {
  std::map<std::string, int> times, index, line_ups;
  bool repeated = false, shared = false;
  const auto counted = [&counts](size_t i) { return counts.empty() || counts[i] > 0; };
  for (size_t i = 0; i < recordings.size(); ++i) {
    const PendulumRecording& r = recordings[i];
    if (!counted(i)) continue;
    shared = shared || r.num_people() > 1;
    for (const std::string& id : r.subject_ids) repeated = ++times[id] > 1 || repeated;
  }
  Clusters clusters;
  clusters.by = by;
  if (by == ClusterBy::kAuto) {
    clusters.by = repeated && times.size() > 1 ? ClusterBy::kSubject : ClusterBy::kRecording;
  }
  const bool people = clusters.by == ClusterBy::kSubject;
  clusters.two_way = people && shared;
  clusters.people = static_cast<int>(times.size());
  clusters.draws_people = times.size() > 1 && (people || (!repeated && !shared));
  for (size_t i = 0; i < recordings.size(); ++i) {
    const PendulumRecording& r = recordings[i];
    std::vector<int> of;
    for (int n = 0; counted(i) && n < r.num_people(); ++n) {
      const std::string key = people ? r.subject_ids[n] : std::to_string(i);
      const auto [found, added] = index.emplace(key, clusters.count());
      if (added) clusters.names.push_back(people ? key : r.id);
      of.push_back(found->second);
    }
    clusters.of.push_back(std::move(of));
    const int next = static_cast<int>(line_ups.size());
    clusters.line_up.push_back(line_ups.emplace(Joined(r.subject_ids, "\n"), next).first->second);
  }
  if (line_ups.size() < kFewestLineUps) {
    std::iota(clusters.line_up.begin(), clusters.line_up.end(), 0);
  }
  return clusters;
}

RowClusters ClusterByRecording(const ResidualRows& score) {
  RowClusters clusters;
  for (int cluster : score.cluster_of_row) {
    clusters.of_row.push_back(std::max(-1, cluster));
    clusters.count = std::max(clusters.count, cluster + 1);
  }
  return clusters;
}

Clustering ClusterRows(const FitProblem& problem, const Clusters& clusters,
                       const ResidualRows& score) {
  Clustering rows;
  rows.priors_scatter = true;
  rows.pooled_units =
      problem.map().num_deviations > 0 ? static_cast<int>(problem.NominalPoint().unit.size()) : 0;
  rows.first.count = clusters.count();
  for (size_t row = 0; row < score.cluster_of_row.size(); ++row) {
    const int recording = score.cluster_of_row[row];
    const bool none = recording < 0 || clusters.of[recording].empty();
    rows.first.of_row.push_back(none ? -1 : clusters.of[recording][score.person_of_row[row]]);
    if (!clusters.two_way) continue;
    rows.line_ups.of_row.push_back(none ? -1 : clusters.line_up[recording]);
    rows.line_ups.count = std::max(rows.line_ups.count, rows.line_ups.of_row.back() + 1);
  }
  if (clusters.by == ClusterBy::kSubject) rows.recordings = ClusterByRecording(score);
  return rows;
}

namespace {

constexpr double kLeastKept = 0.01;
constexpr double kNoLeverage = 1e-13;  // moves a score by half as much

// F of J base, with F'F that of all its rows.
Eigen::MatrixXd FewRows(const Eigen::MatrixXd& jacobian, const Eigen::MatrixXd& base) {
  std::vector<Eigen::Index> used, filled;
  for (Eigen::Index column = 0; column < jacobian.cols(); ++column) {
    if (!jacobian.col(column).isZero(0.0)) used.push_back(column);
  }
  for (Eigen::Index row = 0; row < jacobian.rows(); ++row) {
    if (!jacobian.row(row).isZero(0.0)) filled.push_back(row);
  }
  const Eigen::MatrixXd packed = jacobian(filled, used), own = base(used, Eigen::all);
  if (filled.size() <= used.size()) return packed * own;  // condensed already
  const SymmetricEigen squares = DecomposeSymmetric(packed.transpose() * packed);
  return squares.values.cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         (squares.vectors.transpose() * own);
}

// The directions of M_g = W'W that it is not zero in, and its eigenvalues there.
struct Leverage {
  Eigen::ArrayXd m;
  Eigen::MatrixXd v;  // a column each

  explicit Leverage(const Eigen::MatrixXd& w) : m(0), v(w.cols(), 0) {
    if (w.rows() == 0) return;
    const SymmetricEigen eigen = DecomposeSymmetric(w * w.transpose());
    const Eigen::ArrayXd values = eigen.values.array();
    const Eigen::Index some = (values > kNoLeverage).count();  // they ascend
    m = values.tail(some);
    v = w.transpose() * eigen.vectors.rightCols(some) * m.rsqrt().matrix().asDiagonal();
  }
};

// J_g'J_g = F_g'F_g and s_g of every cluster that has rows, in the coordinates of `base`'s columns.
// F_g has no more rows than J_g has columns that are not zero: few where units have columns of
// their own.
struct ClusterScores {
  std::vector<Eigen::MatrixXd> factors;
  Eigen::MatrixXd scores;  // a column for each
};
ClusterScores GatherScores(const ResidualRows& score, const RowClusters& clusters,
                           const Eigen::MatrixXd& base) {
  std::vector<std::vector<int>> rows(clusters.count);
  for (int row = 0; row < static_cast<int>(clusters.of_row.size()); ++row) {
    if (clusters.of_row[row] >= 0) rows[clusters.of_row[row]].push_back(row);
  }
  ClusterScores gathered;
  gathered.scores.resize(base.cols(), 0);
  for (const std::vector<int>& of_cluster : rows) {
    if (of_cluster.empty()) continue;
    const Eigen::MatrixXd plain = score.jacobian(of_cluster, Eigen::all);
    const Eigen::VectorXd residuals = score.residuals(of_cluster);
    const bool robust = score.robust_jacobian.size() > 0;
    gathered.factors.push_back(robust ? FewRows(score.robust_jacobian(of_cluster, Eigen::all), base)
                                      : FewRows(plain, base));
    gathered.scores.conservativeResize(Eigen::NoChange, gathered.scores.cols() + 1);
    gathered.scores.rightCols(1) = base.transpose() * (plain.transpose() * residuals);
  }
  return gathered;
}

struct ClusteredCovariance {
  Eigen::MatrixXd covariance;
  Eigen::VectorXd freedom;  // of each coefficient; 1 to G - 1
};
// hessian: of the cost, in the same coordinates. coefficients: rows c whose freedom is asked for.
ClusteredCovariance Cr2(const ClusterScores& scores, const Eigen::MatrixXd& hessian,
                        const Eigen::MatrixXd& coefficients) {
  const Eigen::MatrixXd root = DecomposeSymmetric(hessian).InverseSqrt();
  const Eigen::MatrixXd b = root * coefficients.transpose();  // H^-1/2 c
  const Eigen::Index groups = scores.scores.cols(), size = b.cols();
  Eigen::MatrixXd moves(hessian.rows(), groups);
  Eigen::MatrixXd own(size, groups);  // |p_g|^2
  std::vector<Eigen::MatrixXd> u;     // J_g' p_g over H^1/2, a column a coefficient
  for (Eigen::Index g = 0; g < groups; ++g) {
    const auto [m, v] = Leverage(scores.factors[static_cast<size_t>(g)] * root);
    // The share of a direction that is left without the cluster. One that a cluster alone
    // determines is counted as ten times what its score says, no more: with second derivatives in H
    // leverages may pass one.
    const Eigen::ArrayXd kept = (1.0 - m).max(kLeastKept);
    const Eigen::VectorXd score = root * scores.scores.col(g);
    const Eigen::ArrayXd along_v = (v.transpose() * score).array();
    moves.col(g) = root * (score + v * (along_v * (kept.rsqrt() - 1.0)).matrix());
    const Eigen::MatrixXd along = v.transpose() * b;
    own.col(g) = along.cwiseAbs2().transpose() * (m / kept).matrix();
    u.push_back((m / kept.sqrt()).matrix().asDiagonal() * along);
    u.back() = v * u.back();
  }
  ClusteredCovariance result;
  const double most = std::max(1.0, static_cast<double>(groups) - 1.0);
  const Eigen::MatrixXd centred = moves.colwise() - moves.rowwise().mean().eval();
  result.covariance = centred * centred.transpose();
  result.freedom.resize(size);
  for (Eigen::Index c = 0; c < size; ++c) {
    Eigen::MatrixXd at(hessian.rows(), groups);
    for (Eigen::Index g = 0; g < groups; ++g) at.col(g) = u[static_cast<size_t>(g)].col(c);
    Eigen::MatrixXd w = -at.transpose() * at;
    w.diagonal() += own.row(c).transpose();
    const double squares = w.squaredNorm();
    result.freedom[c] =
        squares > 0.0 ? std::clamp(w.trace() * w.trace() / squares, 1.0, most) : 1.0;
  }
  return result;
}

// Kinds of residuals in a frame (frame_residual.h): first component, how many, the median of
// chi-squared with so many degrees of freedom, and the kind's weight in the composite likelihood.
struct Kind {
  int first, size;
  double median, weight;
};
constexpr Kind kKinds[] = {{0, 3, 2.3660, 1.0},
                           {3, 2, 1.3863, kRateWeight},
                           {5, 2, 1.3863, kRateWeight},
                           {7, 2, 1.3863, kRateWeight}};

// Platforms (plate_residual.h): shear and the centre of pressure, counted as the hip is.
constexpr double kPlateMedian = 1.3863;
constexpr double kLeastShear = 0.5, kLeastCentre = 2e-4;  // N, m: no platform is more exact

constexpr double kNullEigenvalue = kNullSingularValue * kNullSingularValue;

// The markers' noise in a residual of each kind: a velocity is the difference of two
// positions, one frame apart, of the mean of two ankles; an angle is that of a rod. Where rates
// differ, the slowest has the least noise: one floor for all must not lie above it.
std::array<double, 4> Floors(const FitProblem& problem) {
  const double noise = problem.options().marker_noise;
  double dt = problem.recordings()[0].scene.dt;
  for (const PendulumRecording& r : problem.recordings()) dt = std::max(dt, r.scene.dt);
  return {noise, noise / dt, noise / kReferenceRod, noise / dt / kReferenceRod};
}

// lambda of covariance.h; 0 where it cannot be told. recordings: what they sum to there; empty
// where one is cut short.
double CompositeInflation(const FitProblem& problem, const FitPoint& point,
                          RecordingSums* recordings) {
  FitPoint copy = point;
  const FitProblem::Built built = problem.Build(&copy, 0);
  const ResidualRows score = EvaluateRows(built, true);
  const bool whole = built.shortened.empty() && score.jacobian.cols() <= kDenseColumns;
  *recordings = whole ? SumRows(score, point, score.RowsOfData()) : RecordingSums();
  const Eigen::MatrixXd unit = Units(FittedColumns(problem, point)).asDiagonal();
  const ClusterScores own = GatherScores(score, ClusterByRecording(score), unit);
  if (own.scores.cols() < 2) return 0.0;
  Eigen::MatrixXd data = Eigen::MatrixXd::Zero(unit.rows(), unit.cols());
  for (const Eigen::MatrixXd& factor : own.factors) data += factor.transpose() * factor;
  const Eigen::MatrixXd all = data + unit * score.InformationBeside() * unit;
  // On the subspace that the rows determine, by normal equations: exact enough for a trace.
  const SymmetricEigen eigen = DecomposeSymmetric(all);
  const Eigen::ArrayXd values = eigen.values;
  const Eigen::Index rank = (values > kNullEigenvalue * values.maxCoeff()).count();
  const Eigen::MatrixXd base =
      eigen.vectors.rightCols(rank) * values.tail(rank).sqrt().inverse().matrix().asDiagonal();
  ClusterScores inside{{}, base.transpose() * own.scores};
  for (const Eigen::MatrixXd& factor : own.factors) inside.factors.push_back(factor * base);
  // In this base H is the identity, and tr(H^-1 V_s) that of the covariance.
  const ClusteredCovariance v =
      Cr2(inside, Eigen::MatrixXd::Identity(rank, rank), Eigen::MatrixXd(0, rank));
  return v.covariance.trace() / (base.transpose() * data * base).trace();
}

}  // namespace

ResidualSigmas EstimateSigmas(const FitProblem& problem, const FitPoint& point) {
  ResidualSigmas sigmas = problem.options().sigmas;
  const std::array<double, 4> floors = Floors(problem);
  std::array<std::vector<double>, 4> squares;
  std::array<std::vector<double>, 2> of_plates;
  const ResidualsByRecording all = RawResiduals(problem, point, true);
  for (int i = 0; i < static_cast<int>(problem.recordings().size()); ++i) {
    const std::vector<double>& residuals = all[i];
    const size_t motion = problem.NumMotionRows(i);
    for (size_t row = motion; row < residuals.size(); row += kPlateResiduals) {
      const Eigen::Map<const PlateVector<double>> r(residuals.data() + row);
      if (r.isZero(0.0)) continue;
      for (int k = 0; k < 2; ++k) of_plates[k].push_back(r.segment<2>(2 * k).squaredNorm());
    }
    for (size_t row = 0; row < std::min(motion, residuals.size()); row += kFrameResiduals) {
      const Eigen::Map<const FrameVector<double>> r(residuals.data() + row);
      if (r.isZero(0.0)) continue;  // nothing was measured
      for (size_t k = 0; k < squares.size(); ++k) {
        squares[k].push_back(r.segment(kKinds[k].first, kKinds[k].size).squaredNorm());
      }
    }
  }
  const auto scale = [](const std::vector<double>& of, double median, double weight, double least,
                        double* sigma) {
    if (of.empty()) return;
    *sigma *= std::sqrt(UpperMedian(of) / median) / weight;
    *sigma = std::max(*sigma, least / weight);
  };
  double* const scales[] = {&sigmas.hip, &sigmas.velocity, &sigmas.angle, &sigmas.rate};
  for (size_t k = 0; k < squares.size(); ++k) {
    scale(squares[k], kKinds[k].median, kKinds[k].weight, floors[k], scales[k]);
  }
  scale(of_plates[0], kPlateMedian, 1.0, kLeastShear, &sigmas.shear);
  scale(of_plates[1], kPlateMedian, 1.0, kLeastCentre, &sigmas.centre);
  return sigmas;
}

double EstimateEffectiveWeight(const FitProblem& problem, const FitPoint& point,
                               RecordingSums* recordings) {
  int frames = 0, counted = 0;
  double now = 0.0;
  for (int i = 0; i < static_cast<int>(problem.recordings().size()); ++i) {
    if (problem.Count(i) == 0) continue;
    const int own = std::max(1, problem.recordings()[i].num_frames() - 1);
    frames += own;
    now += own * problem.Weight(i, 0) * problem.Weight(i, 0);
    ++counted;
  }
  const double one_each = static_cast<double>(counted) / frames;
  if (counted < 2) return one_each;
  const double lambda = CompositeInflation(problem, point, recordings);
  // A frame weighs at most one if the fit estimates its sigmas: more would undo the markers' noise.
  const bool own = EstimatesSigmas(problem.options()), told = lambda > 0.0;
  const double estimate = now / frames / lambda;
  const double weight = !told ? one_each : own ? std::min(1.0, estimate) : estimate;
  const double before = problem.options().effective_weight;
  if (told && before > 0.0) {
    recordings->Scale(weight / before);
  } else {  // recordings did not weigh alike
    *recordings = {};
  }
  return weight;
}

namespace {

// By recordings, one way or two, priors and pooled units. Empty with fewer than two clusters.
// inverse_hessian: in the columns as they came.
Scatter ClusteredScatter(const ResidualRows& score, const Clustering& clustering,
                         const Eigen::MatrixXd& back, const Eigen::MatrixXd& hessian,
                         const Eigen::MatrixXd& inverse_hessian) {
  Scatter scatter;
  if (clustering.first.count < 2) return scatter;
  const ClusterScores first = GatherScores(score, clustering.first, back);
  if (first.scores.cols() < 2) return scatter;
  auto [inner, freedom] = Cr2(first, hessian, back);
  if (clustering.line_ups.count > 0) {
    const ClusteredCovariance two = Cr2(GatherScores(score, clustering.line_ups, back), hessian,
                                        Eigen::MatrixXd(0, back.cols()));
    RowClusters both;  // pairs that occur
    std::map<std::pair<int, int>, int> index;
    for (size_t row = 0; row < clustering.first.of_row.size(); ++row) {
      const std::pair pair(clustering.first.of_row[row], clustering.line_ups.of_row[row]);
      const int next = static_cast<int>(index.size());
      both.of_row.push_back(pair.first < 0 ? -1 : index.emplace(pair, next).first->second);
    }
    both.count = static_cast<int>(index.size());
    const Eigen::MatrixXd moves = SolveSymmetric(hessian, GatherScores(score, both, back).scores);
    // The difference need not be positive: negative eigenvalues become zero.
    const auto [values, v] = DecomposeSymmetric(inner + two.covariance - moves * moves.transpose());
    inner.noalias() = v * values.cwiseMax(0.0).asDiagonal() * v.transpose();
    // As the fewer of the two have.
    freedom = freedom.cwiseMin(std::max(1.0, clustering.line_ups.count - 1.0)).eval();
  }
  scatter.parts.push_back({back * inner * back.transpose(), freedom});
  const auto add = [&](int cluster, double known) {
    scatter.Add(inverse_hessian * score.Information(score.RowsOf(cluster)) * inverse_hessian,
                known);
  };
  if (clustering.priors_scatter) add(FitProblem::kPriorCluster, kInfinite);
  if (clustering.pooled_units > 1) add(FitProblem::kPoolingCluster, clustering.pooled_units - 1.0);
  return scatter;
}

}  // namespace

RecordingSums SumRows(const ResidualRows& score, const FitPoint& point,
                      const std::vector<int>& rows) {
  const std::vector<double> at = point.Flat();
  return {Eigen::VectorXd::Map(at.data(), score.jacobian.cols()),
          score.residuals(rows).squaredNorm(),
          {score.Information(rows), score.Gradient(rows)}};
}

double SingularDirections::Condition() const {
  return rank > 0 ? singular[0] / singular[rank - 1] : kInfinite;
}

SingularDirections Decompose(const Eigen::MatrixXd& jacobian, double null_value) {
  // By the triangle of a QR decomposition: rows are many, columns few.
  const RightSingular svd =
      DecomposeRight(jacobian.rows() >= jacobian.cols() ? Triangle(jacobian) : jacobian);
  SingularDirections directions{svd.values, svd.vectors, 0};
  const Eigen::VectorXd& singular = directions.singular;
  while (directions.rank < singular.size() &&
         singular[directions.rank] > null_value * singular[0]) {
    ++directions.rank;
  }
  return directions;
}

Covariance ComputeCovariance(const ResidualRows& score, const Eigen::VectorXd& unit,
                             const Clustering& clustering, double null_value) {
  Covariance c;
  c.directions = Decompose(score.jacobian * unit.asDiagonal(), null_value);
  const int rank = c.directions.rank;
  double sum = 0.0;
  for (int row = 0; row < score.residuals.size(); ++row) {
    if (score.cluster_of_row[row] >= 0) sum += score.residuals[row] * score.residuals[row];
  }
  c.naive_freedom = std::max(1, score.num_data_rows - rank);
  c.sigma = std::sqrt(sum / c.naive_freedom);

  // In the base of the identified directions, then back to the columns as they came. Rows of data
  // scatter by sigma; priors and demands are in units of their own.
  const Eigen::MatrixXd back = unit.asDiagonal() * c.directions.v.leftCols(rank);
  const Eigen::VectorXd squared = c.directions.singular.head(rank).cwiseAbs2();
  const Eigen::MatrixXd beside = back.transpose() * score.InformationBeside() * back;
  const Eigen::MatrixXd data = Eigen::MatrixXd(squared.asDiagonal()) - beside;
  const Eigen::MatrixXd moves = back * squared.cwiseInverse().asDiagonal();
  c.naive = moves * (c.sigma * c.sigma * data + beside) * moves.transpose();

  const std::vector<int> prior = score.RowsOf(FitProblem::kPriorCluster);
  const std::vector<int> settling = score.RowsOf(FitProblem::kSettlingCluster);
  c.by_data = score.robust_jacobian.size() > 0
                  ? Eigen::MatrixXd(score.robust_jacobian.transpose() * score.robust_jacobian)
                  : score.Information(score.RowsOfData());
  c.by_prior = score.Information(prior);
  c.by_settling = score.Information(settling);
  c.by_pooling = score.Information(score.RowsOf(FitProblem::kPoolingCluster)) +
                 score.Information(score.RowsOf(FitProblem::kNetworkCluster));
  c.prior_gradient = score.Gradient(prior);
  c.settling_gradient = score.Gradient(settling);
  Eigen::MatrixXd hessian =
      back.transpose() * (c.by_data + c.by_prior + c.by_settling + c.by_pooling) * back;
  c.inverse_of_parts = back * SolveSymmetric(hessian, Eigen::MatrixXd(back.transpose()));
  if (score.curvature.size() > 0) {
    const Eigen::MatrixXd full =
        Eigen::MatrixXd(squared.asDiagonal()) + back.transpose() * score.curvature * back;
    c.full_hessian = IsPositiveDefinite(full);
    if (c.full_hessian) {
      hessian = full;
      c.curvature = score.curvature;
    }
  }
  c.inverse_hessian = back * SolveSymmetric(hessian, Eigen::MatrixXd(back.transpose()));
  c.scatter = ClusteredScatter(score, clustering, back, hessian, c.inverse_hessian);
  if (clustering.recordings.count > 1) {
    const Clustering by_recording{
        clustering.recordings, {}, clustering.pooled_units, clustering.priors_scatter};
    c.these = ClusteredScatter(score, by_recording, back, hessian, c.inverse_hessian);
  }
  if (score.clusters.size() < 2) return c;
  c.recordings = score.clusters;
  const double groups = static_cast<double>(score.clusters.size());
  c.moves.resize(c.inverse_hessian.cols(), score.clusters.size());
  for (size_t g = 0; g < score.clusters.size(); ++g) {
    const Eigen::VectorXd gradient = score.Gradient(score.RowsOf(score.clusters[g]));
    c.moves.col(g) = groups / (groups - 1.0) * c.inverse_hessian * gradient;
  }
  return c;
}

void Scatter::Add(const Eigen::MatrixXd& covariance, double freedom) {
  parts.push_back({covariance, Eigen::VectorXd::Constant(covariance.rows(), freedom)});
}

Eigen::MatrixXd Scatter::Covariance() const {
  Eigen::MatrixXd sum;
  for (const Part& part : parts) {
    sum = sum.size() == 0 ? part.covariance : Eigen::MatrixXd(sum + part.covariance);
  }
  return sum;
}

ScatterOf Scatter::Of(const Eigen::VectorXd& coefficients) const {
  constexpr double kNormal95 = 1.959963984540054;
  constexpr double kMatters = 1e-6;  // of the variance
  const auto quantile = [](double freedom) {
    return std::isfinite(freedom) ? StudentQuantile95(freedom) : kNormal95;
  };
  std::vector<double> variances, freedoms;
  double sum = 0.0, squared_width = 0.0;
  for (const Part& part : parts) {
    const Eigen::ArrayXd own =
        (coefficients.array() != 0.0).select(part.freedom.array(), kInfinite);
    variances.push_back(std::max(0.0, coefficients.dot(part.covariance * coefficients)));
    freedoms.push_back(own.minCoeff());
    const double t = quantile(freedoms.back());
    sum += variances.back();
    squared_width += t * t * variances.back();
  }
  ScatterOf of;
  of.standard_error = std::sqrt(sum);
  of.freedom = parts.empty() ? 1.0 : kInfinite;
  for (size_t k = 0; k < parts.size(); ++k) {
    if (variances[k] >= kMatters * sum) of.freedom = std::min(of.freedom, freedoms[k]);
  }
  of.quantile = sum > 0.0 ? std::sqrt(squared_width / sum) : quantile(of.freedom);
  return of;
}

ScatterOf Scatter::OfColumn(Eigen::Index column) const {
  return Of(Eigen::VectorXd::Unit(parts.empty() ? column + 1 : parts[0].covariance.rows(), column));
}

}  // namespace pushid
