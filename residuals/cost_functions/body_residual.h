// residuals: restored joints against recorded ones, so that what the whole body shows says
// something of friction, gains and push too ("after initialization the whole network can be trained
// as a whole", Yue et al., CVPR 2024).
//
//   rows:   (joint - recorded joint) / (s_hip sqrt(22)) of the 22 joints, 66 a frame: all joints
//           together count as the hip alone does in FrameResidual; times its robust weight over the
//           66, the recording's and the frame's weight, and sqrt(body_weight kBodyStride), for
//           every kBodyStride-th frame.
//   blocks: as rollout_problem.h.
// Joints are those of a restoration on the rollout's path, before any post-processing, rod and cart
// as they move; their Jacobian is the restoration's (models/restoration/body_tangent.h) times the
// rollout's sensitivities.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "models/restoration/body_tangent.h"
#include "residuals/cost_functions/condensed_rollout.h"

namespace pushid {

inline constexpr int kBodyStride = 3;  // frames

// What is known of the bodies: the restoration, and the recorded motions by recording.
struct BodyData {
  std::shared_ptr<const BodyTangent> restoration;
  std::map<std::string, std::vector<BodyMotion>> motions;  // by id; one per person
};

class BodyResidual : public CondensedRows {
 public:
  // problem: of the pendulum, whose weight and sigmas count; the data has its recording.
  BodyResidual(std::shared_ptr<const RolloutProblem> problem, std::shared_ptr<const BodyData> data,
               double body_weight);

  int num_rows() const override;

 protected:
  RolloutStatus Visit(double const* const* blocks, Derivatives derivatives,
                      const RowsVisitor& visit) const override;

 private:
  // Residuals of a frame, and their rows where there are derivatives.
  void RowsOfFrame(const BodyTangent::Joints& joints, int frame, int person, double weight,
                   Eigen::VectorXd* residuals, RowMajorMatrix* rows) const;

  std::shared_ptr<const BodyData> data_;
  const std::vector<BodyMotion>& motions_;
  std::vector<RestorationInput> people_;  // without pendulums
  std::vector<int> frames_;
  double scale_;  // sqrt(body_weight kBodyStride)
};

}  // namespace pushid
