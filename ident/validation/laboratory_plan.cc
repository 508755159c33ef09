// ident: what a laboratory's equipment would tell: force platforms under the same recordings, and
// as many recordings again on a platform that moves, with force platforms or without.
//
// With H the Hessian of the cost, of which priors are the part P, V the covariance of the data's
// scatter, clustered by person (or by recording, where nobody was recorded twice), sigma^2 the
// variance of rows and I the information of those to come (their J'J, rolled out at the estimate),
// what scatters today's estimate has today's weight among all rows, and the rows to come scatter by
// their noise:
//   V' = (H + I)^-1 (H V H + P + sigma^2 I) (H + I)^-1 + B,   over the same without I and B
// B: what people evidently differ by, over their number, which no equipment makes smaller: a 90 %
// lower bound, since the estimate itself is mostly noise where little is known yet. Rejected: V - N
// + (N^-1 + I)^-1, N = H^-1, which keeps all that is not noise today (promised 0.9 where 0.03
// came). Platforms are taken as exact to 3 N and 2 mm of the centre of pressure, or as those of the
// fit are.
#include <algorithm>
#include <cmath>

#include "datasets/synthetic/synthetic_recordings.h"
#include "ident/prediction/prediction.h"
#include "ident/problem/fit_problem.h"
#include "ident/problem/jacobian_blocks.h"
#include "ident/uncertainty/covariance.h"
#include "ident/validation/study_plan.h"
#include "models/decompositions.h"
#include "models/rollout.h"

namespace pushid {
namespace {

using Eigen::MatrixXd;

constexpr double kPlannedShear = 3.0, kPlannedCentre = 0.002;  // N, m
constexpr double kStep = 0.04, kSway = 0.01;                   // m, of each sine

void AddPlates(PendulumRecording* r) {
  r->plates.assign(r->num_people(), {});
  for (int n = 0; n < r->num_people(); ++n) {
    PlateFrame frame;
    frame.weight = 1.0;
    r->plates[n].assign(r->num_frames(), frame);
  }
}

// The recording as it would be on the platform; nothing where somebody falls.
bool OnPlatform(const FitProblem& problem, const FitPoint& estimate, GroundKind platform,
                PendulumRecording* r) {
  const Eigen::Vector2d along = PushDirection(*r);
  r->scene.pushes.clear();
  r->scene.ground =
      GroundThrough(SyntheticGround(platform, platform == GroundKind::kStep ? kStep : kSway,
                                    r->num_frames(), r->scene.dt, along),
                    r->scene.dt);
  IdentifiedModel model;
  model.options = problem.options().model;
  model.options.directions = Directions::kAxes;  // the problem's are turned already
  model.parameters = problem.Parameters(estimate, "");
  for (ScenePerson& person : r->scene.people) person.start.qd.setZero();
  RolloutPath<double> path;
  if (!Rollout<double>(r->scene, model.options, {model.parameters}, InitialVelocities(r->scene),
                       r->num_frames(), &path)
           .ok) {
    return false;
  }
  for (int n = 0; n < r->num_people(); ++n) {
    const Body& body = r->scene.people[n].body;
    for (int t = 0; t < r->num_frames(); ++t) {
      r->states[n][t] = path.At(t, n);
      r->hip[n][t] = HipPosition(body, path.At(t, n).q);
    }
  }
  r->weight.clear();
  r->plates.clear();
  return true;
}

// J'J of recordings with the fit's weights, over the shared parameters; of their platforms alone
// where `base` has the same recordings without.
MatrixXd Information(const FitProblem& problem, const FitPoint& estimate,
                     const std::vector<PendulumRecording>& recordings) {
  FitOptions options = problem.options();
  for (ParameterSpec& spec : options.table.specs) spec.prior.reset();
  options.settling_weight = options.mode_weight = 0.0;
  options.model.directions = Directions::kAxes;
  if (options.model.body == BodyModel::kAnthropometric) options.model.body = BodyModel::kLdp;
  if (!std::any_of(problem.recordings().begin(), problem.recordings().end(),
                   [](const PendulumRecording& r) { return r.HasPlates(); })) {
    options.sigmas.shear = kPlannedShear;
    options.sigmas.centre = kPlannedCentre;
  }
  const FitProblem planned(recordings, options);
  FitPoint point = planned.NominalPoint();
  point.shared = estimate.shared;
  const MatrixXd jacobian = EvaluateJacobianBlocks(planned.Build(&point, 0))
                                .jacobian.leftCols(problem.map().num_shared());
  return jacobian.transpose() * jacobian;
}

// B of the header, its diagonal: zero where nobody was recorded twice.
Eigen::VectorXd SpreadOfPeople(const ErrorParts& parts, const std::vector<int>& known) {
  Eigen::VectorXd spread = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(known.size()));
  if (parts.by_person.size() == 0 || parts.by_recording.size() == 0) return spread;
  const double freedom = *std::max_element(parts.person.begin(), parts.person.end());
  if (freedom + 1 == parts.num_recordings()) return spread;
  // The 90 % quantile of chi^2 over its freedom (Wilson and Hilferty 1931).
  const double ninth = 2.0 / (9.0 * freedom);
  const double quantile = std::pow(1.0 - ninth + 1.2816 * std::sqrt(ninth), 3);
  for (Eigen::Index k = 0; k < spread.size(); ++k) {
    const int at = known[static_cast<size_t>(k)];
    spread[k] = std::max(0.0, parts.by_person(at, at) / quantile - parts.by_recording(at, at));
  }
  return spread;
}

}  // namespace

