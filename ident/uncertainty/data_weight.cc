// ident: robust scales of residuals, and the composite likelihood's adjustment.
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "ident/problem/fit_problem.h"
#include "ident/problem/residual_rows.h"
#include "ident/solver/structured_secants.h"
#include "ident/uncertainty/clusters.h"
#include "ident/uncertainty/covariance.h"
#include "models/decompositions.h"
#include "residuals/cost_functions/plate_residual.h"

namespace pushid {
namespace {

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

// Of platforms (plate_residual.h): shear and the centre of pressure, counted as the hip is.
constexpr double kPlateMedian = 1.3863;
constexpr double kLeastShear = 0.5, kLeastCentre = 2e-4;  // N, m: no platform is more exact

constexpr double kNullEigenvalue = kNullSingularValue * kNullSingularValue;

double Median(std::vector<double>* values) {
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

// What the markers' noise makes of a residual of each kind: a velocity is the difference of two
// positions, one frame apart, of the mean of two ankles; an angle is that of a rod. Where rates
// differ, the slowest has the least noise: one floor for all must not lie above it.
std::array<double, 4> Floors(const FitProblem& problem) {
  const double noise = problem.options().marker_noise;
  double dt = problem.recordings()[0].scene.dt;
  for (const PendulumRecording& r : problem.recordings()) dt = std::max(dt, r.scene.dt);
  return {noise, noise / dt, noise / kReferenceRod, noise / dt / kReferenceRod};
}

// lambda of clusters.h; 0 where it cannot be told. recordings: what they sum to there; empty where
// one is cut short.
double CompositeInflation(const FitProblem& problem, const FitPoint& point,
                          RecordingSums* recordings) {
  FitPoint copy = point;
  const FitProblem::Built built = problem.Build(&copy, 0);
  const ResidualRows score = EvaluateRows(built, true);
  const bool whole = built.shortened.empty() && score.jacobian.cols() <= kDenseColumns;
  *recordings = whole ? SumRecordings(score, point) : RecordingSums();
  const Eigen::MatrixXd unit = Units(FittedColumns(problem, point)).asDiagonal();
  const ClusterScores own = GatherScores(score, ClusterByRecording(score), unit);
  if (own.scores.cols() < 2) return 0.0;
  Eigen::MatrixXd data = Eigen::MatrixXd::Zero(unit.rows(), unit.cols());
  for (const Eigen::MatrixXd& factor : own.factors) data += factor.transpose() * factor;
  const Eigen::MatrixXd all = data + unit * InformationBeside(score) * unit;
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
  double* const scales[] = {&sigmas.hip, &sigmas.velocity, &sigmas.angle, &sigmas.rate};
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
  for (size_t k = 0; k < squares.size(); ++k) {
    if (squares[k].empty()) continue;
    *scales[k] *= std::sqrt(Median(&squares[k]) / kKinds[k].median) / kKinds[k].weight;
    *scales[k] = std::max(*scales[k], floors[k] / kKinds[k].weight);
  }
  double* const plate_scales[] = {&sigmas.shear, &sigmas.centre};
  constexpr double kLeast[] = {kLeastShear, kLeastCentre};
  for (int k = 0; k < 2; ++k) {
    if (of_plates[k].empty()) continue;
    *plate_scales[k] *= std::sqrt(Median(&of_plates[k]) / kPlateMedian);
    *plate_scales[k] = std::max(*plate_scales[k], kLeast[k]);
  }
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
  if (!(lambda > 0.0)) {
    *recordings = {};
    return one_each;
  }
  // By its own sigmas no frame is worth more than one: that would undo the markers' noise.
  const bool own = EstimatesSigmas(problem.options());
  const double weight = own ? std::min(1.0, now / frames / lambda) : now / frames / lambda;
  const double before = problem.options().effective_weight;
  if (!(before > 0.0)) {  // recordings did not weigh alike
    *recordings = {};
    return weight;
  }
  recordings->squares *= weight / before;
  recordings->sums.information *= weight / before;
  recordings->sums.gradient *= weight / before;
  return weight;
}

}  // namespace pushid
