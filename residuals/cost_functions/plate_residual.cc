// residuals: derivatives of the rows of platforms, written out: jets of all inputs took most of a
// fit.
#include "residuals/cost_functions/plate_residual.h"

namespace pushid {
namespace {

// Columns of what a frame's reaction depends on: q, qd and the acceleration that is felt.
constexpr int kMotion = 12;
template <int kColumns>
using ReactionRowsOf = Eigen::Matrix<double, kPlateResiduals, kColumns,
                                     kColumns == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

// Rows of [F_x, F_y, p_x, p_y] from those of the force and of the vertical force.
template <int kColumns>
ReactionRowsOf<kColumns> ReactionRows(const ReactionForce<double>& at, double h,
                                      const Eigen::Matrix<double, 4, kColumns>& force,
                                      const Eigen::Matrix<double, 1, kColumns>& vertical) {
  const double v = at.vertical;
  ReactionRowsOf<kColumns> rows;
  rows.row(0) = force.row(0);
  rows.row(1) = force.row(1);
  rows.row(2) =
      -(force.row(2) + h * force.row(0)) / v + (at.force[2] + h * at.force[0]) / (v * v) * vertical;
  rows.row(3) =
      (force.row(3) - h * force.row(1)) / v - (at.force[3] - h * at.force[1]) / (v * v) * vertical;
  return rows;
}

ReactionRowsOf<kMotion> ReactionByMotion(const Body& body, const PosedPendulum<double>& state,
                                         const Vector4<double>& felt, double gravity,
                                         const ReactionForce<double>& at) {
  const auto& [s_th, c_th, s_ph, c_ph] = state.angles;
  const double thd = state.qd[2], phd = state.qd[3], both = thd * thd + phd * phd;
  const double ml = body.point_mass() * body.pendulum_length();
  const Matrix4<double> rigid =
      InverseDynamicsJacobian(body, state.angles, state.qd, felt, gravity);
  Eigen::Matrix<double, 4, kMotion> force = Eigen::Matrix<double, 4, kMotion>::Zero();
  force.middleCols<2>(2) = rigid.leftCols<2>();
  force.middleCols<2>(6) = rigid.rightCols<2>();
  force.rightCols<4>() = MassMatrix(body, state.angles);
  Eigen::Matrix<double, 1, kMotion> vertical = Eigen::Matrix<double, 1, kMotion>::Zero();
  vertical[2] = s_th * c_ph * both + 2.0 * c_th * s_ph * thd * phd - c_th * c_ph * felt[2] +
                s_th * s_ph * felt[3];
  vertical[3] = c_th * s_ph * both + 2.0 * s_th * c_ph * thd * phd + s_th * s_ph * felt[2] -
                c_th * c_ph * felt[3];
  vertical[6] = -2.0 * c_th * c_ph * thd + 2.0 * s_th * s_ph * phd;
  vertical[7] = -2.0 * c_th * c_ph * phd + 2.0 * s_th * s_ph * thd;
  vertical[10] = -s_th * c_ph;
  vertical[11] = -c_th * s_ph;
  vertical *= ml;
  ReactionRowsOf<kMotion> rows = ReactionRows<kMotion>(at, body.cart_height, force, vertical);
  rows(2, 0) += 1.0;
  rows(3, 1) += 1.0;
  return rows;
}

// By kBodyParameters. Of the vertical force the point's mass and the length are factors, but for
// what the body weighs.
ReactionRowsOf<kNumBodyParameters> ReactionByBody(const Body& body, const BodyByParameters& by,
                                                  const PosedPendulum<double>& state,
                                                  const Vector4<double>& felt, double gravity,
                                                  const ReactionForce<double>& at) {
  const Eigen::RowVector2d vertical =
      Eigen::RowVector2d::Constant(at.vertical - body.mass * gravity);
  return ReactionRows<2>(at, body.cart_height,
                         InverseDynamicsByBody(body, state.angles, state.qd, felt, gravity),
                         vertical) *
         by;
}

}  // namespace

BodyOnPlatesJacobian::BodyOnPlatesJacobian(const Scene& scene, const ModelOptions& options,
                                           int person, const ParameterSet<double>& p)
    : BodyOnPlates<double>(scene, options, person, p),
      by(BodyJacobian(options, scene.people[person].body, p, options.stance == Stance::kFixed)) {
  PendulumState<double> start;
  start.q = scene.people[person].start.q;
  const PosedPendulum<double> rest(start);
  const Vector4<double> none = Vector4<double>::Zero();
  const ReactionForce<double> at(body, rest.angles, none, none, kGravity, none);
  at_rest_by = ReactionByBody(body, by, rest, none, kGravity, at);
}

PlateVector<double> PlateResidualWithJacobian(
    const PlatePlace& place, const BodyOnPlatesJacobian& on_plates, const ParameterSet<double>& p,
    const PendulumState<double>& state, const Vector4<double>& next_qd, const PlateFrame& measured,
    const ResidualSigmas& sigmas, PlateJacobian* jacobian) {
  const double weight = place.Known() ? measured.weight : 0.0;
  if (weight <= 0.0) {
    jacobian->setZero();
    return PlateVector<double>::Zero();
  }
  const PlateStep<double> step(place, p);
  const double dt = place.scene->dt, gravity = step.ground.gravity;
  const Body& body = on_plates.body;
  const Vector4<double> felt = (next_qd - state.qd) / dt + step.ground.acceleration;
  const PosedPendulum<double> now(state);
  const ReactionForce<double> at(body, now.angles, now.qd, felt, gravity, step.push);
  const ReactionRowsOf<kMotion> rows = ReactionByMotion(body, now, felt, gravity, at);
  jacobian->leftCols<8>() = rows.leftCols<8>();
  jacobian->middleCols<4>(4) -= rows.rightCols<4>() / dt;
  jacobian->middleCols<4>(8) = rows.rightCols<4>() / dt;
  auto by_body = jacobian->middleCols<kNumBodyParameters>(12);
  by_body = ReactionByBody(body, on_plates.by, now, felt, gravity, at);
  by_body.bottomRows<2>() -= on_plates.at_rest_by.bottomRows<2>();
  jacobian->rightCols<1>().setZero();
  if (place.options->body == BodyModel::kTable) {
    const Vector4<double> force = -step.measured_push;
    jacobian->rightCols<1>() =
        ReactionRows<1>(at, body.cart_height, force, Eigen::Matrix<double, 1, 1>(0.0));
  }
  jacobian->topRows<2>() /= sigmas.shear;
  jacobian->bottomRows<2>() /= sigmas.centre;
  const PlateVector<double> r = RawPlateResidual<double>(ReactionOn(at, body.cart_height, state.q),
                                                         on_plates.at_rest, measured, sigmas);
  return RobustlyWeighted(r, weight, sigmas.robust, jacobian);
}

}  // namespace pushid
