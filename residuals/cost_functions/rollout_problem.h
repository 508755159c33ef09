// residuals: the rows of a rollout (rollout_residual.h), one frame and person after the other, with
// their derivatives by acting columns (parameter_map.h).
//
// Derivatives come from jets (jets/autodiff_rollout.h), whatever the model. One kind of recording
// has derivatives written out: people alone whose feet slide, eight side by side (lane_tables.h),
// with which a whole fit takes less than half of the time (tests/studies/speed.py derivatives).
#pragma once

#include <functional>

#include "residuals/jets/autodiff_rollout.h"
#include "residuals/rollout_residual.h"

namespace pushid {

// Rows of one frame of one person by acting column, padded as SensitivityInputs says.
using FrameRows = Eigen::Matrix<double, kFrameResiduals, Eigen::Dynamic, Eigen::RowMajor>;

enum class Derivatives {
  kNone,
  kHeldWeights,  // by all but the weights of what is learned
  kAll
};

// What Ceres asks of the blocks of a recording.
Derivatives WantedDerivatives(const RolloutProblem& problem, double** jacobians);

// The path at the given blocks.
RolloutStatus RollOut(const RolloutProblem& problem, double const* const* blocks,
                      RolloutPath<double>* path);

using FrameVisitor = std::function<void(int frame, int person, const FrameVector<double>& residual,
                                        FrameRows* by_column)>;

using PlateRows = Eigen::Matrix<double, kPlateResiduals, Eigen::Dynamic, Eigen::RowMajor>;
using PlateVisitor = std::function<void(int frame, int person, const PlateVector<double>& residual,
                                        PlateRows* by_column)>;

// Visits the residuals of a rollout, frame by frame from frame 1 on, then person by person. The
// visitor may change the rows, which exist only with derivatives. plates: visits those of
// platforms next, from frame 0 on; null: they are left out.
RolloutStatus VisitFrames(const RolloutProblem& problem, double const* const* blocks,
                          Derivatives derivatives, const FrameVisitor& visit,
                          const PlateVisitor& plates = nullptr);

// The residuals alone, problem.num_residuals() of them; false outside the model's domain.
bool RolloutResiduals(const RolloutProblem& problem, double const* const* blocks,
                      double* residuals);

}  // namespace pushid
