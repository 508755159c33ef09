// ident: how far a prediction may be off: bands of hip paths over time.
//
// Two things make a person leave the predicted path. The parameters are known only so well: they
// are drawn from the clustered covariance (multivariate Student's t of G - 1 degrees of freedom on
// the fitted scale) or from the bootstrap's rows, and rolled out. And no two people, nor two
// pushes, are alike, which no parameter tells: to every rollout the error path of a randomly drawn
// fitted recording is added, per impulse over mass, so that a harder push errs farther; with fewer
// than 19 of them spread by Student's t, as the largest of a few is no bound. (Without
// the second part the bands say where the *mean* person goes: held out, 90 % bands of single people
// held 83 % of the frames along the push and 68 % of those across.)
//
// The line of a band is the rollout at the estimate, which is what errors are quoted of; draws are
// moved by what their median lies beside it. (Errors of the fitted recordings do not average to
// zero where the model misses something, and paths bend where parameters are drawn: held out, the
// median itself erred by 0.133 m, the rollout by 0.101 m.)
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