std::vector<EquipmentRow> PlanEquipment(const FitProblem& problem, const FitPoint& estimate,
                                        const ErrorParts& parts, const std::vector<int>& known) {
  std::vector<EquipmentRow> rows;
  if (known.empty() || parts.sigma <= 0.0) return rows;
  const MatrixXd& clustered = parts.by_person.size() > 0 ? parts.by_person : parts.by_recording;
  if (clustered.size() == 0) return rows;
  // In units of the rows' weights, of which noise has the variance sigma^2.
  const double noise = parts.sigma * parts.sigma;
  const MatrixXd present = noise * Inverse(parts.naive(known, known));
  const MatrixXd data = clustered(known, known);
  const MatrixXd priors = InformationBeside(parts.score)(known, known);
  const MatrixXd scatter = present * data * present + priors, now_inverse = Inverse(present);
  const MatrixXd now = now_inverse * scatter * now_inverse;
  const Eigen::VectorXd differ = SpreadOfPeople(parts, known);
  const auto add = [&](const std::string& equipment, const MatrixXd& rows_to_come) {
    const MatrixXd more = rows_to_come(known, known);
    const MatrixXd inverse = Inverse(present + more);
    const MatrixXd then = inverse * (scatter + noise * more) * inverse;
    EquipmentRow row{equipment, {}};
    for (Eigen::Index k = 0; k < differ.size(); ++k) {
      row.error_ratio.push_back(std::sqrt((then(k, k) + differ[k]) / now(k, k)));
    }
    rows.push_back(std::move(row));
  };
  std::vector<PendulumRecording> same = problem.recordings();
  const bool plates = std::any_of(same.begin(), same.end(),
                                  [](const PendulumRecording& r) { return r.HasPlates(); });
  if (!plates) {
    const MatrixXd without = Information(problem, estimate, same);
    for (PendulumRecording& r : same) AddPlates(&r);
    add("force platforms under the same recordings",
        Information(problem, estimate, same) - without);
  }
  for (GroundKind platform : {GroundKind::kStep, GroundKind::kSumOfSines}) {
    std::vector<PendulumRecording> moved = problem.recordings();
    bool stand = true;
    for (PendulumRecording& r : moved) {
      stand = stand && OnPlatform(problem, estimate, platform, &r);
    }
    if (!stand) continue;
    const std::string name = platform == GroundKind::kStep
                                 ? "as many recordings on ground that steps 4 cm"
                                 : "as many recordings on ground that sways (five sines of 1 cm)";
    if (!plates) add(name, Information(problem, estimate, moved));
    for (PendulumRecording& r : moved) AddPlates(&r);
    add(name + ", with force platforms", Information(problem, estimate, moved));
  }
  return rows;
}

}  // namespace pushid
