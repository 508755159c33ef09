// residuals: the loops of person_lanes.h, for the file that includes this, which says
//   PUSHID_VECTOR_DOUBLES      doubles in a vector
//   PUSHID_LANE_SCALAR         the header with its scalar, where it is another (tests/benchmarks)
// Code that is compiled here for wide vectors must not be linked to by other files: the scalar is a
// type without linkage, so that every template of it has none either, and nothing else is called
// that has an inline definition (tests/residuals/shared_code.sh looks into the objects).
#pragma once

#ifndef PUSHID_LANE_SCALAR
#define PUSHID_LANE_SCALAR "residuals/lanes/lane_scalar.h"
#endif
#include PUSHID_LANE_SCALAR

#include "models/push.h"
#include "residuals/force_jacobians.h"
#include "residuals/frame_residual.h"
#include "residuals/lanes/person_lanes.h"

namespace pushid {
namespace {

constexpr int kWidth = PUSHID_VECTOR_DOUBLES;

template <int kSize>
Eigen::Matrix<Lanes, kSize, 1> LoadVector(const double* from) {
  Eigen::Matrix<Lanes, kSize, 1> vector;
  for (int i = 0; i < kSize; ++i) vector[i] = LoadLanes(from + i * kWidth);
  return vector;
}

// The derivatives that are carried from step to step, and what they are summed up to.
struct Carried {
  Lanes* by_column = nullptr;   // P x 8: [q, qd]
  Lanes* rows = nullptr;        // (P + 1) x kFrameResiduals: [J r] of one frame
  Lanes* plain = nullptr;       // (P + 1) x (P + 1)
  Lanes* robust = nullptr;      // as plain
  Lanes* tails = nullptr;       // rate and decay of each
  double* residuals = nullptr;  // of LaneOutputs
  double* states = nullptr;     // of LaneOutputs
};

// Lanes of which storage has room for, one after the other.
class Room {
 public:
  explicit Room(double* storage) {
    const auto address = reinterpret_cast<unsigned long long>(storage);
    at_ = reinterpret_cast<Lanes*>((address + sizeof(Lanes) - 1) / sizeof(Lanes) * sizeof(Lanes));
  }
  Lanes* Take(int count) {
    Lanes* const taken = at_;
    at_ += count;
    return taken;
  }

 private:
  Lanes* at_;
};

// gram, of size x size, grows by the products of kLeft columns of kFrameResiduals rows each, from
// column i on, with kRight from j on; upper: those on and above its diagonal alone.
template <int kLeft, int kRight, bool kUpper = false>
void AddGramBlock(const Lanes* rows, int size, int i, int j, Lanes* gram) {
  const Lanes* const left = rows + kFrameResiduals * i;
  const Lanes* const right = rows + kFrameResiduals * j;
  Lanes sum[kLeft][kRight];
  const auto each = [](const auto& does) {
    for (int a = 0; a < kLeft; ++a) {
      for (int b = kUpper ? a : 0; b < kRight; ++b) does(a, b);
    }
  };
  each([&](int a, int b) { sum[a][b] = gram[(i + a) * size + j + b]; });
#pragma GCC unroll 9
  for (int k = 0; k < kFrameResiduals; ++k) {
    each([&](int a, int b) {
      sum[a][b] += left[kFrameResiduals * a + k] * right[kFrameResiduals * b + k];
    });
  }
  each([&](int a, int b) { gram[(i + a) * size + j + b] = sum[a][b]; });
}

// The upper triangle, by blocks whose sums stay in registers.
inline void AddGram(const Lanes* rows, int size, Lanes* gram) {
  constexpr int kBlock = 3;
  const int whole = size / kBlock * kBlock;
  for (int j = 0; j < whole; j += kBlock) {
    for (int i = 0; i < j; i += kBlock) AddGramBlock<kBlock, kBlock>(rows, size, i, j, gram);
    AddGramBlock<kBlock, kBlock, true>(rows, size, j, j, gram);
  }
  for (int j = whole; j < size; ++j) {
    for (int i = 0; i < whole; i += kBlock) AddGramBlock<kBlock, 1>(rows, size, i, j, gram);
    for (int i = whole; i <= j; ++i) AddGramBlock<1, 1>(rows, size, i, j, gram);
  }
}

class Roller {
 public:
  Roller(const LaneInputs& in, const Carried& carried) : in_(in), carried_(carried) {
    const double* const c = in.constants;
    const auto constant = [c](int id) { return LoadLanes(c + id * kWidth); };
    self_.body = {constant(kLaneMass), constant(kLaneRod), constant(kLaneHeight),
                  constant(kLanePointShare), constant(kLanePendulumRatio)};
    self_.scale.force = constant(kLaneScale);
    self_.scale.stiffness = constant(kLaneScale + 1);
    self_.scale.damping = constant(kLaneScale + 2);
    self_.friction = in.friction;
    self_.posture = LoadVector<2>(c + kLanePosture * kWidth);
    self_.hold = LoadVector<2>(c + kLaneHold * kWidth);
    self_.dt = constant(kLaneStep);
    for (int i = 0; i < kLaneParameters; ++i) {
      p_[i] = LoadLanes(in.parameters + i * kWidth);
    }
    state_.q = LoadVector<4>(c + kLaneStart * kWidth);
    state_.qd = LoadVector<4>(c + (kLaneStart + 4) * kWidth);
    for (int k = 0; k < in.num_tails; ++k) carried_.tails[2 * k] = Tail(k, 0).Rate(p_);
    if (CarriesColumns()) StartDerivatives();
  }

