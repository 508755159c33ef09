// datasets: the joints or markers of a file as the 22 joints of a body (models/restoration/body.h):
// whatever a skeleton calls its joints, and however many it has, they play roles.
//
// A role that a file lacks is filled from its neighbours, frame by frame, where those say enough:
//   neck           between the shoulders, where head and neck are both lacking;
//   spine, neck    evenly along the straight line between the next ones below and above;
//   head           beyond the neck, on the line from the upper spine;
//   clavicles      half-way from the upper spine to the shoulder;
//   hip joints     from the pelvis markers, by the regression of Bell, Pedersen and Brand (J.
//                  Biomechanics 23, 1990): 36 % of the distance between the anterior iliac spines
//                  to the side, 19 % back and 30 % down from their middle;
//   toes           in front of the ankle, square to the line between the hip joints.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "models/restoration/body.h"

namespace pushid {

// Names of the kBodyJoints, in their order: "hip", "lower_spine", ..., "right_clavicle", ...,
// "left_toe".
const std::vector<std::string>& RoleNames();
inline const std::string& RoleName(int role) { return RoleNames()[role]; }

struct BodyRoles {
  // Indices into the joints; a role is the mean of its list. Empty: the file lacks it.
  std::array<std::vector<int>, kBodyJoints> joints;
  // Anterior iliac spines and the middle of the posterior ones (or the sacrum), for hip joints that
  // are lacking; empty: not known.
  std::vector<int> left_asis{}, right_asis{}, back{};

  bool Has(int role) const { return !joints[role].empty(); }
  // The joint that plays the role by itself; -1: none.
  int Single(int role) const { return joints[role].size() == 1 ? joints[role][0] : -1; }
};

// Roles that are lacking and that no neighbour fills; empty: there is a body.
std::vector<int> UnfilledRoles(const BodyRoles& roles);
// Roles that are lacking and filled.
std::vector<int> FilledRoles(const BodyRoles& roles);
// "left_knee, right_knee".
std::string RoleList(const std::vector<int>& roles);

// A frame's joints, m, z up, as a body; nothing may be unfilled.
Pose PoseOf(const BodyRoles& roles, const std::vector<Eigen::Vector3d>& joints);

}  // namespace pushid
