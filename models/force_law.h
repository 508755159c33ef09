// models: a force law that a user of the library brings: a generalized force [N, N, N m, N m] that
// depends on a person's own state and on parameters of its own.
//
// The interface is in doubles, so that the library needs no template of its user's; the rollout,
// whatever its scalar, chains its derivatives through value and Jacobian. A law is seldom derived
// by hand: MakeForceLaw (residuals/autodiff_force_law.h) makes one from a templated functor. It
// acts where balance and the linear terms act (step.h), counts as the person's own force
// (learned_terms.h, free modes), and is the part "own" of the net force, together with other such
// laws.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "models/ipm.h"
#include "models/jet.h"
#include "models/options.h"
#include "models/parameters.h"

namespace pushid {

// The person as a law may see it besides the state; constant over a rollout.
struct LawPerson {
  Body body;
  Eigen::Vector2d posture = Eigen::Vector2d::Zero();  // reference (theta, phi), rad
};

class ForceLaw {
 public:
  static constexpr int kMostInputs = 8 + kNumOwnParameters;
  using Inputs = Eigen::Matrix<double, kMostInputs, 1>;  // q, qd, then the law's parameters
  using Jacobian = Eigen::Matrix<double, 4, kMostInputs>;

  // name: what a model file says was fitted. At most kNumOwnParameters parameters.
  ForceLaw(std::string name, std::vector<ParameterFacts> parameters)
      : name_(std::move(name)), parameters_(std::move(parameters)) {}
  virtual ~ForceLaw() = default;

  const std::string& name() const { return name_; }
  const std::vector<ParameterFacts>& parameters() const { return parameters_; }
  int num_inputs() const { return 8 + static_cast<int>(parameters_.size()); }

  // The force; its derivatives by the first num_inputs() inputs unless null. Zero at rest, or the
  // posture does not hold; smooth there, or there are no free modes.
  virtual Vector4<double> Force(const LawPerson& person, const Inputs& inputs,
                                Jacobian* jacobian) const = 0;

  // The force in any scalar; own: the law's parameters.
  template <typename T>
  Vector4<T> Chain(const LawPerson& person, const PendulumState<T>& state, const T* own) const;

 private:
  // Adds the second derivatives' share, of which a Jacobian that carries derivatives is made, by
  // central differences of the Jacobian.
  template <typename T>
  void AddCurvature(const LawPerson& person, const Inputs& at, const T* apart,
                    Vector4<T>* force) const;

  std::string name_;
  std::vector<ParameterFacts> parameters_;
};

inline int NumOwnParameters(const ModelOptions& options) {
  int count = 0;
  for (const auto& law : options.own_laws) count += static_cast<int>(law->parameters().size());
  return count;
}

template <typename T>
Vector4<T> ForceLaw::Chain(const LawPerson& person, const PendulumState<T>& state,
                           const T* own) const {
  Inputs at = Inputs::Zero();
  const int size = num_inputs();
  const auto input = [&](int i) -> const T& {
    return i < 4 ? state.q[i] : i < 8 ? state.qd[i - 4] : own[i - 8];
  };
  for (int i = 0; i < size; ++i) at[i] = RealPart(input(i));
  if constexpr (DerivativeOrder<T>::value == 0) {
    return Force(person, at, nullptr);
  } else {
    Jacobian jacobian;
    const Vector4<double> value = Force(person, at, &jacobian);
    T apart[kMostInputs];
    for (int i = 0; i < size; ++i) apart[i] = input(i) - T(at[i]);
    Vector4<T> force;
    for (int row = 0; row < 4; ++row) {
      force[row] = T(value[row]);
      for (int i = 0; i < size; ++i) force[row] += T(jacobian(row, i)) * apart[i];
    }
    if constexpr (DerivativeOrder<T>::value > 1) AddCurvature(person, at, apart, &force);
    return force;
  }
}

template <typename T>
void ForceLaw::AddCurvature(const LawPerson& person, const Inputs& at, const T* apart,
                            Vector4<T>* force) const {
  constexpr double kDifference = 1e-5;
  const int size = num_inputs();
  for (int i = 0; i < size; ++i) {
    const double step = kDifference * std::max(1.0, std::abs(at[i]));
    Inputs moved = at;
    Jacobian above, below;
    moved[i] = at[i] + step;
    Force(person, moved, &above);
    moved[i] = at[i] - step;
    Force(person, moved, &below);
    for (int row = 0; row < 4; ++row) {
      for (int j = 0; j < size; ++j) {
        const double second = (above(row, j) - below(row, j)) / (2.0 * step);
        if (second != 0.0) (*force)[row] += T(0.5 * second) * apart[i] * apart[j];
      }
    }
  }
}

}  // namespace pushid