  void Roll() {
    Bits alive = Bits{} - 1;
    for (int t = 0; t < in_.frames; ++t) {
      angles_ = Angles<Lanes>(state_.q);
      const double* const step = Step(t);
      if (in_.sums == LaneSums::kStates) {
        if (t >= in_.first_state) HandOut(t - in_.first_state);
      } else if (t > 0) {
        AddResidual(t, step);
      }
      alive &= LoadLanes(step + kLaneGoesOn * kWidth) != Lanes(0.0);
      if (t + 1 < in_.frames) StepOn(t, step, &alive);
    }
  }

  Lanes failed() const { return failed_; }
  Lanes squares() const { return squares_; }

 private:
  using Matrix = Matrix4<Lanes>;
  using Force = Vector4<Lanes>;

  const double* Step(int t) const {
    return in_.steps + (t < in_.num_steps ? t : in_.num_steps - 1) * kLaneFields * kWidth;
  }

  bool CarriesColumns() const { return carried_.by_column != nullptr; }

  void HandOut(int index) {
    double* const to = carried_.states + index * 8 * (1 + in_.columns) * kWidth;
    for (int i = 0; i < 4; ++i) {
      Store(state_.q[i], to + i * kWidth);
      Store(state_.qd[i], to + (4 + i) * kWidth);
    }
    for (int i = 0; i < 8 * in_.columns; ++i) Store(carried_.by_column[i], to + (8 + i) * kWidth);
  }

  void StartDerivatives() {
    for (int c = 0; c < in_.columns; ++c) {
      for (int i = 0; i < 8; ++i) carried_.by_column[8 * c + i] = 0.0;
    }
    for (int i = 0; in_.velocity_column >= 0 && i < 4; ++i) {
      carried_.by_column[8 * (in_.velocity_column + i) + 4 + i] = 1.0;
    }
    const int size = (in_.columns + 1) * (in_.columns + 1);
    for (int i = 0; carried_.plain != nullptr && i < size; ++i) carried_.plain[i] = 0.0;
    for (int i = 0; in_.sums == LaneSums::kRobust && i < size; ++i) carried_.robust[i] = 0.0;
  }

  TailOf<Lanes> Tail(int k, int frame) const {
    const double* const tail = in_.tails + k * kLaneTails * kWidth;
    const Lanes since = static_cast<double>(frame) - LoadLanes(tail + kLaneEnd * kWidth);
    const Lanes acts = Select(0.0 > since, 0.0, 1.0);
    return {acts * LoadVector<4>(tail + kLaneMean * kWidth),
            LoadLanes(tail + kLaneMassPerForce * kWidth),
            LoadLanes(tail + kLaneLogDuration * kWidth), acts * since * self_.dt};
  }

