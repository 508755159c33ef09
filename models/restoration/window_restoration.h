// models: the window network: the shape of the body at a frame from the pendulum around that frame,
// no memory of its own, so that nothing can drift.
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
// Everything in the frame of the heading at frame 0, lengths in m, angles in rad:
//   the pendulum (not with the view `pose`)
//     per lag of 0, +-2, 4, 6, 8, 12, 16, 24 frames (at 60 Hz; by time at other rates):
//       cart x, y against now (at lag 0: against frame 0), theta, phi against frame 0      60
//     per lag of 0, +-6, +-12: rates of x, y, theta, phi                                   20
//   the person
//     time since the push begins (at most 2 s), mass, rod length, leg length                4
//     of frame 0: theta, phi, and knees, ankles, wrists, head against the hip              23
//   the neighbours (`neighbours`): NeighbourInputs                                        104
//   the push (`pose`): impulse over the mass of who is pushed (x, y), m/s; its duration, s; the hip
//     of who is pushed against the person's, at frame 0 (x, y)                              5
// Lags beyond an end see the end. No number depends on where the person stands or on what the
// network said before.
//
// The output, 63: every other joint against the hip, less the same at frame 0; with `pose` also the
// way of the hip since frame 0, 3, which otherwise goes with the rod's tip.

inline constexpr int kWindowPendulumInputs = 80;

int WindowInputRows(RestorationView view);
int WindowOutputRows(RestorationView view);

// A column per frame, of person n.
Eigen::MatrixXf WindowInputs(const std::vector<RestorationInput>& people, int n,
                             RestorationView view);

// The true outputs of a recorded motion (as many frames as q has, or fewer).
Eigen::MatrixXf WindowTargets(const RestorationInput& person, const BodyMotion& motion,
                              RestorationView view);

// The motion of outputs.
BodyMotion MotionFromOutputs(const RestorationInput& person, const Eigen::MatrixXf& outputs,
                             RestorationView view);

// The inputs from a person's neighbours.
//
// The nearest at frame 0 in each of four quarters (ahead, behind, to the left, to the right,
// between the diagonals of the heading at frame 0), if anybody is there within 2 m, hip to hip:
//   at frame 0: its hip against the person's (x, y), m; its rod length, m; how near, exp(-(d/m)^2)
//   4 per lag of 0, +-6, +-12, 24 frames (at 60 Hz; by time at other rates): its hip against the
//     person's, less the same at frame 0 (x, y), m; how near 18
//   now: velocity of its hip against the person's (x, y), m/s; its theta and phi, rad 4
// Zeros where nobody is. Hips are the tips of the rods. In the mirror left and right change places
// by themselves, and the order of people changes nothing: of two just as near the one further left,
// or else ahead, counts.

inline constexpr int kNeighbourQuarters = 4, kNumbersPerNeighbour = 26;
inline constexpr int kNeighbourInputs = kNeighbourQuarters * kNumbersPerNeighbour;

// The neighbours' part of the inputs of person n: kNeighbourInputs x frames of q.
Eigen::MatrixXf NeighbourInputs(const std::vector<RestorationInput>& people, int n);

}  // namespace pushid
