// datasets: adding up segments.
#include "datasets/loading/segment_masses.h"

#include <Eigen/Geometry>
#include <cmath>

#include "models/restoration/body.h"
#include "models/standing.h"

namespace pushid {
namespace {

// A share of the body's mass, its centre on the way from one joint to another, and its radius of
// gyration over that way.
struct Segment {
  int from, to;
  double mass, centre, gyration;
};
constexpr double kFoot = 0.0133;  // each
constexpr Segment kSegments[] = {{kNeck, kBodyHead, 0.0681, 0.5, 0.29},
                                 {kNeck, kBodyHip, 0.4302, 0.432, 0.365},
                                 {kRightShoulder, kRightElbow, 0.0263, 0.576, 0.28},
                                 {kLeftShoulder, kLeftShoulder + 1, 0.0263, 0.576, 0.28},
                                 {kRightElbow, kRightWrist, 0.0209, 0.6, 0.35},  // with the hand
                                 {kLeftShoulder + 1, kLeftWrist, 0.0209, 0.6, 0.35},
                                 {kRightHip, kRightKnee, 0.1447, 0.385, 0.35},
                                 {kLeftHip, kLeftKnee, 0.1447, 0.385, 0.35},
                                 {kRightKnee, kRightAnkle, 0.0457, 0.444, 0.26},
                                 {kLeftKnee, kLeftAnkle, 0.0457, 0.444, 0.26}};

// Of an average body, over the rod: thigh and shank together, their first moment, and what is
// above.
constexpr double kLegs = 0.3808, kLegsMoment = 0.2595, kAbove = 0.5926, kOfShoulders = 0.6;

MassDistribution Average() {
  const double r = kComOverHip * std::sqrt(kInertiaRatio - 1.0);
  return {1.0 - kMassAboveAnkles, kComOverHip, r};
}

// How far the shoulders are above the hip, m; 0: not seen.
double ShouldersAboveHip(const RecordedPerson& person) {
  double height = 0.0;
  int seen = 0;
  for (int role : {static_cast<int>(kRightShoulder), static_cast<int>(kLeftShoulder)}) {
    for (int joint : person.roles.joints[role]) {
      height += person.joints[0][joint].z() - person.hip[0].z();
      ++seen;
    }
  }
  return seen > 0 ? height / seen : 0.0;
}

}  // namespace

MassDistribution MassesOf(const RecordedPerson& person) {
  MassDistribution average = Average();
  if (person.joints.empty()) return average;
  const Eigen::Vector3d ankles = 0.5 * (person.left_ankle[0] + person.right_ankle[0]);
  const Eigen::Vector3d rod = person.hip[0] - ankles;
  const double length = rod.norm();
  if (!UnfilledRoles(person.roles).empty()) {
    const double shoulders = ShouldersAboveHip(person);
    if (shoulders <= 0.0) return average;
    const double com =
        (kLegsMoment + kAbove * (1.0 + kOfShoulders * shoulders / length)) / (kLegs + kAbove);
    average.gyration *= com / average.com;
    average.com = com;
    return average;
  }
  const Pose pose = PoseOf(person.roles, person.joints[0]);
  double mass = 0.0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  const auto centre = [&pose](const Segment& s) -> Eigen::Vector3d {
    return pose.col(s.from) + s.centre * (pose.col(s.to) - pose.col(s.from));
  };
  for (const Segment& s : kSegments) {
    mass += s.mass;
    moment += s.mass * (centre(s) - ankles);
  }
  const Eigen::Vector3d com = moment / mass;
  // About the axis from ankle to ankle, about which people sway.
  const Eigen::Vector3d across = person.left_ankle[0] - person.right_ankle[0];
  const Eigen::Vector3d axis =
      across.norm() > 0.0 ? Eigen::Vector3d(across.normalized()) : Eigen::Vector3d::UnitY();
  double inertia = 0.0;
  for (const Segment& s : kSegments) {
    const Eigen::Vector3d from_com = centre(s) - ankles - com;
    const double own = s.gyration * (pose.col(s.to) - pose.col(s.from)).norm();
    inertia += s.mass * (axis.cross(from_com).squaredNorm() + own * own);
  }
  return {2.0 * kFoot, com.dot(rod) / (length * length), std::sqrt(inertia / mass) / length};
}

bool IsAverage(const MassDistribution& masses) {
  const MassDistribution average = Average();
  return masses.com == average.com && masses.gyration == average.gyration;
}

}  // namespace pushid
