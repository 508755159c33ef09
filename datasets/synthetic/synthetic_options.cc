// datasets: what synthetic people are like, and what is wrong with options for them.
#include <algorithm>
#include <cctype>
#include <cmath>

#include "datasets/files/number_text.h"
#include "datasets/synthetic/synthetic_recordings.h"

namespace pushid {

ParameterSet<double> PublishedTailParameters() {
  ParameterSet<double> p{};
  p[kMu] = 30.0;
  p[kKpTheta] = 1800.0;
  p[kKpPhi] = 1500.0;
  p[kKdTheta] = p[kKdPhi] = 70.0;
  p[kAx] = -10.0;
  p[kTailGain] = 1.0;
  p[kTailTorque] = 0.4;
  p[kTailTime] = 0.25;
  return p;
}

ParameterSet<double> PublishedGroupParameters() {
  ParameterSet<double> p = PublishedTailParameters();
  p[kTailExponent] = 1.5;
  p[kContactStiffness] = 2800.0;
  p[kContactDistance] = 0.42;
  p[kContactKappa] = 0.58;
  p[kContactDamping] = 270.0;
  return p;
}

ParameterSet<double> PublishedStanceParameters() {
  ParameterSet<double> p{};
  p[kKpTheta] = 900.0, p[kKpPhi] = 950.0;
  p[kKdTheta] = 200.0, p[kKdPhi] = 320.0;
  p[kTailGain] = 0.3, p[kTailTime] = 0.35, p[kTailBase] = 0.4;
  p[kSupportFront] = 0.12, p[kSupportBack] = 0.08, p[kSupportSide] = 0.03;
  p[kFootFront] = 0.2;
  p[kStepGain] = 0.95, p[kStepOnset] = 0.5, p[kStepSwing] = 0.31;
  return p;
}

MaybeError CheckSyntheticOptions(const SyntheticOptions& o) {
  const auto range = [](const std::string& what, double low, double high, double min,
                        double max) -> MaybeError {
    if (low >= min && low <= high && high <= max) return {};  // false for NaN
    const std::string within = Rounded(min) + " to " + Rounded(max);
    if (!(low < high || low > high))
      return Error{what + " is " + Rounded(low) + "; it must be " + within};
    return Error{what + " from " + Rounded(low) + " to " + Rounded(high) +
                 ": must be an ascending range within " + within};
  };
  const auto one = [&range](const char* what, double value, double min, double max) {
    return range(what, value, value, min, max);
  };
  constexpr double kMany = 100000;
  if (o.strengths.empty()) return Error{"no push strengths given: name at least one"};
  for (const PushStrength& strength : o.strengths) {
    // It becomes part of ids and file names.
    const auto plain = [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '_'; };
    if (!std::all_of(strength.name.begin(), strength.name.end(), plain) || strength.name.empty()) {
      return Error{"push strength '" + strength.name + "': use letters, digits, - and _"};
    }
    if (!(std::abs(strength.acceleration) <= 100.0)) {
      return Error{"push strength '" + strength.name + "' of " +
                   std::to_string(strength.acceleration) + " m/s^2: must be within +-100"};
    }
  }
  if (o.ground == GroundKind::kFile && static_cast<int>(o.ground_poses.size()) < o.frames) {
    return Error{"the ground's file has " + std::to_string(o.ground_poses.size()) + " poses for " +
                 std::to_string(o.frames) + " frames; give one for each"};
  }
  if (o.push_start_frame > o.frames - 2) {
    return Error{"push_start_frame " + std::to_string(o.push_start_frame) +
                 " leaves no frame to push: must be at most frames - 2"};
  }
  for (const MaybeError& wrong : {one("subjects", o.subjects, 1, kMany),
                                  one("recordings_per_subject", o.recordings_per_subject, 1, kMany),
                                  one("frames", o.frames, 3, 10 * kMany),
                                  one("fps", o.fps, 1, 10000),
                                  range("mass_kg", o.min_mass_kg, o.max_mass_kg, 1, 400),
                                  range("rod_m", o.min_rod_m, o.max_rod_m, 0.1, 3),
                                  one("lean_sigma_rad", o.lean_sigma_rad, 0, 1),
                                  range("push_s", o.min_push_s, o.max_push_s, 0, 1000),
                                  one("push_start_frame", o.push_start_frame, 0, 10 * kMany),
                                  one("direction_sigma_rad", o.direction_sigma_rad, 0, 10),
                                  range("height", o.min_height, o.max_height, -1, 3),
                                  one("recording_spread", o.recording_spread, 0, 2),
                                  one("subject_spread", o.subject_spread, 0, 2),
                                  one("people_in_row", o.people_in_row, 1, o.subjects),
                                  range("spacing_m", o.min_spacing_m, o.max_spacing_m, 0.05, 100),
                                  one("sideways_sigma_m", o.sideways_sigma_m, 0, 10),
                                  one("ground_size_m", o.ground_size_m, -1, 1),
                                  one("plate_noise_m", o.plate_noise_m, 0, 0.1),
                                  one("plate_noise_n", o.plate_noise_n, 0, 1000),
                                  one("joint_noise_m", o.joint_noise_m, 0, 0.1)}) {
    if (wrong) return wrong;
  }
  return {};
}

}  // namespace pushid
