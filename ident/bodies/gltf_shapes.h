// ident: the shapes that a glTF file draws with, as triangles.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

namespace pushid {

class GltfShape {
 public:
  // From the origin to (0, 1, 0), one unit thick on either side a fifth of the way up.
  static GltfShape Octahedron() {
    GltfShape shape;
    const Eigen::Vector3f low(0, 0, 0), high(0, 1, 0);
    const Eigen::Vector3f ring[] = {{1, 0.2f, 0}, {0, 0.2f, -1}, {-1, 0.2f, 0}, {0, 0.2f, 1}};
    for (int i = 0; i < 4; ++i) {
      const Eigen::Vector3f &a = ring[i], &b = ring[(i + 1) % 4];
      shape.Add(b, a, low);
      shape.Add(a, b, high);
    }
    return shape;
  }

  // One unit long each way: from y = 0 upwards, the others about zero.
  static GltfShape Box() {
    GltfShape shape;
    const Eigen::Vector3f middle(0, 0.5f, 0);
    for (int axis = 0; axis < 3; ++axis) {
      for (const float side : {-0.5f, 0.5f}) {
        const Eigen::Vector3f out = side * Eigen::Vector3f::Unit(axis);
        const Eigen::Vector3f u = 0.5f * Eigen::Vector3f::Unit((axis + 1) % 3);
        const Eigen::Vector3f v = 2.0f * out.cross(u);  // so that u, v and out are right-handed
        const Eigen::Vector3f face = middle + out;
        shape.Add(face - u - v, face + u - v, face + u + v);
        shape.Add(face - u - v, face + u + v, face - u + v);
      }
    }
    return shape;
  }

  std::vector<float> places, normals;

 private:
  // Counter-clockwise, seen from outside.
  void Add(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
    const Eigen::Vector3f normal = (b - a).cross(c - a).normalized();
    for (const Eigen::Vector3f& corner : {a, b, c}) {
      places.insert(places.end(), corner.data(), corner.data() + 3);
      normals.insert(normals.end(), normal.data(), normal.data() + 3);
    }
  }
};

}  // namespace pushid
