// residuals: the loops of person_lanes.h, for the file that includes this, which says
//   PUSHID_VECTOR_DOUBLES      doubles in a vector
//   PUSHID_LANE_SCALAR         the header with its scalar, where it is another (tests/benchmarks)
// What is compiled here for wide vectors must not be linked to by other files: the scalar is a type
// without linkage, so that every template of it has none either, and nothing else is called that
// has an inline definition (tests/residuals/shared_code.sh looks into the objects).
#pragma once

#include "residuals/lanes/person_roller.h"

namespace pushid {
namespace {

// The gradient J'r by the adjoint, as in adjoint/adjoint_gradient.h: with L = d(r'r/2)/d[q, qd] of
// the next frame and g = L_qd + dt L_q,
//   f = dt M^-1 g,  L_q <- L_q + J_q' f,  L_qd <- g + J_qd' f,  J = dF/ds - d(M a + C + G)/ds
// and J'r += (dF/d column)' f. Its work does not grow with the columns. Where a rollout has ended
// its residuals weigh nothing, so that L is zero until it goes on.
class BackwardRoller : public Roller {
 public:
  using Roller::Roller;

  // After Roll. gradient: P.
  void RollBack(Lanes* gradient) {
    for (int c = 0; c < in_.columns; ++c) gradient[c] = 0.0;
    for (Lanes& value : adjoint_) value = 0.0;
    for (int t = in_.frames - 1; t > 0; --t) {
      SetFrame(t);
      AddResidualBack(Step(t));
      AddOwed();
      SetFrame(t - 1);
      StepBack(t - 1, gradient);
    }
    AddOwed();
    AddOwed();  // at frame 0 the velocity before is that of frame 0
    for (int i = 0; in_.velocity_column >= 0 && i < 4; ++i) {
      gradient[in_.velocity_column + i] += adjoint_[4 + i];
    }
  }

 private:
  void SetFrame(int t) {
    const Lanes* const now = carried_.path + 8 * t;
    const Lanes* const before = carried_.path + 8 * (t > 0 ? t - 1 : 0);
    for (int i = 0; i < 4; ++i) {
      state_.q[i] = now[i];
      state_.qd[i] = now[4 + i];
      previous_[i] = before[4 + i];
    }
    angles_ = Angles<Lanes>(state_.q);
  }

  // By the row w r, w of the loss included: J'w'w r, with d(w r) = w dr + r twice r' dr.
  void AddResidualBack(const double* step) {
    const FrameVector<Lanes> r =
        RawFrameResidual(self_.body, state_, angles_, Measured(step), in_.sigmas);
    FrameJacobian<8, Lanes> by_state;
    RawFrameJacobian(self_.body, Lanes(0.0), state_, angles_, in_.sigmas, &by_state);
    const Lanes weight = LoadLanes(step + kLaneWeight * kWidth);
    const Lanes squares = r.squaredNorm();
    const RobustSlope<Lanes> robust(squares, in_.sigmas.robust);
    const Lanes along = weight * weight * robust.w * (robust.w + squares * robust.twice);
    for (int k = 0; k < kFrameResiduals; ++k) {
      for (int at : kOfRow[k]) {
        if (at >= 0) adjoint_[at] += along * r[k] * by_state(k, at);
      }
    }
  }

  // What steps hand to the velocity of the frame before theirs, a frame later on the way back.
  void AddOwed() {
    for (int i = 0; i < 2; ++i) {
      adjoint_[4 + i] += owed_[1][i];
      owed_[1][i] = owed_[0][i];
      owed_[0][i] = 0.0;
    }
  }

  void StepBack(int t, Lanes* gradient) {
    const double* const step = Step(t);
    const Lanes dt = self_.dt;
    Force g, a;
    for (int i = 0; i < 4; ++i) {
      g[i] = adjoint_[4 + i] + dt * adjoint_[i];
      a[i] = (carried_.path[8 * (t + 1) + 4 + i] - state_.qd[i]) / dt;
    }
    const Matrix inverse = InverseMassMatrix(self_.body, angles_, self_.body.mass);
    const Force f = dt * (inverse * g);
    const Lanes acts = LoadLanes(step + kLaneActs * kWidth);
    const Lanes slides = LoadLanes(step + kLaneSlides * kWidth);
    Linearize(t, acts, slides);
    const Matrix rigid = InverseDynamicsJacobian(self_.body, angles_, state_.qd, a);
    for (int i = 0; i < 2; ++i) {
      adjoint_[2 + i] += (jacobian_.by_state.col(2 + i) - rigid.col(i)).dot(f);
      adjoint_[4 + i] = g[i] + jacobian_.by_state.col(4 + i).dot(f);
      adjoint_[6 + i] = g[2 + i] + (jacobian_.by_state.col(6 + i) - rigid.col(2 + i)).dot(f);
      if (in_.cart_derivative) owed_[0][i] = jacobian_.by_previous[i] * f[i];
    }
    int last = -1;
    Lanes by_parameter = 0.0;
    for (int i = 0; i < in_.num_entries; ++i) {
      const LaneEntry& entry = in_.entries[i];
      if (entry.parameter != last) {
        by_parameter = Acting(entry.parameter, acts, slides) *
                       jacobian_.by_parameter.col(entry.parameter).dot(f);
      }
      last = entry.parameter;
      gradient[entry.column] += LoadLanes(in_.slopes + i * kWidth) * by_parameter;
    }
  }

  Lanes adjoint_[8];
  Lanes owed_[2][2] = {{0.0, 0.0}, {0.0, 0.0}};
};

void RollLanes(const LaneInputs& in, LaneSums sums, const LaneOutputs& out) {
  Room room(out.storage);
  const int columns = in.columns, size = (columns + 1) * (columns + 1);
  const bool equations = sums == LaneSums::kPlain || sums == LaneSums::kRobust;
  Carried carried;
  carried.residuals = out.residuals;
  carried.states = out.states;
  if (sums == LaneSums::kGradient) {
    carried.path = room.Take(8 * in.frames);
  } else if (sums == LaneSums::kStates && columns > 0) {
    carried.by_column = room.Take(8 * columns);
    carried.before = room.Take(2 * columns);
  } else if (equations) {
    carried = {room.Take(8 * columns), room.Take(2 * columns),
               room.Take(kFrameResiduals * (columns + 1)), room.Take(size), room.Take(size)};
  }
  BackwardRoller roller(in, sums, carried);
  roller.Roll();
  Store(roller.failed(), out.failed);
  Store(roller.squares(), out.squares);
  if (sums == LaneSums::kGradient) {
    Lanes* const gradient = room.Take(columns);
    roller.RollBack(gradient);
    for (int c = 0; c < columns; ++c) Store(gradient[c], out.gradient + c * kWidth);
  }
  for (int i = 0; equations && i < size; ++i) {
    Store(carried.plain[i], out.plain + i * kWidth);
    if (sums == LaneSums::kRobust) Store(carried.robust[i], out.robust + i * kWidth);
  }
}

}  // namespace
}  // namespace pushid
