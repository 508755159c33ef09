// models: what LDP's chain of conditional variational autoencoders sees and says, frame by frame.
//
// A frame of the lower body has 111 numbers, of the upper body 171, both in the frame of the
// heading at frame 0 and at 60 Hz:
//   way of the hip since the frame before (x, y), m                         2
//   change of the facing direction since the frame before, rad              1
//   joint positions, m                                                      3 per joint
//   their change since the frame before, m/s                                3 per joint
//   joint rotations against frame 0 (skeleton_fit.h), six numbers           6 per joint
// The pendulum of a frame has 15: cart x, y against frame 0, theta, phi, end of the rod against the
// hip at frame 0 (3), rod length, and the changes of x, y, theta, phi and end of rod since the
// frame before.
//
// Coordinates of the positions: `ldp`, as published, against the hip at frame 0, so that the
// network itself carries the hip, which drifts; `tip` (default), against the hip of the same frame,
// which is put at the rod's tip. Rotations are fitted to positions: recordings are read as
// positions.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "models/restoration/restoration.h"

namespace pushid {

enum class CvaeCoordinates { kTip, kLdp };
const char* Name(CvaeCoordinates coordinates);  // "tip", "ldp"
std::optional<CvaeCoordinates> CvaeCoordinatesFromName(std::string_view name);

inline constexpr int kLowerFrame = 3 + 12 * static_cast<int>(kLowerJoints.size());
inline constexpr int kUpperFrame = 3 + 12 * static_cast<int>(kUpperJoints.size());
inline constexpr int kLowerPositions = 3 * static_cast<int>(kLowerJoints.size());
inline constexpr int kUpperCondition = kUpperFrame + kLowerPositions;
inline constexpr int kPendulumFrame = 15;
inline constexpr double kCvaeRate = 60.0;  // Hz
static_assert(kLowerFrame == 111 && kUpperFrame == 171 && kUpperCondition == 198);

// A column per frame. person and motion at 60 Hz (Resampled).
Eigen::MatrixXf PendulumFrames(const RestorationInput& person);
struct BodyFrames {
  Eigen::MatrixXf lower, upper;
};
BodyFrames FramesOf(const RestorationInput& person, const BodyMotion& motion,
                    CvaeCoordinates coordinates);

// Back from frames to the world; the hip is at the rod's tip in `tip` coordinates.
BodyMotion MotionFromFrames(const RestorationInput& person, const BodyFrames& frames,
                            CvaeCoordinates coordinates);

// The same person at another rate, by linear interpolation; unchanged where the rates agree.
RestorationInput Resampled(const RestorationInput& person, double dt);
// `frames` poses at dt of a motion at motion_dt.
BodyMotion Resampled(const BodyMotion& motion, double motion_dt, double dt, int frames);

}  // namespace pushid
