// residuals: derivatives of feet that stand and step (models/stance.h), and of those that hold
// (models/standing.h), beside those of the rollout (rollout_sensitivities.h).
//
// With v' = v + dt a the cart's velocity after a step, u that of the feet and D the ground's
// resistance, which is constant,
//   (M + dt D E) da = d(F - C - G) at fixed a - D (dv - du),   E = diag(1, 1, 0, 0).
// The torques, u and the feet after the step are a long formula of few numbers: jets over the
// columns themselves (residuals/lanes/stance_jet_loops.h). Which foot steps has no derivative
// (models/stance.h). Rejected: jets over the numbers, and products with their derivatives, which
// take half as long again.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/net_force.h"
#include "residuals/lanes/person_lanes.h"
#include "residuals/normal_equations.h"
#include "residuals/parameter_map.h"

namespace pushid {

struct PerceivedJacobian;
using ForceColumns = Eigen::Matrix<double, 4, Eigen::Dynamic, Eigen::RowMajor>;

// The feet of everybody in a scene.
class StanceSensitivities {
 public:
  // entries: by person; columns: a multiple of kGramBlock.
  StanceSensitivities(const std::vector<std::vector<ColumnEntry>>& entries, int num_columns);

  // The hip as it is perceived, and rows of its [q, qd] by the columns.
  struct Hip {
    Hip(const PosedPendulum<double>& state, const double* rows);
    PerceivedHip at;
    const double* by_column;
  };
  // One step of a person. by_feet: kFeetStates rows by the columns, next_by_feet those after the
  // step. by_column: of the force, where own forces act: what D u and the torques change by is
  // added.
  void Advance(const SelfForce& self, const ParameterSet<double>& p, int person, const Hip& ankle,
               const Hip& step, const FeetState<double>& feet, const double* by_feet, bool acts,
               double* next_by_feet, ForceColumns* by_column);

 private:
  std::vector<RowMajorMatrix> by_parameter_;  // of StanceParameters, by person
  ForceColumns of_forces_;
};

// Of F - D v' at fixed acceleration a, without the torques and what others do. Columns of what no
// force of a person alone has stay zero (SelfJacobian).
void NetForceJacobianOfStance(const Scene& scene, const ModelOptions& options,
                              const SelfForce& self, const ParameterSet<double>& p, int person,
                              int frame, const PosedPendulum<double>& state,
                              SelfForce::Jacobian* jacobian);

// Of feet that hold, whatever happens; jacobian: of what the ankles and the ground do,
// without what the height of the centre of mass changes of M a + C + G (net_force_jacobian.h).
// perceived, by_perceived: as NetForceJacobian has them.
void NetForceJacobianOfStanding(const Scene& scene, const ModelOptions& options,
                                const SelfForce& self, const ParameterSet<double>& p, int person,
                                int frame, const PendulumState<double>& state,
                                SelfForce::Jacobian* jacobian,
                                const Perceived<double>* perceived = nullptr,
                                PerceivedJacobian* by_perceived = nullptr);

}  // namespace pushid
