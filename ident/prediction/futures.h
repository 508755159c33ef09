// ident: how far a prediction may be off: bands of hip paths over time.
//
// A person leaves the predicted path for two reasons. First, the parameters are uncertain: they are
// drawn from the clustered covariance (multivariate Student's t with G - 1 degrees of freedom on
// the fitted scale) or from the rows of a bootstrap, and rolled out. Second, no two people and no
// two pushes are alike: to each rollout the error path of a randomly drawn fitted recording is
// added, in proportion to the impulse over mass. If there are fewer than 19 error paths, they are
// spread by Student's t, because the largest of a few is no bound. (Without the second part the
// bands are those of the *mean* person: held-out 90 % bands of single people held 83 % of the
// frames along the push and 68 % of those across.)
//
// The middle of a band is the rollout at the estimate, which reported errors refer to; the draws
// are shifted so that it is their median. (Errors of the fitted recordings do not average to zero
// if the model misses something, and paths are nonlinear in the parameters: the unshifted median
// erred by 0.133 m on held-out recordings, the rollout by 0.101 m.)
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ident/model/fitted_model.h"
#include "ident/prediction/prediction.h"
#include "ident/uncertainty/bootstrap.h"

namespace pushid {

// Hip (m), theta and phi (rad) at one frame.
using BandPoint = Eigen::Matrix<double, 5, 1>;
using DrawnPaths = std::vector<std::vector<std::vector<BandPoint>>>;  // [draw][person][frame]

// Quantiles by frame; the middle is the rollout.
struct PathBand {
  std::vector<BandPoint> lower90, lower50, middle, upper50, upper90;
};

struct PredictiveBands {
  std::string id;
  int samples = 0, failed = 0;   // rollouts that left the domain are in no band
  std::vector<PathBand> people;  // empty when every rollout failed
};

struct BandOptions {
  int samples = 200;
  uint64_t seed = 1;
  // Parameters are drawn from its replicas, of which there must be some; null: from the covariance.
  const Bootstrap* bootstrap = nullptr;
};

// Parameter sets, natural units.
std::vector<ParameterSet<double>> SampleParameters(const FitResult& result,
                                                   const BandOptions& options);

// The model with other shared values; units keep their deviation from them on the fitted scale.
IdentifiedModel WithShared(const IdentifiedModel& model, const ParameterSet<double>& shared);

// The pushed person's error: measured less predicted, over impulse per mass, frame by frame.
struct ErrorPath {
  std::string recording;
  std::vector<BandPoint> path;
};
std::vector<ErrorPath> ErrorPaths(const FitResult& result,
                                  const std::vector<PendulumRecording>& fitted);

// The value in every draw.
std::vector<double> ValuesAt(const DrawnPaths& draws, int person, size_t frame, int axis);

// Rollouts that left the domain are missing. num_frames: 0 means as many as the recording has.
// errors: empty for paths of the parameters alone. A recording's own path is no guess about it and
// is left out.
DrawnPaths DrawPaths(const FitResult& result, const std::vector<ParameterSet<double>>& samples,
                     const std::vector<ErrorPath>& errors, const PendulumRecording& recording,
                     uint64_t seed, int num_frames = 0);
// The paths that bands are quantiles of: their median is the rollout at the estimate.
DrawnPaths PathsAround(const FitResult& result, const std::vector<ParameterSet<double>>& samples,
                       const std::vector<ErrorPath>& errors, const PendulumRecording& recording,
                       uint64_t seed);

PredictiveBands ComputeBands(const FitResult& result,
                             const std::vector<ParameterSet<double>>& samples,
                             const std::vector<ErrorPath>& errors,
                             const PendulumRecording& recording, uint64_t seed);

}  // namespace pushid
