// datasets: doubts about recordings.
#include "datasets/inspection/plausibility.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

constexpr double kStrongPush = 1000.0;                   // N
constexpr double kStandsOut = 3.0;                       // times the largest of the other rows
constexpr double kShortRod = 0.6, kLongRod = 1.2;        // m
constexpr double kSeen = 0.5;                            // s after the push began
constexpr double kMoved = 0.05;                          // m; less has no direction
constexpr double kMovedBefore = 0.1;                     // m; people sway by less
constexpr double kFastest = 10.0;                        // m/s
constexpr double kFacesElsewhere = 75.0 * M_PI / 180.0;  // rad; one foot may be ahead
constexpr double kElsewhere = 60.0 * M_PI / 180.0;       // rad between push and way

double Horizontal(const Eigen::Vector4d& row) { return row.head<2>().norm(); }

double WholeDegrees(double radians) { return std::round(radians * 180.0 / M_PI); }

// What is doubted of each kind, and what to ask.
struct Doubt {
  const char *what, *advice;
};
constexpr Doubt kDoubts[] = {
    {"the push is above 1 kN",
     "people rarely push so hard: is its unit N, and is its window right?"},
    {"the push's first row stands out",
     "the person already moves when the push begins: see pushid-push --initial_velocity"},
    {"the person moves in another direction than the push",
     "are `up` and `forward` right, and the push's sign?"},
    {"the person moves before being pushed", "is the push's start right, and the sensor's clock?"},
    {"the hip is implausibly fast", "does a marker jump there, and are unit and fps right?"},
    {"according to the ankles people do not face forward",
     "are `up` and `forward` right, and the ankles not exchanged?"},
    {"the distance between hip and ankles is implausible", "are `joints` and the unit right?"},
};

// rad between the push's impulse and where the hip goes; 0 where either is nothing.
double AngleToWay(const Recording& recording, const Push& push) {
  const std::vector<Eigen::Vector3d>& hip = recording.people[push.person].hip;
  const int end = std::min<int>(static_cast<int>(hip.size()) - 1,
                                push.start_frame + static_cast<int>(kSeen * recording.fps));
  Eigen::Vector2d impulse = Eigen::Vector2d::Zero();
  for (const Eigen::Vector4d& row : push.force) impulse += row.head<2>();
  const Eigen::Vector2d way = (hip[end] - hip[push.start_frame]).head<2>();
  if (way.norm() < kMoved || !(impulse.norm() > 0.0)) return 0.0;
  return std::acos(std::clamp(impulse.normalized().dot(way.normalized()), -1.0, 1.0));
}

// rad between forward and where the person faces by the line between the ankles, +-; 0 where they
// stand too close to say it.
double FacingAngle(const RecordedPerson& person) {
  const Eigen::Vector2d to_the_left = (person.left_ankle[0] - person.right_ankle[0]).head<2>();
  if (to_the_left.norm() < kMoved) return 0.0;
  return std::atan2(-to_the_left.x(), to_the_left.y());
}

}  // namespace

bool FirstRowStandsOut(const Push& push) {
  if (push.force.size() < 3) return false;
  double others = 0.0;
  for (size_t t = 1; t < push.force.size(); ++t) {
    others = std::max(others, Horizontal(push.force[t]));
  }
  return Horizontal(push.force[0]) > kStandsOut * others;
}

void PlausibilityCheck::Look(const Recording& recording) {
  for (const Push& push : recording.pushes) {
    double peak = 0.0;
    for (const Eigen::Vector4d& row : push.force) peak = std::max(peak, Horizontal(row));
    if (peak > kStrongPush) Add(kStrong, recording.id, peak, "N");
    if (FirstRowStandsOut(push)) Add(kFirstRow, recording.id, Horizontal(push.force[0]), "N");
    const double angle = AngleToWay(recording, push);
    if (angle > kElsewhere) Add(kWay, recording.id, WholeDegrees(angle), "degrees off");
  }
  LookAtOnset(recording);
  LookAtFacing(recording);
  for (const RecordedPerson& person : recording.people) {
    LookAtSpeed(recording, person);
    const double rod =
        (person.hip[0] - 0.5 * (person.left_ankle[0] + person.right_ankle[0])).norm();
    if (rod >= kShortRod && rod <= kLongRod) continue;
    Add(kRod, recording.id + ", " + person.subject_id, rod, "m");
  }
}

void PlausibilityCheck::LookAtFacing(const Recording& recording) {
  for (const RecordedPerson& person : recording.people) {
    const double facing = std::fabs(FacingAngle(person));
    if (facing <= kFacesElsewhere) continue;
    Add(kFacing, recording.id + ", " + person.subject_id, WholeDegrees(facing), "degrees off");
  }
}

void PlausibilityCheck::LookAtOnset(const Recording& recording) {
  if (recording.pushes.empty()) return;
  const Push& first =
      *std::min_element(recording.pushes.begin(), recording.pushes.end(),
                        [](const Push& a, const Push& b) { return a.start_frame < b.start_frame; });
  const std::vector<Eigen::Vector3d>& hip = recording.people[first.person].hip;
  const double way = (hip[first.start_frame] - hip[0]).head<2>().norm();
  if (way > kMovedBefore) Add(kEarly, recording.id, way, "m");
}

void PlausibilityCheck::LookAtSpeed(const Recording& recording, const RecordedPerson& person) {
  double speed = 0.0;
  int fastest = 0;
  for (int t = 1; t < recording.num_frames(); ++t) {
    const double now = (person.hip[t] - person.hip[t - 1]).norm() * recording.fps;
    if (now > speed) speed = now, fastest = t;
  }
  if (speed <= kFastest) return;
  Add(kJump, recording.id + ", frame " + std::to_string(fastest) + ", " + person.subject_id, speed,
      "m/s");
}

void PlausibilityCheck::Add(Kind kind, const std::string& who, double value, const char* unit) {
  cases_[kind].push_back(who + ": " +
                         (value > 100.0 ? std::to_string(std::lround(value)) : Rounded(value, 3)) +
                         " " + unit);
}

std::vector<std::string> PlausibilityCheck::Warnings() const {
  static_assert(std::size(kDoubts) == kNumKinds);
  std::vector<std::string> warnings;
  for (int kind = 0; kind < kNumKinds; ++kind) {
    const std::size_t count = cases_[kind].size();
    if (count == 0) continue;
    warnings.push_back(kDoubts[kind].what + (" in " + std::to_string(count)) +
                       (count == 1 ? " case (" : " cases (") + ListOfNames(cases_[kind]) + "); " +
                       kDoubts[kind].advice);
  }
  return warnings;
}

}  // namespace pushid
