// ident: the fit repeated with other pushes, from its estimate: how far the estimates depend on
// pushes that are not known exactly, and what that adds to their errors.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/model/fitted_model.h"
#include "ident/uncertainty/refit_checks.h"

namespace pushid {

// What pushes that are not known exactly add to the errors of a fit.
//
// The fit was repeated with each variant of its pushes. Sources of error are
// independent and add up; the variants of one source stand for what it may do:
//
//   push error^2  = sum over sources of the mean over its variants of (value - estimate)^2
//   total error^2 = standard error^2 + push error^2
//
// Moves are counted from the estimate, not from the variants' mean: a recipe that moves an estimate
// one way in all its variants has moved it all the same. Variants that failed are left out.

struct PushError {
  double push = 0.0, total = 0.0;
};

// By parameter, natural units.
std::vector<PushError> PushErrors(const RefitTable& check);

// The pushes that a recording might as well have: what is uncertain about a push, as sets of
// recordings to fit again.
//
// A push made by inverse dynamics (`net`, `net_without_friction`) depends on where its window ends
// and on how the motion was smoothed, and neither is measured: it is made anew from its published
// start over windows 2 frames shorter to 4 frames longer, without smoothing and with the cubic
// smoother over kSmoothingFrames. Its kind stays; so does the friction that is taken out of a
// net_without_friction push. The window of the published length without smoothing shows how far the
// recipe itself is from the published push.
//
// A measured push (`external`) carries the noise of its sensor, white and as large as
// `sensor_noise` times the push's peak in every row; the clocks of sensor and cameras may be a
// frame apart, and the hands 0.1 m higher or lower than was said.

inline constexpr int kSmoothingFrames = 7;
inline constexpr const char* kSameWindow = "0 frames";  // neither longer nor smoothed

struct PushVariantOptions {
  double sensor_noise = 0.01;  // share of the peak, one standard deviation
  int draws = 8;               // of that noise
  uint64_t seed = 1;
};

// All recordings, with other pushes of one cause.
struct PushVariant {
  std::string source, name;
  std::vector<PendulumRecording> recordings;
};

// Errors: no push at all; a push that cannot be made anew (recording and reason).
Result<std::vector<PushVariant>> PushVariants(const std::vector<PendulumRecording>& recordings,
                                              const PushVariantOptions& options);

// Sets model->push_check; model->fit must come from Fit of these very recordings. Errors: those of
// PushVariants.
MaybeError AddPushCheck(const std::vector<PendulumRecording>& recordings,
                        const PushVariantOptions& options, int num_threads,
                        const JobProgress& progress, FittedModel* model);

}  // namespace pushid
