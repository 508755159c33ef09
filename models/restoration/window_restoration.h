// models: the window network, which predicts the pose at a frame from the pendulum around that
// frame. It has no memory, so that poses do not drift.
#pragma once

#include <vector>

#include "models/restoration/dense_network.h"
#include "models/restoration/restoration.h"

namespace pushid {

struct WindowWeights {
  RestorationView view = RestorationView::kPendulum;
  Scaling inputs;
  DenseNetwork network;  // outputs in m
};
void ListTensors(const std::string& prefix, WindowWeights* weights, TensorFields* fields);

class WindowRestoration : public Restoration {
 public:
  explicit WindowRestoration(WindowWeights weights) : weights_(std::move(weights)) {}
  std::string_view kind() const override { return RowOf(RestorationKind::kWindow).name; }
  std::vector<BodyMotion> Restore(const std::vector<RestorationInput>& people) const override;

 private:
  WindowWeights weights_;
};

// Inputs and outputs of the network for a person at one frame.
//
// All vectors are in the frame of the heading at frame 0; lengths in m, angles in rad. Inputs:
//   the pendulum (not with the view `pose`)
//     per lag of 0, +-2, 4, 6, 8, 12, 16, 24 frames (at 60 Hz; by time at other rates):
//       cart x, y relative to the current frame (at lag 0: to frame 0), theta, phi relative to
//       frame 0                                                                            60
//     per lag of 0, +-6, +-12: rates of x, y, theta, phi                                   20
//   the person
//     time since the push begins (at most 2 s), mass, rod length, leg length                4
//     at frame 0: theta, phi, and knees, ankles, wrists, head relative to the hip          23
//   the neighbours (`neighbours`): NeighbourInputs                                        104
//   the push (`pose`): impulse over the mass of the pushed person (x, y), m/s; its duration, s; the
//     pushed person's hip relative to one's own, at frame 0 (x, y)                          5
// Lags before the first or after the last frame use that frame. No input depends on where the
// person stands or on earlier outputs.
//
// Outputs, 63: the joints relative to the hip, minus the same at frame 0; with `pose` also the
// displacement of the hip since frame 0, 3 (otherwise the hip is at the rod's tip).

inline constexpr int kWindowPendulumInputs = 80;

int WindowInputRows(RestorationView view);
int WindowOutputRows(RestorationView view);

// The inputs of person n, a column per frame.
Eigen::MatrixXf WindowInputs(const std::vector<RestorationInput>& people, int n,
                             RestorationView view);

// The true outputs of a recorded motion (as many frames as q has, or fewer).
Eigen::MatrixXf WindowTargets(const RestorationInput& person, const BodyMotion& motion,
                              RestorationView view);

BodyMotion MotionFromOutputs(const RestorationInput& person, const Eigen::MatrixXf& outputs,
                             RestorationView view);

// The inputs from a person's neighbours.
//
// In each of four quarters (ahead, behind, left, right, between the diagonals of the heading at
// frame 0), the nearest person within 2 m at frame 0, hip to hip:
//   4 at frame 0: hip relative to one's own (x, y), m; rod length, m; nearness, exp(-(d/m)^2)
//   18 for lags of 0, +-6, +-12, 24 frames (at 60 Hz; by time at other rates): hip relative to
//     one's own, minus the same at frame 0 (x, y), m; nearness
//   4 now: velocity of the hip relative to one's own (x, y), m/s; theta and phi, rad
// Zeros in empty quarters. Hips are the tips of the rods. Mirroring exchanges left and right, and
// the order of people does not matter: of two equally near people, the one further left counts, or
// else the one further ahead.

inline constexpr int kNeighbourQuarters = 4, kNumbersPerNeighbour = 26;
inline constexpr int kNeighbourInputs = kNeighbourQuarters * kNumbersPerNeighbour;

// kNeighbourInputs x frames of q.
Eigen::MatrixXf NeighbourInputs(const std::vector<RestorationInput>& people, int n);

}  // namespace pushid
