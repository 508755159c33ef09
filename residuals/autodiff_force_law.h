// residuals: a user's own force law from a templated functor, its derivatives by Jets.
//
//   struct Drag {  // F_x = -M d xd |xd|
//     template <typename T>
//     Vector4<T> operator()(const LawPerson& person, const PendulumState<T>& s, const T* p) const {
//       Vector4<T> force = Vector4<T>::Zero();
//       force[0] = -person.body.mass * p[0] * s.qd[0] * sqrt(s.qd[0] * s.qd[0] + 1e-6);
//       return force;
//     }
//   };
//   const auto drag = MakeForceLaw("drag", {{"drag", "d", "1/m", 0.1, 0.0, 5.0, 0.1}}, Drag{});
//   AddForceLaw(drag, &options.model, &options.table);  // ident/parameters/parameter_table.h
// The whole example, with a fit, is tests/install/consumer/own_law.cc.
#pragma once

#include <ceres/jet.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "models/force_law.h"

namespace pushid {

// Functor: Vector4<T> operator()(const LawPerson&, const PendulumState<T>&, const T* own) const.
// kOwn: how many parameters it has.
template <typename Functor, int kOwn>
class AutoDiffForceLaw : public ForceLaw {
  static_assert(kOwn <= kNumOwnParameters, "more parameters than there are slots for");

 public:
  AutoDiffForceLaw(std::string name, std::vector<ParameterFacts> parameters, Functor functor)
      : ForceLaw(std::move(name), std::move(parameters)), functor_(std::move(functor)) {}

  Vector4<double> Force(const LawPerson& person, const Inputs& inputs,
                        Jacobian* jacobian) const override {
    if (jacobian == nullptr) return Evaluate<double>(person, inputs);
    using Jet = ceres::Jet<double, 8 + kOwn>;
    Eigen::Matrix<Jet, 8 + kOwn, 1> jets;
    for (int i = 0; i < 8 + kOwn; ++i) jets[i] = Jet(inputs[i], i);
    const Vector4<Jet> force = Evaluate<Jet>(person, jets);
    Vector4<double> value;
    for (int row = 0; row < 4; ++row) {
      value[row] = force[row].a;
      jacobian->row(row).template head<8 + kOwn>() = force[row].v.transpose();
    }
    return value;
  }

 private:
  template <typename T, typename Vector>
  Vector4<T> Evaluate(const LawPerson& person, const Vector& inputs) const {
    PendulumState<T> state;
    state.q = inputs.template head<4>();
    state.qd = inputs.template segment<4>(4);
    return functor_(person, state, inputs.data() + 8);
  }

  Functor functor_;
};

template <int kOwn, typename Functor>
std::shared_ptr<const ForceLaw> MakeForceLaw(std::string name,
                                             const ParameterFacts (&parameters)[kOwn],
                                             Functor functor) {
  return std::make_shared<AutoDiffForceLaw<Functor, kOwn>>(
      std::move(name), std::vector<ParameterFacts>(parameters, parameters + kOwn),
      std::move(functor));
}

}  // namespace pushid
