// models: the inverted pendulum on a cart (IPM) that stands for a person.
//
// q = [x, y, theta, phi]: cart position (m), angles about y and about x (rad); rod length l (m).
// A learned law may change l from step to step (learned_terms.h); what l' and l'' would add is left
// out.
//   M(q) qdd + C(q, qd) + G(q) = F_net,   semi-implicit Euler: qd += dt qdd, q += dt qd.
// Point mass (hip): p = (x + l sin(theta), y - l cos(theta) sin(phi), h + l cos(theta) cos(phi)).
// Source: Yue et al., CVPR 2024, supplement, with row 3 of C as the derivation gives it (s_th c_th,
// printed as s_th c_ph). M is singular at cos(theta) = 0, hence the domain below.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <vector>

namespace pushid {

template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <typename T>
using Vector4 = Eigen::Matrix<T, 4, 1>;
template <typename T>
using Matrix4 = Eigen::Matrix<T, 4, 4>;

inline constexpr double kGravity = 9.81;   // m/s^2
inline constexpr double kMaxAngle = 1.4;   // rad: beyond it a rollout has left the model's domain
inline constexpr double kFallAngle = 1.0;  // rad: beyond it a person is said to fall
inline constexpr double kCartShare = 0.1;  // of the body's mass
inline constexpr double kReferenceMass = 85;   // kg
inline constexpr double kFeetApart = 0.2;      // m, between the ankles where they are not known
inline constexpr double kReferenceRod = 0.95;  // m

// L: of what is constant (double), unless a rod moves, or several people stand side by side in a
// vector of the processor (residuals/lanes).
//
// The rod is what is seen, from the ankles to the hip. A body that is no point at the hip
// (Distributed) moves like a pendulum of another length and mass.
template <typename L>
struct BodyOf {
  L mass = L(kReferenceMass);           // kg
  L rod_length = L(kReferenceRod);      // m
  L cart_height = L(0.0);               // m
  L point_share = L(1.0 - kCartShare);  // of the mass, in the pendulum's point
  L pendulum_ratio = L(1.0);            // of the pendulum's length to the rod's

  L point_mass() const { return point_share * mass; }
  L pendulum_length() const { return pendulum_ratio * rod_length; }
};

// A body during a recording; the lengths are those of frame 0.
using Body = BodyOf<double>;

// The feet of who stands and steps (stance.h); elsewhere it stays as it is.
template <typename T>
struct FeetState {
  Eigen::Matrix<T, 2, 1> apart{T(0.0), T(kFeetApart)};  // the left foot from the right one, m
  T clock = T(0.0);        // s: how far a step is prepared; of a swing, since lift-off
  T swing_time = T(0.0);   // s, of the swing; where fresh and both stand: since landing
  signed char swings = 0;  // 1: the left foot is in the air, -1: the right one, 0: both stand
  signed char landed = 0;  // which landed last; 0: none has yet
  bool fresh = false;      // a foot left the ground or landed within the last step
};

template <typename T>
struct PendulumState {
  Vector4<T> q = Vector4<T>::Zero();
  Vector4<T> qd = Vector4<T>::Zero();
  T rod = T(0.0);  // l - l_0, m: how far a rod that moves has moved
  FeetState<T> feet = {};
};

// The body once its rod has moved; the cart keeps its height.
template <typename T>
BodyOf<T> BodyNow(const Body& body, const T& rod) {
  return {T(body.mass), body.rod_length + rod, T(body.cart_height), T(body.point_share),
          T(body.pendulum_ratio)};
}

// Sines and cosines of theta and phi: a step needs them several times, and they are half its cost.
template <typename T>
struct Angles {
  T s_th = T(0.0), c_th = T(1.0), s_ph = T(0.0), c_ph = T(1.0);

  Angles() = default;
  explicit Angles(const Vector4<T>& q) {
    using std::cos, std::sin;
    s_th = sin(q[2]), c_th = cos(q[2]), s_ph = sin(q[3]), c_ph = cos(q[3]);
  }
};

// A state with its sines and cosines: what acts at one frame asks for them many times.
template <typename T>
struct PosedPendulum : PendulumState<T> {
  Angles<T> angles;

