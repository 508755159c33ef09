// datasets: how well a laboratory knows what a fit takes as known, as standard deviations.
//
//   "stated_errors": {"push_scale": 0.02, "push_lag_frames": 0.5, "mass": 0.01}
#pragma once

namespace pushid {

struct JsonDocument;
class JsonFields;

// Of measured pushes (kind external): share of the force, frames between its clock and that of the
// cameras, height (m), zero of the sensor (N). Shares of masses and of the frame rate; and how far
// (m) what the cameras see may drift along the push over a recording.
struct StatedErrors {
  double push_scale = 0.05, push_lag_frames = 1.0, push_height_m = 0.05, push_zero_N = 2.0;
  double mass = 0.03, frame_rate = 0.01, drift_m = 0.005;
};

struct StatedErrorRow {
  const char* key;
  double StatedErrors::*value;
  bool share = false;  // of the quantity: at most 1
};
inline constexpr StatedErrorRow kStatedErrors[] = {
    {"push_scale", &StatedErrors::push_scale, true},
    {"push_lag_frames", &StatedErrors::push_lag_frames},
    {"push_height_m", &StatedErrors::push_height_m},
    {"push_zero_N", &StatedErrors::push_zero_N},
    {"mass", &StatedErrors::mass, true},
    {"frame_rate", &StatedErrors::frame_rate, true},
    {"drift_m", &StatedErrors::drift_m}};

// The object under "stated_errors", on top of `stated`; Fails at keys that are none of these and at
// values that are not positive.
StatedErrors ReadStatedErrors(const JsonDocument& document, JsonFields* fields,
                              StatedErrors stated);

}  // namespace pushid
