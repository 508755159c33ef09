// residuals: a recording by its likelihood under process noise: one Ceres residual block per
// recording, a Gaussian density per frame and person.
//
//   transition   of the measured velocity, one step on from the measured state:
//                v = M (qd' - qd) / dt - (F_net - C - G) ~ N(0, L L' / dt)
//                (Eq. 5 and 6 of Lyu et al., ACM MM 2021, as what they mean). Errors of the
//                measured velocities count as process noise.
//   innovation   of every measurement given all before it (models/pendulum_filter.h)
//
// Steps under a net push are no evidence: its rows were made from this very motion, by inverse
// dynamics. A filter goes through them, and their densities count as not measured.
//
//   residuals: kGaussianRows for frames 1 .. T - 1; ordered by frame, then person
//   blocks:    BlockLayout without initial velocities: a filter knows how little it knows of them
// Jacobian of transitions by jets over the acting columns; of innovations by differences of whole
// filters, good to 3e-4, which cost 12 filters for twelve parameters. Rejected: dual numbers over
// jets, exact, for a filter's covariance needs the derivatives of the step's own derivatives; they
// cost 55.
#pragma once

#include <ceres/cost_function.h>

#include <cmath>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "models/options.h"
#include "models/pendulum_filter.h"
#include "residuals/frame_residual.h"
#include "residuals/parameter_map.h"
#include "residuals/rollout_residual.h"

namespace pushid {

// The negative log likelihood of a Gaussian as squares, exactly.
//   -log N(v; 0, L L') = |L^-1 v|^2 / 2 + sum_i log L_ii + const
//   rows: L^-1 v, and sqrt(2 (log L_ii + c_i)), half of whose squares is log L_ii + c_i.
// Any shift c gives the same optimum. With c_i = 1/2 - log L_ii at the point where a problem is
// built, J'J there is the Fisher information, in expectation, so that Gauss-Newton is Fisher
// scoring and a covariance from J'J is right; but log L_ii may fall by 1/2 only before the rows
// end. Far from the optimum a larger shift lets it fall further, at a curvature that is too low; a
// solve goes on from a problem built anew. Eq. 5 of Lyu et al., ACM MM 2021, is this density.

inline constexpr double kFisherShift = 0.5;

// shift: c_i. rows: 2 N of them. False where log L_ii + c_i is no longer positive.
template <typename T, int N>
bool GaussianRows(const Eigen::Matrix<T, N, 1>& v, const Eigen::Matrix<T, N, N>& lower,
                  const double* shift, T* rows) {
  using std::log, std::sqrt;
  Eigen::Map<Eigen::Matrix<T, N, 1>> white(rows);
  white = SolveLower<T, N, 1>(lower, v);
  for (int i = 0; i < N; ++i) {
    const T log_scale = log(lower(i, i)) + shift[i];
    if (!(RealPart(log_scale) > 0.0)) return false;
    rows[N + i] = sqrt(2.0 * log_scale);
  }
  return true;
}

// Half the squared rows less this is -log N(v; 0, L L') of one v.
template <int N>
double GaussianOffset(const double* shift) {
  constexpr double kLogTwoPi = 1.8378770664093453;
  double offset = -0.5 * N * kLogTwoPi;
  for (int i = 0; i < N; ++i) offset += shift[i];
  return offset;
}

// Rows of one person in one frame.
inline constexpr int kGaussianRows = 8;

// A recording, its model and the blocks it hangs on.
struct LikelihoodProblem {
  Likelihood likelihood = Likelihood::kInnovation;
  const PendulumRecording* recording = nullptr;  // must outlive the residual
  ModelOptions options;
  ParameterMap map;
  BlockLayout layout;
  double weight = 1.0;  // on every row: the square root of how often the recording counts

  int num_densities() const { return (recording->num_frames() - 1) * recording->num_people(); }
};

LikelihoodProblem MakeLikelihoodProblem(Likelihood likelihood, const PendulumRecording& recording,
                                        const ModelOptions& options, const ParameterMap& map,
                                        double weight);

// v ~ N(0, lower lower'); where nothing was measured, v = 0 and lower = 1.
template <typename T>
struct GaussianDensity {
  Vector4<T> v = Vector4<T>::Zero();
  Matrix4<T> lower = Matrix4<T>::Identity();
  bool measured = false;
};

// By frame from frame 1 on, then person; parameters: one entry per person. A filter that leaves the
// model's domain is a failure.
RolloutStatus Densities(const LikelihoodProblem& problem,
                        const std::vector<ParameterSet<double>>& parameters,
                        std::vector<GaussianDensity<double>>* densities);

// -2 log likelihood, and of how many numbers. Infinite where the filter leaves the domain.
struct Deviance {
  double value = 0.0;
  int measured = 0;
};
Deviance DevianceOf(const LikelihoodProblem& problem,
                    const std::vector<ParameterSet<double>>& parameters);

class LikelihoodResidual : public ceres::CostFunction {
 public:
  // blocks: where the problem is built (GaussianRows). status(): whether it can be, there. fall: by
  // how much log L may fall from there.
  LikelihoodResidual(LikelihoodProblem problem, double const* const* blocks,
                     double fall = kFisherShift);
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

  const RolloutStatus& status() const { return status_; }
  // Half the squared rows of weight 1 less this is the negative log likelihood.
  double offset() const { return offset_; }
  int PersonOfRow(Eigen::Index row) const {
    return static_cast<int>(row / kGaussianRows % problem_.layout.num_people());
  }

 private:
  template <typename T>
  bool RowsOf(const std::vector<GaussianDensity<T>>& densities, std::vector<T>* rows) const;
  bool Rows(const std::vector<ParameterSet<double>>& parameters, std::vector<double>* rows) const;

  // By acting column; false where the likelihood is not defined.
  bool ByJets(const SensitivityInputs& in, RowMajorMatrix* by_acting) const;
  bool ByDifferences(const SensitivityInputs& in, const std::vector<double>& rows,
                     RowMajorMatrix* by_acting) const;

  LikelihoodProblem problem_;
  RolloutStatus status_;
  std::vector<double> shift_;  // four per density
  double offset_ = 0.0;
};

}  // namespace pushid