  // One step on, where `alive` and within the domain.
  void StepOn(int t, const double* step, Bits* alive) {
    const Lanes acts = LoadLanes(step + kLaneActs * kWidth);
    const Lanes slides = LoadLanes(step + kLaneSlides * kWidth);
    Force force = self_.Balance(p_, state_, state_.qd) + self_.Linear(p_, state_);
    for (int k = 0; k < in_.num_tails; ++k) {
      const TailOf<Lanes> tail = Tail(k, t);
      Lanes* const rate_and_decay = carried_.tails + 2 * k;
      rate_and_decay[1] = tail.Decay(rate_and_decay[0]);
      force += tail.Force(p_, rate_and_decay[0], rate_and_decay[1]);
    }
    force = (acts * force + slides * self_.Friction(p_, state_.qd)).eval();
    force += LoadVector<4>(step + kLanePush * kWidth);
    const Matrix inverse = InverseMassMatrix(self_.body, angles_, self_.body.mass);
    const Force right =
        force - Coriolis(self_.body, angles_, state_.qd) - Gravity(self_.body, angles_);
    const Force a = inverse * right;
    PendulumState<Lanes> next;
    next.qd = state_.qd + self_.dt * a;
    next.q = state_.q + self_.dt * next.qd;
    const Bits outside = Outside(next);
    failed_ = Select(*alive & outside, 1.0, failed_);
    *alive &= ~outside;
    if (CarriesColumns()) CarryOn(t, acts, slides, a, Select(*alive, self_.dt, 0.0) * inverse);
    for (int i = 0; i < 4; ++i) {
      state_.q[i] = Select(*alive, next.q[i], state_.q[i]);
      state_.qd[i] = Select(*alive, next.qd[i], state_.qd[i]);
    }
  }

  // OutsideDomain (models/rollout.h), in lanes.
  static Bits Outside(const PendulumState<Lanes>& state) {
    const Lanes sum = (state.q + state.qd).sum();
    return (abs(state.q[2]) > Lanes(kMaxAngle)) | (abs(state.q[3]) > Lanes(kMaxAngle)) |
           (sum * 0.0 != Lanes(0.0));
  }

  // The derivatives at the next frame by the chain rule, S <- A S + B; inverse: of the mass matrix,
  // times dt. A person alone does not care where the cart is: six columns of the state.
  void CarryOn(int t, Lanes acts, Lanes slides, const Force& a, const Matrix& inverse) {
    Eigen::Matrix<Lanes, 4, 6> by_state = Linearize(t, acts, slides);
    const Matrix rigid = InverseDynamicsJacobian(self_.body, angles_, state_.qd, a);
    by_state.leftCols<2>() -= rigid.leftCols<2>();
    by_state.rightCols<2>() -= rigid.rightCols<2>();
    const LaneEntry* entry = in_.entries;
    const double* slope = in_.slopes;
    const LaneEntry* const end = entry + in_.num_entries;
    for (int c = 0; c < in_.columns; ++c) {
      Lanes* const s = carried_.by_column + 8 * c;
      Force force = Force::Zero();  // by the column
      for (; entry != end && entry->column == c; ++entry, slope += kWidth) {
        force += (LoadLanes(slope) * Acting(entry->parameter, acts, slides)) *
                 jacobian_.by_parameter.col(entry->parameter);
      }
      force += by_state * Eigen::Map<const Eigen::Matrix<Lanes, 6, 1>>(s + 2);
      for (int r = 0; r < 4; ++r) {
        for (int k = 0; k < 4; ++k) s[4 + r] += inverse(r, k) * force[k];
        s[r] += self_.dt * s[4 + r];
      }
    }
  }

