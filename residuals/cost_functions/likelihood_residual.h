// residuals: a recording by its likelihood under process noise: one Ceres residual block per
// recording, a Gaussian density (gaussian_rows.h) per frame and person.
//
//   transition   of the measured velocity, one step on from the measured state:
//                v = M (qd' - qd) / dt - (F_net - C - G) ~ N(0, L L' / dt)
//                (Eq. 5 and 6 of Lyu et al., ACM MM 2021, as what they mean). Errors of the
//                measured velocities count as process noise.
//   transition_as_printed   Eq. 6 as printed: |qd' - qd - dt a - dt M^-1 L w|^2 with w drawn once.
//                Its expectation holds |M^-1 L|^2 itself and no determinant: L goes to 0.
//   innovation   of every measurement given all before it (models/pendulum_filter.h)
//
// Steps under a net push are no evidence: its rows were made from this very motion, by inverse
// dynamics. A filter goes through them, and their densities count as not measured.
//
//   residuals: kGaussianRows for frames 1 .. T - 1; ordered by frame, then person
//   blocks:    BlockLayout without initial velocities: a filter knows how little it knows of them
// Jacobian of transitions by Jets over the parameters. A filter's covariance needs the derivatives
// of the step's own derivatives: by Jets over dual numbers these are exact and cost 55 filters for
// twelve parameters; by differences of whole filters they cost 12 and are good to 3e-4. The fit
// takes differences (or Jets, with --jacobian=autodiff), the tests hold one against the other.
#pragma once

#include <ceres/cost_function.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "models/options.h"
#include "residuals/cost_functions/rollout_problem.h"
#include "residuals/gaussian_rows.h"
#include "residuals/likelihood.h"
#include "residuals/parameter_map.h"

namespace pushid {

// Of one person in one frame.
inline constexpr int kGaussianRows = 8;

// A recording, its model and the blocks it hangs on.
struct LikelihoodProblem {
  Likelihood likelihood = Likelihood::kInnovation;
  const PendulumRecording* recording = nullptr;  // must outlive the residual
  ModelOptions options;
  ParameterMap map;
  BlockLayout layout;
  std::uint64_t seed = 1;  // of what is drawn as printed
  double weight = 1.0;     // on every row: the square root of how often the recording counts

  int num_densities() const { return (recording->num_frames() - 1) * recording->num_people(); }
};

LikelihoodProblem MakeLikelihoodProblem(Likelihood likelihood, const PendulumRecording& recording,
                                        const ModelOptions& options, const ParameterMap& map,
                                        double weight, std::uint64_t seed);

// v ~ N(0, lower lower'); where nothing was measured, v = 0 and lower = 1.
template <typename T>
struct GaussianDensity {
  Vector4<T> v = Vector4<T>::Zero();
  Matrix4<T> lower = Matrix4<T>::Identity();
  bool measured = false;
};

// By frame from frame 1 on, then person; parameters: one entry per person. A filter that leaves the
// model's domain is a failure.
template <typename T>
RolloutStatus Densities(const LikelihoodProblem& problem,
                        const std::vector<ParameterSet<T>>& parameters,
                        std::vector<GaussianDensity<T>>* densities);

// -2 log likelihood, and of how many numbers. Infinite where the filter leaves the domain.
struct Deviance {
  double value = 0.0;
  int measured = 0;
};
Deviance DevianceOf(const LikelihoodProblem& problem,
                    const std::vector<ParameterSet<double>>& parameters);

class LikelihoodResidual : public ceres::CostFunction {
 public:
  // blocks: where the problem is built (gaussian_rows.h). status(): whether it can be, there. jets:
  // exact derivatives of a filter. fall: by how much log L may fall from there.
  LikelihoodResidual(LikelihoodProblem problem, double const* const* blocks, bool jets = false,
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
  bool Rows(const std::vector<ParameterSet<T>>& parameters, std::vector<T>* rows) const;

  // By column of the recording; false where the likelihood is not defined.
  bool ByJets(const std::vector<ParameterSet<double>>& values, RowMajorMatrix* jacobian) const;
  bool ByDifferences(const std::vector<ParameterSet<double>>& values,
                     const std::vector<double>& rows, RowMajorMatrix* jacobian) const;

  LikelihoodProblem problem_;
  bool jets_;
  RolloutStatus status_;
  std::vector<double> shift_;  // four per density
  double offset_ = 0.0;
};

}  // namespace pushid
