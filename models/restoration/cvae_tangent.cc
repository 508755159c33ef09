// models: LDP's chain with derivatives, in double precision.
#include <cmath>

#include "models/restoration/body_tangent.h"

namespace pushid {
namespace {

using Dual = CvaeTangent::Dual;

Dual StackedDual(const Dual& above, const Dual& below) {
  Dual both{Eigen::VectorXd(above.x.size() + below.x.size()),
            Eigen::MatrixXd(above.dx.rows() + below.dx.rows(), above.dx.cols())};
  both.x << above.x, below.x;
  both.dx << above.dx, below.dx;
  return both;
}

// e^x - 1 below zero, whose slope is e^x.
void EluDual(Dual* v) {
  for (Eigen::Index i = 0; i < v->x.size(); ++i) {
    if (v->x[i] >= 0.0) continue;
    const double e = std::exp(v->x[i]);
    v->x[i] = e - 1.0;
    v->dx.row(i) *= e;
  }
}

void SoftmaxDual(Dual* v) {
  v->x = (v->x.array() - v->x.maxCoeff()).exp();
  v->x /= v->x.sum();
  const Eigen::RowVectorXd common = v->x.transpose() * v->dx;
  v->dx = (v->x.asDiagonal() * (v->dx.rowwise() - common)).eval();
}

// Scaled and held within the limit, beyond which nothing changes.
void ScaleDual(const Scaling& scaling, Dual* v) {
  const Eigen::VectorXd spread = scaling.spread.cast<double>();
  v->x = (v->x - scaling.mean.cast<double>()).cwiseQuotient(spread);
  for (Eigen::Index i = 0; i < v->x.size(); ++i) {
    v->dx.row(i) *= std::abs(v->x[i]) < kLargestScaled ? 1.0 / spread[i] : 0.0;
  }
  v->x = v->x.cwiseMax(-kLargestScaled).cwiseMin(kLargestScaled);
}

Dual Constant(const Eigen::MatrixXf& column, Eigen::Index derivatives) {
  return {column.col(0).cast<double>(), Eigen::MatrixXd::Zero(column.rows(), derivatives)};
}

}  // namespace

CvaeTangent::CvaeTangent(const CvaeWeights& weights)
    : layout_(weights.layout),
      lower_(HalfOf(weights.lower_sampler, weights.lower_decoder, weights.lower)) {
  scalings_.layout = weights.layout;
  scalings_.lower = weights.lower, scalings_.upper = weights.upper;
  scalings_.pendulum = weights.pendulum;
  if (layout_.halves) upper_ = HalfOf(weights.upper_sampler, weights.upper_decoder, weights.upper);
}

CvaeTangent::Half CvaeTangent::HalfOf(const CvaeSampler& sampler, const CvaeDecoder& decoder,
                                      const Scaling& scaling) {
  const auto layer = [](const DenseLayer& from) {
    return Layer{from.weights.cast<double>(), from.bias.cast<double>()};
  };
  const auto& gate = decoder.gate.layers;
  return {{layer(sampler.first), layer(sampler.second), layer(sampler.mean)},
          {layer(gate[0]), layer(gate[1]), layer(gate[2])},
          {layer(decoder.first), layer(decoder.second), layer(decoder.last)},
          scaling.mean.cast<double>(),
          scaling.spread.cast<double>()};
}

Dual CvaeTangent::Affine(const Layer& layer, const Dual& v) {
  return {layer.weights * v.x + layer.bias, layer.weights * v.dx};
}

Dual CvaeTangent::Mixed(const Layer& experts, const Dual& v, const Dual& shares) {
  const Eigen::Index rows = experts.weights.rows() / kExperts;
  const Eigen::VectorXd all = experts.weights * v.x + experts.bias;
  Dual mixed{Eigen::VectorXd::Zero(rows), Eigen::MatrixXd::Zero(rows, v.dx.cols())};
  for (int e = 0; e < kExperts; ++e) mixed.x += shares.x[e] * all.segment(e * rows, rows);
  if (v.dx.cols() == 0) return mixed;
  static_assert(kExperts == 4, "the blend, in one pass over the weights, names every expert");
  const auto of = [&](int e) { return experts.weights.middleRows(e * rows, rows); };
  const Eigen::MatrixXd blend =
      shares.x[0] * of(0) + shares.x[1] * of(1) + shares.x[2] * of(2) + shares.x[3] * of(3);
  mixed.dx.noalias() = blend * v.dx;
  for (int e = 0; e < kExperts; ++e) {
    mixed.dx.noalias() += all.segment(e * rows, rows) * shares.dx.row(e);
  }
  return mixed;
}

Dual CvaeTangent::Next(const Half& half, const Dual& condition, const Dual& pendulum) {
  Dual z = Affine(half.sampler[0], StackedDual(condition, pendulum));
  EluDual(&z);
  z = Affine(half.sampler[1], StackedDual(z, pendulum));
  EluDual(&z);
  z = Affine(half.sampler[2], StackedDual(z, pendulum));
  const Dual inputs = StackedDual(z, condition);
  Dual shares = Affine(half.gate[0], inputs);
  EluDual(&shares);
  shares = Affine(half.gate[1], shares);
  EluDual(&shares);
  shares = Affine(half.gate[2], shares);
  SoftmaxDual(&shares);
  Dual hidden = Mixed(half.experts[0], inputs, shares);
  EluDual(&hidden);
  hidden = Mixed(half.experts[1], StackedDual(z, hidden), shares);
  EluDual(&hidden);
  return Mixed(half.experts[2], StackedDual(z, hidden), shares);
}

// The numbers of PendulumFrames, scaled.
std::vector<Dual> CvaeTangent::Pendulums(const RestorationInput& person,
                                         const PathDerivatives& derivatives) const {
  const double heading = Heading(person.first_pose);
  const Eigen::Matrix3d turn = TurnAboutZ(-heading);
  const Eigen::Index columns = derivatives.empty() ? 0 : derivatives.front().cols();
  std::vector<Dual> all;
  Dual first;
  for (int t = 0; t < static_cast<int>(person.q.size()); ++t) {
    Dual now{Eigen::VectorXd::Zero(kPendulumFrame), Eigen::MatrixXd(kPendulumFrame, columns)};
    now.dx.setZero();
    now.x.head<4>() = TurnedPendulum(person.q[t], -heading);
    now.x.segment<3>(4) = turn * (TipAt(person, t) - person.first_pose.col(0));
    now.x[7] = person.BodyAt(t).rod_length;
    if (columns > 0) {
      now.dx.topRows<4>() = TurnedDerivatives(person.q[t], -heading, derivatives[t]);
      now.dx.middleRows<3>(4) = turn * TipDerivatives(person, t, derivatives[t]);
      now.dx.row(7) = derivatives[t].row(4);
    }
    if (t == 0) first = now;
    now.x.head<2>() -= first.x.head<2>();
    now.dx.topRows<2>() -= first.dx.topRows<2>();
    if (t > 0) {
      now.x.tail<7>() = now.x.head<7>() - all.back().x.head<7>();
      now.dx.bottomRows<7>() = now.dx.topRows<7>() - all.back().dx.topRows<7>();
    }
    all.push_back(std::move(now));
  }
  for (Dual& frame : all) ScaleDual(scalings_.pendulum, &frame);
  return all;
}

BodyTangent::Joints CvaeTangent::JointsOf(const RestorationInput& person, const Dual& lower,
                                          const Dual& upper, const Dual& tip) const {
  const Eigen::Matrix3d turn = TurnAboutZ(Heading(person.first_pose));
  const Eigen::Index columns = lower.dx.cols();
  Joints joints{Eigen::VectorXd(3 * kBodyJoints), Eigen::MatrixXd(3 * kBodyJoints, columns)};
  const auto take = [&](const Half& half, const Dual& frame, const std::vector<int>& of) {
    for (int i = 0; i < static_cast<int>(of.size()); ++i) {
      const int row = 3 + 3 * i;
      const Eigen::Vector3d spread = half.spread.segment<3>(row);
      joints.positions.segment<3>(3 * of[i]) =
          turn * (frame.x.segment<3>(row).cwiseProduct(spread) + half.mean.segment<3>(row));
      joints.derivatives.middleRows(3 * of[i], 3) =
          turn * (spread.asDiagonal() * frame.dx.middleRows(row, 3));
    }
  };
  take(upper_, upper, layout_.UpperJoints());
  take(lower_, lower, layout_.LowerJoints());  // the hip is the lower body's
  const bool ldp = layout_.Origin() == CvaeCoordinates::kLdp;
  const Eigen::Vector3d move = ldp ? Eigen::Vector3d(person.first_pose.col(0))
                                   : Eigen::Vector3d(tip.x - joints.positions.head<3>());
  Eigen::MatrixXd move_by = Eigen::MatrixXd::Zero(3, columns);
  if (!ldp) move_by = tip.dx - joints.derivatives.topRows(3);
  for (int j = 0; j < kBodyJoints; ++j) {
    joints.positions.segment<3>(3 * j) += move;
    joints.derivatives.middleRows(3 * j, 3) += move_by;
  }
  return joints;
}

std::vector<BodyTangent::Joints> CvaeTangent::At(const RestorationInput& person,
                                                 const PathDerivatives& derivatives,
                                                 const std::vector<int>& frames) const {
  const RestorationInput at_rate = Resampled(person, 1.0 / kCvaeRate);
  const int count = static_cast<int>(at_rate.q.size());
  const PathDerivatives by_path =
      derivatives.empty() ? derivatives : ResampledPath(derivatives, person.dt, at_rate.dt, count);
  const std::vector<Dual> pendulums = Pendulums(at_rate, by_path);
  const Eigen::Index columns = derivatives.empty() ? 0 : derivatives.front().cols();
  const BodyFrames first = FramesOf(at_rate, {person.first_pose}, layout_);
  Dual lower = Constant(scalings_.lower.Scaled(first.lower), columns), upper;
  if (layout_.halves) upper = Constant(scalings_.upper.Scaled(first.upper), columns);
  std::vector<Eigen::VectorXd> positions;
  std::vector<Eigen::MatrixXd> by;
  for (int t = 0; t < count; ++t) {
    if (t > 0) {
      lower = Next(lower_, lower, pendulums[t]);
      if (layout_.halves) {
        const int numbers = layout_.LowerPositions();
        const Dual of_lower{lower.x.segment(3, numbers), lower.dx.middleRows(3, numbers)};
        upper = Next(upper_, StackedDual(upper, of_lower), pendulums[t]);
      }
    }
    Dual tip{TipAt(at_rate, t), Eigen::MatrixXd(3, columns)};
    if (columns > 0) tip.dx = TipDerivatives(at_rate, t, by_path[t]);
    Joints joints = JointsOf(at_rate, lower, upper, tip);
    positions.push_back(std::move(joints.positions));
    by.push_back(std::move(joints.derivatives));
  }
  const int recorded = static_cast<int>(person.q.size());
  positions = ResampledPath(positions, at_rate.dt, person.dt, recorded);
  by = ResampledPath(by, at_rate.dt, person.dt, recorded);
  std::vector<Joints> asked;
  for (const int frame : frames) asked.push_back({positions[frame], by[frame]});
  return asked;
}

}  // namespace pushid
