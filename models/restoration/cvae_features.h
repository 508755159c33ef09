// models: what LDP's chain of conditional variational autoencoders sees and says, frame by frame.
//
// A frame of the lower body has 111 numbers, of the upper body 171, of both in one network 267, all
// in the frame of the heading at frame 0 and at 60 Hz:
//   way of the hip since the frame before (x, y), m                         2
//   change of the facing direction since the frame before, rad              1
//   joint positions, m                                                      3 per joint
//   their change since the frame before, m/s                                3 per joint
//   joint rotations against frame 0 (FitSkeleton), six numbers             6 per joint
// The pendulum of a frame has 15: cart x, y against frame 0, theta, phi, end of the rod against the
// hip at frame 0 (3), rod length, and the changes of x, y, theta, phi and end of rod since the
// frame before.
//
// Coordinates of the positions: `ldp`, as published, against the hip at frame 0, so that the
// network itself carries the hip, which drifts; `tip` (default), against the hip of the same frame,
// which is put at the rod's tip. Rotations are fitted to positions: recordings are read as
// positions.
#pragma once

#include <algorithm>
#include <vector>

#include "models/enum_names.h"
#include "models/restoration/restoration.h"

namespace pushid {

enum class CvaeCoordinates { kTip, kLdp };
constexpr EnumNames<CvaeCoordinates, 2> Names(CvaeCoordinates) {
  return {{{"tip", CvaeCoordinates::kTip}, {"ldp", CvaeCoordinates::kLdp}}};
}

// What the chain is made of; to leave parts of LDP's out is to see what they are worth.
struct CvaeLayout {
  CvaeCoordinates coordinates = CvaeCoordinates::kTip;
  bool pendulum = true;  // false: the next pose from the pose alone; the network carries the hip
  bool halves = true;    // false: one network for all joints, in the place of the lower body's
  bool sigma = true;     // false: samplers of earlier versions, of which only the mean was kept

  const std::vector<int>& LowerJoints() const;
  const std::vector<int>& UpperJoints() const;  // none without halves
  int LowerFrame() const { return FrameSize(LowerJoints()); }
  int UpperFrame() const { return halves ? FrameSize(UpperJoints()) : 0; }
  int LowerPositions() const { return 3 * static_cast<int>(LowerJoints().size()); }
  int UpperPositions() const { return 3 * static_cast<int>(UpperJoints().size()); }
  int UpperCondition() const { return halves ? UpperFrame() + LowerPositions() : 0; }
  int PendulumFrame() const;  // 15 or 0
  // Where positions are measured from: without a pendulum there is no tip.
  CvaeCoordinates Origin() const { return pendulum ? coordinates : CvaeCoordinates::kLdp; }

 private:
  static int FrameSize(const std::vector<int>& joints) {
    return 3 + 12 * static_cast<int>(joints.size());
  }
};

inline constexpr int kPendulumFrame = 15;
inline constexpr double kCvaeRate = 60.0;  // Hz

// A column per frame. person and motion at 60 Hz (Resampled).
Eigen::MatrixXf PendulumFrames(const RestorationInput& person, const CvaeLayout& layout);
struct BodyFrames {
  Eigen::MatrixXf lower, upper;  // upper: no rows without halves
};
BodyFrames FramesOf(const RestorationInput& person, const BodyMotion& motion,
                    const CvaeLayout& layout);

// Back from frames to the world; the hip is at the rod's tip in `tip` coordinates.
BodyMotion MotionFromFrames(const RestorationInput& person, const BodyFrames& frames,
                            const CvaeLayout& layout);

// `frames` values at dt, by linear interpolation between values at from_dt; the last goes on.
template <typename Value>
std::vector<Value> ResampledPath(const std::vector<Value>& values, double from_dt, double dt,
                                 int frames) {
  std::vector<Value> other;
  for (int t = 0; t < frames; ++t) {
    const double at = std::clamp(t * dt / from_dt, 0.0, static_cast<double>(values.size() - 1));
    const size_t low = static_cast<size_t>(at), high = std::min(low + 1, values.size() - 1);
    const double share = at - static_cast<double>(low);
    other.push_back((1.0 - share) * values[low] + share * values[high]);
  }
  return other;
}

// The same person at another rate, by linear interpolation; unchanged where the rates agree.
RestorationInput Resampled(const RestorationInput& person, double dt);
// `frames` poses at dt of a motion at motion_dt.
BodyMotion Resampled(const BodyMotion& motion, double motion_dt, double dt, int frames);

}  // namespace pushid
