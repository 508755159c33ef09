// models: what pushes people beside what is known: a filter of the pendulum with an unknown input.
//
// After the rows of a push, forces act that nobody measured. They are states of the filter: on
// everybody an Ornstein-Uhlenbeck force d that is added to all other forces,
//   d' = r d + sqrt(1 - r^2) s [M, M, M l, M l] N(0, 1),   r = exp(-dt / force_time),
// and the states are measured with errors that are correlated in time, because published motions
// are smoothed: a filter that believes each frame takes smoothing for certainty,
//   z = q + e,   e' = r_e e + sqrt(1 - r_e^2) [m, m, m / l, m / l] N(0, 1).
// The mean takes the very step of the rollout (rollout.h), with d as one more push. The covariance
// is that of the upright pendulum, in which x and theta, and y and -phi, are two planes of eight
// states each, [q, q', d, e]: it depends on the body and the gains, not on what is seen, so that a
// frame costs two small Riccati steps. People who touch have a filter each.
// Sources: Singer, IEEE Trans. Aerospace and Electronic Systems 6, 1970 (a maneuver as a correlated
// acceleration); Jazwinski, Stochastic Processes and Filtering Theory, 1970 (8.8).
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "models/process_noise.h"
#include "models/scene.h"
#include "models/step.h"

namespace pushid {

// One plane of one person.
class InputPlane {
 public:
  // damping: of the cart, N s/m; stiffness and rate: of the lean, N m/rad and N m s/rad; cross: of
  // the cart, N/rad.
  struct Gains {
    double damping = 0.0, stiffness = 0.0, rate = 0.0, cross = 0.0;
  };
  InputPlane(const Body& body, const Gains& gains, const InputNoise& noise, double dt);

  using Correction = Eigen::Matrix<double, 8, 1>;
  void Predict();
  // measured less expected places; what it moves the states by.
  Correction Update(const Eigen::Vector2d& innovation);
  const Eigen::Vector2d& input() const { return input_; }  // d
  const Eigen::Vector2d& error() const { return error_; }  // e
  double input_decay() const { return input_decay_; }      // r

 private:
  using Matrix = Eigen::Matrix<double, 8, 8>;
  Matrix step_ = Matrix::Zero(), covariance_ = Matrix::Zero();
  Correction spread_ = Correction::Zero();  // variance that a step adds
  double input_decay_ = 0.0, error_decay_ = 0.0;
  Eigen::Vector2d input_ = Eigen::Vector2d::Zero(), error_ = Eigen::Vector2d::Zero();
};

// A rollout that goes on frame by frame; with noise, corrected by what is seen. Of the past it
// keeps a window, so that a frame costs the same however many there were.
class InputFilter {
 public:
  // parameters: one set for each person. noise: none of a rollout that nothing corrects. The
  // options must outlive the filter.
  InputFilter(Scene scene, const ModelOptions& options,
              std::vector<ParameterSet<double>> parameters, const std::optional<InputNoise>& noise);

  // A force on a person until the next frame, beside the pushes of the scene.
  void Push(int person, const Vector4<double>& force);
  // The next frame, of everybody; seen: by person. Returns where the model left its domain, which
  // ends the filter.
  RolloutStatus Observe(const std::vector<PendulumState<double>>& measured,
                        const std::vector<bool>& seen);
  // The state at the last frame.
  const PendulumState<double>& state(int person) const { return path_.At(now_, person); }
  const RolloutStatus& status() const { return status_; }
  // The last frame and so many after it, with the force dying out.
  RolloutStatus Forecast(int ahead, RolloutPath<double>* path) const;
  // d, on x, y, theta and phi, N and N m.
  Vector4<double> Input(int person) const;

 private:
  // [x, theta] and [y, -phi] of a vector over q, and back.
  static Eigen::Vector2d InPlane(int plane, const Vector4<double>& q);
  static Vector4<double> FromPlanes(const Eigen::Vector2d& first, const Eigen::Vector2d& second);

  void Forget();
  // Sets how many rows are unknown from the last frame on; a step asks for the first alone.
  void SetInputs(int rows) const;

  // The model is on the heap, since its step points to its parts.
  struct Model {
    Scene scene;  // frames count from `first_`; behind the known pushes one a plane, then Push's
    std::vector<ParameterSet<double>> parameters;
    ModelStep<double> step;
    Model(Scene of, const ModelOptions& options, std::vector<ParameterSet<double>> sets)
        : scene(std::move(of)), parameters(std::move(sets)), step(scene, options, parameters) {}
  };
  std::unique_ptr<Model> model_;
  RolloutStatus status_;
  RolloutPath<double> path_;  // the window
  int first_ = 0;             // the frame at which it begins
  int now_ = 0;               // the last frame, in it
  int kept_;                  // frames that a step looks back
  size_t known_pushes_;
  std::vector<std::array<InputPlane, 2>> planes_;
};

}  // namespace pushid