  // Derivatives of the forces that act, by all of the state but where the cart is; those by
  // parameters still times Acting.
  Eigen::Matrix<Lanes, 4, 6> Linearize(int t, Lanes acts, Lanes slides) {
    jacobian_.by_state.setZero();
    constexpr int kOfTails = kTailBase - kTailGain + 1;
    static_assert(kOfTails == 5, "the tails' parameters are neighbours");
    jacobian_.by_parameter.middleCols<kOfTails>(kTailGain).setZero();  // others are written again
    AddFrictionJacobian(self_, p_, state_.qd, &jacobian_);
    const Eigen::Matrix<Lanes, 2, 2> alone = (slides - acts) * jacobian_.by_state.block<2, 2>(0, 4);
    AddControlJacobian(self_, p_, state_, &jacobian_);
    for (int k = 0; k < in_.num_tails; ++k) {
      const Lanes* const rate_and_decay = carried_.tails + 2 * k;
      AddTailJacobian(Tail(k, t), p_, rate_and_decay[0], rate_and_decay[1],
                      &jacobian_.by_parameter);
    }
    Eigen::Matrix<Lanes, 4, 6> by_state = acts * jacobian_.by_state.rightCols<6>();
    by_state.block<2, 2>(0, 2) += alone;
    return by_state;
  }
  static Lanes Acting(int parameter, Lanes acts, Lanes slides) {
    return parameter >= kMu && parameter < kKpX ? slides : acts;
  }

  static MeasuredFrameOf<Lanes> Measured(const double* step) {
    MeasuredFrameOf<Lanes> measured;
    measured.hip = LoadVector<3>(step + kLaneHip * kWidth);
    measured.state.q = LoadVector<4>(step + kLanePose * kWidth);
    measured.state.qd = LoadVector<4>(step + kLaneVelocity * kWidth);
    return measured;
  }

  void AddResidual(int t, const double* step) {
    const Lanes weight = LoadLanes(step + kLaneWeight * kWidth);
    const FrameVector<Lanes> r =
        RawFrameResidual(self_.body, state_, angles_, Measured(step), in_.sigmas);
    if (in_.sums == LaneSums::kNone) {
      double* const to = carried_.residuals + (t - 1) * kFrameResiduals * kWidth;
      for (int k = 0; k < kFrameResiduals; ++k) Store(weight * r[k], to + k * kWidth);
      return;
    }
    const Lanes squares = r.squaredNorm();
    const RobustSlope<Lanes> robust(squares, in_.sigmas.robust);
    const Lanes scale = weight * robust.w;
    squares_ += scale * scale * squares;
    if (!CarriesColumns()) return;
    for (int k = 0; k < kFrameResiduals; ++k) {
      carried_.rows[kFrameResiduals * in_.columns + k] = scale * r[k];
    }
    const Eigen::Matrix<Lanes, kFrameResiduals, 8> j = ByState();
    const auto at = [&](int row, int column) { return scale * j(row, column); };
    for (int c = 0; c < in_.columns; ++c) {
      const Lanes* const s = carried_.by_column + 8 * c;
      const Lanes row[kFrameResiduals] = {at(0, 0) * s[0] + at(0, 2) * s[2],  // what is not zero
                                          at(1, 1) * s[1] + at(1, 2) * s[2] + at(1, 3) * s[3],
                                          at(2, 2) * s[2] + at(2, 3) * s[3],
                                          at(3, 4) * s[4],
                                          at(4, 5) * s[5],
                                          at(5, 2) * s[2],
                                          at(6, 3) * s[3],
                                          at(7, 6) * s[6],
                                          at(8, 7) * s[7]};
      Lanes along = 0.0;
      for (int k = 0; k < kFrameResiduals; ++k) along += r[k] * row[k];
      along *= robust.over_w;  // rows have w in them
      Lanes* const to = carried_.rows + kFrameResiduals * c;
      for (int k = 0; k < kFrameResiduals; ++k) to[k] = row[k] + r[k] * along;
    }
    AddGram(carried_.rows, in_.columns + 1, carried_.plain);
    if (in_.sums != LaneSums::kRobust) return;
    if (in_.sigmas.robust > 0.0) Correct(robust.w * robust.w * squares, weight);
    AddGram(carried_.rows, in_.columns + 1, carried_.robust);
  }

