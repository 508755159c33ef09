// ident: moving people as an animated glTF 2.0 file (Khronos; ISO/IEC 12113), for Blender, the
// viewers of Windows and macOS, web pages and game engines.
//
// One scene with a node per person, under it a node per joint with the joint's name, and at each
// joint an octahedron to every child, and one up from a head; a flat box where a foot of a model
// stands, from its landing to its lift-off. Metres, y up, z forward, x to the
// left (the pushed way is +z). One animation: rotations of all joints, translations of the roots,
// and of other joints where bones change their length, so that every joint stands where it is
// wanted at every frame. Nothing outside the file is needed.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "ident/bodies/body_recording.h"

namespace pushid {

struct GltfPerson {
  std::string name;
  std::vector<std::string> joints;
  std::vector<int> parents;  // -1: a root; every parent precedes its children
  Eigen::Matrix3Xd rest;     // m, a column a joint; there all rotations are zero
  int head = -1;             // the joint that is a head; -1: none
  std::vector<PosedJoints> frames;
};

struct GltfFootprint {
  std::string name;
  int person = 0;               // whose colour it has
  Eigen::Vector3d middle;       // on the ground, m
  double heading = 0.0;         // rad, about the upright from forward
  double length = 0.0;          // m
  double from = 0.0, to = 0.0;  // s
};

struct GltfScene {
  std::string name;
  double dt = 1.0 / 60.0;  // s
  bool y_up = false;       // the people's axes are glTF's already; otherwise z up, x forward
  std::vector<GltfPerson> people;
  std::vector<GltfFootprint> footprints = {};
};

// The ending says how: ".glb" binary, otherwise (".gltf") JSON with the numbers in base64.
MaybeError WriteGltf(const std::string& path, const GltfScene& scene);

}  // namespace pushid