  PosedPendulum() = default;
  PosedPendulum(const PendulumState<T>& state)  // NOLINT: a state with what follows from it
      : PendulumState<T>(state), angles(state.q) {}
  PosedPendulum(const PendulumState<T>& state, const Angles<T>& known)
      : PendulumState<T>(state), angles(known) {}
};

template <typename T, typename L>
Matrix4<T> MassMatrix(const BodyOf<L>& body, const Angles<T>& angles) {
  const L m = body.point_mass(), l = body.pendulum_length();
  const auto& [s_th, c_th, s_ph, c_ph] = angles;
  const T zero(0.0), total(body.mass);
  Matrix4<T> mass;
  mass << total, zero, m * l * c_th, zero,                     //
      zero, total, m * l * s_th * s_ph, -m * l * c_th * c_ph,  //
      m * l * c_th, m * l * s_th * s_ph, T(m * l * l), zero,   //
      zero, -m * l * c_th * c_ph, zero, m * l * l * c_th * c_th;
  return mass;
}

template <typename T, typename L>
Matrix4<T> MassMatrix(const BodyOf<L>& body, const Vector4<T>& q) {
  return MassMatrix(body, Angles<T>(q));
}

template <typename T, typename L>
Vector4<T> Coriolis(const BodyOf<L>& body, const Angles<T>& angles, const Vector4<T>& qd) {
  const L m = body.point_mass(), l = body.pendulum_length();
  const auto& [s_th, c_th, s_ph, c_ph] = angles;
  const T thd = qd[2], phd = qd[3];
  return {-m * l * s_th * thd * thd,
          m * l * (2.0 * s_th * c_ph * thd * phd + c_th * s_ph * (thd * thd + phd * phd)),
          m * l * l * s_th * c_th * phd * phd, -2.0 * m * l * l * s_th * c_th * thd * phd};
}

template <typename T, typename L>
Vector4<T> Gravity(const BodyOf<L>& body, const Angles<T>& angles) {
  const L mgl = body.point_mass() * kGravity * body.pendulum_length();
  return {T(0.0), T(0.0), -mgl * angles.s_th * angles.c_ph, -mgl * angles.c_th * angles.s_ph};
}

template <typename T, typename L>
Vector4<T> Gravity(const BodyOf<L>& body, const Vector4<T>& q) {
  return Gravity(body, Angles<T>(q));
}

// Inverse of the mass matrix by its Schur complement: the cart block is diagonal, so 2 x 2 remains.
// cart: what stands on that diagonal, kg: the body's mass, and more where the ground holds the
// feet.
template <typename T, typename L, typename Cart>
Matrix4<T> InverseMassMatrix(const BodyOf<L>& body, const Angles<T>& angles, const Cart& cart) {
  const Matrix4<T> mass = MassMatrix(body, angles);
  const Cart w = 1.0 / cart;
  const T b02 = mass(0, 2), b12 = mass(1, 2), b13 = mass(1, 3);
  const T s22 = mass(2, 2) - w * (b02 * b02 + b12 * b12);
  const T s23 = -w * b12 * b13;
  const T s33 = mass(3, 3) - w * b13 * b13;
  const T inverse_det = 1.0 / (s22 * s33 - s23 * s23);
  const T i22 = s33 * inverse_det, i23 = -s23 * inverse_det, i33 = s22 * inverse_det;
  // Upper right block: -(1/M) B S^-1.
  const T i02 = -w * b02 * i22, i03 = -w * b02 * i23;
  const T i12 = -w * (b12 * i22 + b13 * i23), i13 = -w * (b12 * i23 + b13 * i33);
  const T i00 = w - w * b02 * i02, i01 = -w * b02 * i12;
  const T i11 = w - w * (b12 * i12 + b13 * i13);
  Matrix4<T> inverse;
  inverse << i00, i01, i02, i03, i01, i11, i12, i13, i02, i12, i22, i23, i03, i13, i23, i33;
  return inverse;
}

// qdd for a generalized force [N, N, N m, N m].
template <typename T, typename L>
Vector4<T> Acceleration(const BodyOf<L>& body, const Angles<T>& angles, const Vector4<T>& qd,
                        const Vector4<T>& force) {
  const Vector4<T> right = force - Coriolis(body, angles, qd) - Gravity(body, angles);
  return InverseMassMatrix(body, angles, body.mass) * right;
}

template <typename T, typename L>
Vector4<T> Acceleration(const BodyOf<L>& body, const PendulumState<T>& state,
                        const Vector4<T>& force) {
  return Acceleration(body, Angles<T>(state.q), state.qd, force);
}

// Acceleration on ground that takes the cart's velocity after the step, qd + dt qdd, to that of the
// feet, by `ground` (N s/m): implicit, so that any resistance is stable.
template <typename T, typename L>
Vector4<T> AccelerationOnGround(const BodyOf<L>& body, const Angles<T>& angles,
                                const Vector4<T>& qd, const Vector4<T>& force, const T& ground,
                                const Eigen::Matrix<T, 2, 1>& feet, double dt) {
  Vector4<T> right = force - Coriolis(body, angles, qd) - Gravity(body, angles);
  for (int i = 0; i < 2; ++i) right[i] -= ground * (qd[i] - feet[i]);
  return InverseMassMatrix(body, angles, T(body.mass + dt * ground)) * right;
}

template <typename T>
PendulumState<T> Step(const PendulumState<T>& state, const Vector4<T>& qdd, double dt) {
  PendulumState<T> next;
  next.qd = state.qd + dt * qdd;
  next.q = state.q + dt * next.qd;
  next.rod = state.rod;
  next.feet = state.feet;
  return next;
}

template <typename T, typename L>
Vector3<T> HipPosition(const BodyOf<L>& body, const Angles<T>& angles, const Vector4<T>& q) {
  const L l = body.rod_length;
  const auto& [s_th, c_th, s_ph, c_ph] = angles;
  return {q[0] + l * s_th, q[1] - l * c_th * s_ph, body.cart_height + l * c_th * c_ph};
}

template <typename T, typename L>
Vector3<T> HipPosition(const BodyOf<L>& body, const Vector4<T>& q) {
  return HipPosition(body, Angles<T>(q), q);
}

// The generalized force whose acceleration is qdd: M qdd + C + G.
template <typename T, typename L>
Vector4<T> InverseDynamics(const BodyOf<L>& body, const PendulumState<T>& state,
                           const Vector4<T>& qdd) {
  const Angles<T> angles(state.q);
  return MassMatrix(body, angles) * qdd + Coriolis(body, angles, state.qd) + Gravity(body, angles);
}

// Bodies that are no point of nine tenths at the hip.
//
// A body with the share s of the mass M above the ankles, whose centre is c l up the rod (l: the
// rod) and whose radius of gyration about that centre is r l, moves exactly like a point
//   m' = M s c^2 / (c^2 + r^2)   on a rod   l' = l (c^2 + r^2) / c:
// m' l' = M s c l is its first moment and m' l'^2 = M s (c^2 + r^2) l^2 its inertia about the
// ankles, and the cart's row holds M in either case.

// A body's masses in shares of the whole, and their heights in lengths of the rod.
template <typename T>
struct MassDistributionOf {
  T cart_share = T(kCartShare);
  T com = T(1.0);       // c
  T gyration = T(0.0);  // r
};
using MassDistribution = MassDistributionOf<double>;

// The body with its mass so distributed.
template <typename T, typename L>
BodyOf<T> Distributed(const BodyOf<L>& body, const MassDistributionOf<T>& distribution) {
  const T c2 = distribution.com * distribution.com;
  const T inertia = c2 + distribution.gyration * distribution.gyration;
  return {T(body.mass), T(body.rod_length), T(body.cart_height),
          (1.0 - distribution.cart_share) * c2 / inertia, inertia / distribution.com};
}

// One value for everybody at every frame of a rollout.

// Frames 0 .. num_frames - 1, stored frame by frame.
template <typename Value>
class FrameTable {
 public:
  FrameTable() = default;
  FrameTable(int num_frames, int num_people)
      : num_people_(num_people), values_(static_cast<size_t>(num_frames) * num_people) {}
  // Sets everything as new, in the memory that is there.
  void Reset(int num_frames, int num_people) {
    num_people_ = num_people;
    values_.assign(static_cast<size_t>(num_frames) * num_people, Value());
  }
  Value& At(int frame, int person) { return values_[Index(frame, person)]; }
  const Value& At(int frame, int person) const { return values_[Index(frame, person)]; }
  // Everybody at one frame, in a row.
  const Value* Frame(int frame) const { return values_.data() + Index(frame, 0); }
  int num_people() const { return num_people_; }
  int num_frames() const {
    return num_people_ == 0 ? 0 : static_cast<int>(values_.size()) / num_people_;
  }

 private:
  size_t Index(int frame, int person) const {
    return static_cast<size_t>(frame) * num_people_ + person;
  }
  int num_people_ = 0;
  std::vector<Value> values_;
};

template <typename T>
using RolloutPath = FrameTable<PendulumState<T>>;

}  // namespace pushid
