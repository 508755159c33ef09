// datasets: points of a motion file with their gaps, and the steps of the feet among them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "datasets/formats/point_motion.h"
#include "datasets/loading/foot_steps.h"
#include "datasets/manifest/joint_choice.h"

namespace pushid {

// Frames in which all of the chosen points were seen have their mean, others NaN.
std::vector<Eigen::Vector3d> MeanOf(const PointMotion& motion, const std::vector<int>& chosen);

// Frames on end in which one of the chosen points was not seen.
int LongestHidden(const PointMotion& motion, const std::vector<int>& chosen);

// `to_project` takes the file's coordinates to metres, z up, x where the person faces.
PersonSteps StepsOf(const PointMotion& motion, const PendulumJoints& joints,
                    const Eigen::Matrix3d& to_project);

}  // namespace pushid
