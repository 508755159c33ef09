// residuals: derivatives of the rows of platforms, written out where the table has no masses: jets
// of sixteen inputs took most of a fit.
#include "residuals/cost_functions/plate_residual.h"

#include <ceres/jet.h>

namespace pushid {
namespace {

// Columns of what a frame's reaction depends on: q, qd and the acceleration that is felt.
using ByMotion = Eigen::Matrix<double, kPlateResiduals, 12, Eigen::RowMajor>;

// The generalized force of the ground and the muscles, and the vertical force.
struct Reaction {
  Vector4<double> force;
  double vertical = 0.0;

  Reaction(const Body& body, const PosedPendulum<double>& state, const Vector4<double>& felt,
           double gravity, const Vector4<double>& push) {
    const auto& [s_th, c_th, s_ph, c_ph] = state.angles;
    const double thd = state.qd[2], phd = state.qd[3];
    force = MassMatrix<double>(body, state.angles) * felt +
            Coriolis<double>(body, state.angles, state.qd) +
            gravity / kGravity * Gravity<double>(body, state.angles) - push;
    const double rise = -c_th * c_ph * (thd * thd + phd * phd) + 2.0 * s_th * s_ph * thd * phd -
                        s_th * c_ph * felt[2] - c_th * s_ph * felt[3];
    vertical = body.mass * gravity + body.point_mass() * body.pendulum_length() * rise;
  }
};

// Rows of [F_x, F_y, p_x, p_y] from those of the force and of the vertical force.
template <typename Rows, typename Row>
auto ReactionRows(const Reaction& at, double h, const Rows& force, const Row& vertical) {
  const double v = at.vertical;
  constexpr int kColumns = Rows::ColsAtCompileTime;
  Eigen::Matrix<double, kPlateResiduals, kColumns,
                kColumns == 1 ? Eigen::ColMajor : Eigen::RowMajor>
      rows;
  rows.topRows(2) = force.topRows(2);
  rows.row(2) =
      -(force.row(2) + h * force.row(0)) / v + (at.force[2] + h * at.force[0]) / (v * v) * vertical;
  rows.row(3) =
      (force.row(3) - h * force.row(1)) / v - (at.force[3] - h * at.force[1]) / (v * v) * vertical;
  return rows;
}

ByMotion ReactionByMotion(const Body& body, const PosedPendulum<double>& state,
                          const Vector4<double>& felt, double gravity, const Reaction& at) {
  const auto& [s_th, c_th, s_ph, c_ph] = state.angles;
  const double thd = state.qd[2], phd = state.qd[3], both = thd * thd + phd * phd;
  const double ml = body.point_mass() * body.pendulum_length();
  const Matrix4<double> rigid =
      InverseDynamicsJacobian(body, state.angles, state.qd, felt, gravity);
  Eigen::Matrix<double, 4, 12> force = Eigen::Matrix<double, 4, 12>::Zero();
  force.middleCols<2>(2) = rigid.leftCols<2>();
  force.middleCols<2>(6) = rigid.rightCols<2>();
  force.rightCols<4>() = MassMatrix<double>(body, state.angles);
  Eigen::Matrix<double, 1, 12> vertical = Eigen::Matrix<double, 1, 12>::Zero();
  vertical[2] = s_th * c_ph * both + 2.0 * c_th * s_ph * thd * phd - c_th * c_ph * felt[2] +
                s_th * s_ph * felt[3];
  vertical[3] = c_th * s_ph * both + 2.0 * s_th * c_ph * thd * phd + s_th * s_ph * felt[2] -
                c_th * c_ph * felt[3];
  vertical[6] = -2.0 * c_th * c_ph * thd + 2.0 * s_th * s_ph * phd;
  vertical[7] = -2.0 * c_th * c_ph * phd + 2.0 * s_th * s_ph * thd;
  vertical[10] = -s_th * c_ph;
  vertical[11] = -c_th * s_ph;
  ByMotion rows =
      ReactionRows(at, body.cart_height, force, Eigen::Matrix<double, 1, 12>(ml * vertical));
  rows(2, 0) += 1.0;
  rows(3, 1) += 1.0;
  return rows;
}

// By the height of the centre of mass of who stands. Forces are of second order in it, of which
// central differences are exact, however far.
PlateVector<double> ReactionByComHeight(const Body& body, double com_height,
                                        const PosedPendulum<double>& state,
                                        const Vector4<double>& felt, double gravity,
                                        const Vector4<double>& push, const Reaction& at) {
  constexpr double kFar = 0.5;  // of the height
  const auto moved = [&](double factor) {
    return Reaction(StandingBody<double>(body, factor * com_height), state, felt, gravity, push);
  };
  const Reaction above = moved(1.0 + kFar), below = moved(1.0 - kFar);
  const double per = 1.0 / (2.0 * kFar * com_height);
  const Vector4<double> force = per * (above.force - below.force);
  const Eigen::Matrix<double, 1, 1> vertical(per * (above.vertical - below.vertical));
  return ReactionRows(at, body.cart_height, force, vertical);
}

PlateVector<double> WithJets(const PlatePlace& place, const ParameterSet<double>& p,
                             const PendulumState<double>& state, const Vector4<double>& next_qd,
                             const PlateFrame& measured, const ResidualSigmas& sigmas,
                             PlateJacobian* jacobian) {
  using Jet = ceres::Jet<double, kPlateColumns>;
  PendulumState<Jet> jets;
  Vector4<Jet> next;
  for (int i = 0; i < 4; ++i) {
    jets.q[i] = Jet(state.q[i], i);
    jets.qd[i] = Jet(state.qd[i], 4 + i);
    next[i] = Jet(next_qd[i], 8 + i);
  }
  ParameterSet<Jet> parameters;  // none but these are asked for
  for (int i = 0; i < kNumPlateParameters; ++i) {
    const Parameter id = kPlateParameters[i];
    parameters[id] = Jet(p[id], 12 + i);
  }
  const PlateVector<Jet> values =
      RawPlateResidual<Jet>(place, parameters, jets, next, measured, sigmas);
  PlateVector<double> r;
  for (int i = 0; i < kPlateResiduals; ++i) {
    r[i] = values[i].a;
    jacobian->row(i) = values[i].v.transpose();
  }
  return r;
}

PlateVector<double> WrittenOut(const PlatePlace& place, const ParameterSet<double>& p,
                               const PendulumState<double>& state, const Vector4<double>& next_qd,
                               const PlateFrame& measured, const ResidualSigmas& sigmas,
                               PlateJacobian* jacobian) {
  const Scene& scene = *place.scene;
  const ScenePerson& person = scene.people[place.person];
  const bool stands = place.options->stance == Stance::kFixed;
  const Body body = DynamicBody<double>(*place.options, person.body, p, stands);
  GroundStep ground;
  if (scene.ground.moves()) ground = scene.ground.steps[place.frame];
  const Vector4<double> push = PushForceAt(scene, place.person, place.frame);
  const Vector4<double> felt = (next_qd - state.qd) / scene.dt + ground.acceleration;
  const PosedPendulum<double> now(state);
  PendulumState<double> start;
  start.q = person.start.q;
  const PosedPendulum<double> rest(start);
  const Vector4<double> none = Vector4<double>::Zero();
  const Reaction at(body, now, felt, ground.gravity, push);
  const Reaction before(body, rest, none, kGravity, none);
  const double h = body.cart_height;
  PlateVector<double> r{at.force[0] - measured.shear[0], at.force[1] - measured.shear[1],
                        state.q[0] - (at.force[2] + h * at.force[0]) / at.vertical -
                            (rest.q[0] - before.force[2] / before.vertical) - measured.centre[0],
                        state.q[1] + (at.force[3] - h * at.force[1]) / at.vertical -
                            (rest.q[1] + before.force[3] / before.vertical) - measured.centre[1]};
  const ByMotion rows = ReactionByMotion(body, now, felt, ground.gravity, at);
  jacobian->leftCols<8>() = rows.leftCols<8>();
  jacobian->middleCols<4>(4) -= rows.rightCols<4>() / scene.dt;
  jacobian->middleCols<4>(8) = rows.rightCols<4>() / scene.dt;
  jacobian->rightCols<kNumPlateParameters>().setZero();
  if (stands) {
    static_assert(kPlateParameters[0] == kComHeight);
    PlateVector<double> by_height =
        ReactionByComHeight(person.body, p[kComHeight], now, felt, ground.gravity, push, at);
    by_height.tail<2>() -=
        ReactionByComHeight(person.body, p[kComHeight], rest, none, kGravity, none, before)
            .tail<2>();
    jacobian->col(12) = by_height;
  }
  const PlateVector<double> scale{1.0 / sigmas.shear, 1.0 / sigmas.shear, 1.0 / sigmas.centre,
                                  1.0 / sigmas.centre};
  for (int i = 0; i < kPlateResiduals; ++i) jacobian->row(i) *= scale[i];
  return r.cwiseProduct(scale);
}

}  // namespace

PlateVector<double> PlateResidualWithJacobian(
    const PlatePlace& place, const ParameterSet<double>& p, const PendulumState<double>& state,
    const Vector4<double>& next_qd, const PlateFrame& measured, const ResidualSigmas& sigmas,
    PlateJacobian* jacobian) {
  const double weight = place.Known() ? measured.weight : 0.0;
  if (weight <= 0.0) {
    jacobian->setZero();
    return PlateVector<double>::Zero();
  }
  const bool jets = place.options->body == BodyModel::kTable;
  const PlateVector<double> r =
      (jets ? WithJets : WrittenOut)(place, p, state, next_qd, measured, sigmas, jacobian);
  return RobustlyWeighted(r, weight, sigmas.robust, jacobian);
}

}  // namespace pushid
