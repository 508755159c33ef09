// residuals: bodies on a rollout.
#include "residuals/cost_functions/body_residual.h"

#include <algorithm>
#include <cmath>

#include "models/learned_terms.h"

namespace pushid {
namespace {

constexpr int kRows = 3 * kBodyJoints;

std::vector<Pose> FirstPoses(const std::vector<BodyMotion>& motions) {
  std::vector<Pose> poses;
  for (const BodyMotion& motion : motions) poses.push_back(motion.front());
  return poses;
}

// Of q, rod length and cart height h = h_0 - lift rod of one person, frame by frame.
BodyTangent::PathDerivatives OfPerson(const RolloutProblem& problem,
                                      const SensitivityInputs& inputs,
                                      const RolloutPath<double>& path,
                                      const RolloutSensitivities& sensitivities, int person) {
  const bool rod_moves = RodMoves(problem.options);
  const double lift = inputs.parameters[person][kRodLift];
  BodyTangent::PathDerivatives derivatives;
  for (int t = 0; t < problem.horizon; ++t) {
    BodyTangent::PathBlock by =
        BodyTangent::PathBlock::Zero(BodyTangent::kPathRows, inputs.num_columns);
    by.topRows<4>() = sensitivities.At(t, person).topRows<4>();
    if (rod_moves) {
      by.row(4) = sensitivities.Rod(t, person);
      by.row(5) = -lift * by.row(4);
      for (const ColumnEntry& entry : inputs.entries[person]) {
        if (entry.parameter != kRodLift) continue;
        by(5, entry.column) -= entry.derivative * path.At(t, person).rod;
      }
    }
    derivatives.push_back(std::move(by));
  }
  return derivatives;
}

}  // namespace

BodyResidual::BodyResidual(std::shared_ptr<const RolloutProblem> rollout,
                           std::shared_ptr<const BodyData> data, double body_weight)
    : CondensedRows(std::move(rollout)),
      data_(std::move(data)),
      motions_(data_->motions.at(problem().recording->id)),
      people_(PeopleOf(problem().recording->scene, FirstPoses(motions_))),
      scale_(std::sqrt(body_weight * kBodyStride)) {
  const int recorded = static_cast<int>(motions_.front().size());
  for (int t = kBodyStride; t < std::min(problem().horizon, recorded); t += kBodyStride) {
    frames_.push_back(t);
  }
}

int BodyResidual::num_rows() const {
  return static_cast<int>(frames_.size()) * num_people() * kRows;
}

void BodyResidual::RowsOfFrame(const BodyTangent::Joints& joints, int frame, int person,
                               double weight, Eigen::VectorXd* residuals,
                               RowMajorMatrix* rows) const {
  const ResidualSigmas& sigmas = problem().sigmas;
  const double sigma = sigmas.hip * std::sqrt(static_cast<double>(kBodyJoints));
  const Eigen::Map<const Eigen::VectorXd> recorded(motions_[person][frame].data(), kRows);
  const Eigen::VectorXd r = (joints.positions - recorded) / sigma;
  *rows = joints.derivatives / sigma;
  *residuals = RobustlyWeighted(r, weight, sigmas.OfFrames(), rows);
}

RolloutStatus BodyResidual::Visit(double const* const* blocks, Derivatives derivatives,
                                  const RowsVisitor& visit) const {
  thread_local RolloutPath<double> path;
  thread_local RolloutSensitivities sensitivities;
  SensitivityInputs inputs;
  const RolloutStatus status =
      RollOut(problem(), blocks, derivatives, &inputs, &path, &sensitivities);
  if (!status.ok) return status;
  const bool with_rows = derivatives != Derivatives::kNone;
  Eigen::VectorXd residuals;
  RowMajorMatrix rows(kRows, with_rows ? inputs.num_columns : 0);
  for (int n = 0; n < num_people(); ++n) {
    RestorationInput person = people_[n];
    const double lift = inputs.parameters[n][kRodLift];
    for (int t = 0; t < problem().horizon; ++t) {
      person.Follow(path.At(t, n), RodMoves(problem().options), lift);
    }
    BodyTangent::PathDerivatives by_path;
    if (with_rows) by_path = OfPerson(problem(), inputs, path, sensitivities, n);
    const auto joints = data_->restoration->At(person, by_path, frames_);
    for (size_t k = 0; k < frames_.size(); ++k) {
      const double weight = problem().weight * problem().recording->Weight(n, frames_[k]) * scale_;
      RowsOfFrame(joints[k], frames_[k], n, weight, &residuals, &rows);
      visit({n, weight, kRows, residuals.data(), rows.data()});
    }
  }
  return status;
}

}  // namespace pushid