  // RawFrameResidual's derivative by [q, qd]; what is always zero is not written.
  Eigen::Matrix<Lanes, kFrameResiduals, 8> ByState() const {
    const auto& [s_th, c_th, s_ph, c_ph] = angles_;
    const ResidualSigmas& sigmas = in_.sigmas;
    const Lanes scaled_rod = self_.body.rod_length * (1.0 / sigmas.hip);
    Eigen::Matrix<Lanes, kFrameResiduals, 8> j;
    j(0, 0) = j(1, 1) = Lanes(1.0 / sigmas.hip);
    j(3, 4) = j(4, 5) = Lanes(1.0 / sigmas.velocity);
    j(5, 2) = j(6, 3) = Lanes(1.0 / sigmas.angle);
    j(7, 6) = j(8, 7) = Lanes(1.0 / sigmas.rate);
    j(0, 2) = scaled_rod * c_th;
    j(1, 2) = scaled_rod * s_th * s_ph;
    j(1, 3) = -scaled_rod * c_th * c_ph;
    j(2, 2) = -scaled_rod * s_th * c_ph;
    j(2, 3) = -scaled_rod * c_th * s_ph;
    return j;
  }

  // CorrectForRobustLoss; squares: |w r|^2 without the weight.
  void Correct(Lanes squares, Lanes weight) {
    const RobustHessian<Lanes> factor(squares, in_.sigmas.robust);
    const Lanes* const r = carried_.rows + kFrameResiduals * in_.columns;
    const Lanes length = weight * weight * squares;
    const Lanes along = Select(length > Lanes(0.0), (factor.along - factor.across) / length, 0.0);
    for (int c = 0; c < in_.columns; ++c) {
      Lanes* const row = carried_.rows + kFrameResiduals * c;
      Lanes by_r = 0.0;
      for (int k = 0; k < kFrameResiduals; ++k) by_r += r[k] * row[k];
      by_r *= along;
      for (int k = 0; k < kFrameResiduals; ++k) row[k] = factor.across * row[k] + r[k] * by_r;
    }
  }

  const LaneInputs& in_;
  const Carried carried_;
  SelfTerms<Lanes> self_;
  ParameterSet<Lanes> p_{};
  PendulumState<Lanes> state_;
  Angles<Lanes> angles_;
  SelfJacobian<Lanes> jacobian_;
  Lanes failed_ = 0.0, squares_ = 0.0;
};

void RollLanes(const LaneInputs& in, const LaneOutputs& out) {
  Room room(out.storage);
  const int columns = in.columns, size = (columns + 1) * (columns + 1);
  const bool equations = in.sums == LaneSums::kPlain || in.sums == LaneSums::kRobust;
  Carried carried;
  carried.residuals = out.residuals;
  carried.states = out.states;
  if (equations || (in.sums == LaneSums::kStates && columns > 0)) {
    carried.by_column = room.Take(8 * columns);
  }
  if (equations) {
    carried.rows = room.Take(kFrameResiduals * (columns + 1));
    carried.plain = room.Take(size);
    carried.robust = room.Take(size);
  }
  carried.tails = room.Take(2 * in.num_tails);
  Roller roller(in, carried);
  roller.Roll();
  Store(roller.failed(), out.failed);
  Store(roller.squares(), out.squares);
  for (int i = 0; equations && i < size; ++i) {
    Store(carried.plain[i], out.plain + i * kWidth);
    if (in.sums == LaneSums::kRobust) Store(carried.robust[i], out.robust + i * kWidth);
  }
}

}  // namespace

template <>
const PersonLanes& OfWidth<PersonLanes, PUSHID_WIDTH>() {
  static constexpr PersonLanes lanes = {PUSHID_WIDTH, kWidth, RollLanes};
  return lanes;
}

}  // namespace pushid
