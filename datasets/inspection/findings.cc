// datasets: doubts about recordings.
#include "datasets/inspection/findings.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/inspection/push_and_motion.h"

namespace pushid {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kAside = 60.0 * kDegree, kAgainst = 120.0 * kDegree;
constexpr double kTooMuch = 3.0, kTooLittle = 0.25;           // of an external push
constexpr double kNetFactor = 3.0;                            // of a net one, either way
constexpr double kStrongPush = 1000.0;                        // N
constexpr double kStandsOut = 3.0;                            // times the largest of the other rows
constexpr double kLightest = 25.0, kHeaviest = 130.0;         // kg
constexpr double kStature = 2.0;                              // over the rod
constexpr double kThinnest = 10.0, kFattest = 45.0;           // kg/m^2
constexpr double kShortRod = 0.5, kLongRod = 1.3;             // m
constexpr double kFastest = 10.0;                             // m/s
constexpr double kSlowestRate = 10.0, kFastestRate = 2000.0;  // 1/s
constexpr double kFacesElsewhere = 75.0 * kDegree;            // one foot may be ahead
constexpr double kApart = 0.05;                               // m; closer ankles say nothing
constexpr std::size_t kNamedCases = 4;                        // cases of a sentence

double HorizontalForce(const Vector4<double>& row) { return row.head<2>().norm(); }

bool SameMotion(const PendulumRecording& a, const PendulumRecording& b) {
  if (a.id == b.id) return false;
  if (!a.content_hash.empty() && a.content_hash == b.content_hash) return true;
  return a.num_frames() > 0 && a.hip == b.hip;
}

// The findings of one recording.
class Judge {
 public:
  explicit Judge(const PendulumRecording& recording) : r_(recording) {}

  std::vector<Finding> Look() {
    const double rate = 1.0 / r_.scene.dt;
    if (!(rate >= kSlowestRate && rate <= kFastestRate)) Add(FindingKind::kRate, "", rate);
    for (int n = 0; n < r_.num_people(); ++n) {
      LookAtBody(n);
      if (const auto compared = ComparePush(r_, n)) LookAtMotion(n, *compared);
    }
    for (const ScenePush& push : r_.scene.pushes) LookAtRows(push);
    return std::move(found_);
  }

 private:
  void Add(FindingKind kind, const std::string& about, double value) {
    found_.push_back({kind, r_.id, about, value});
  }
  std::string Who(int n) const { return r_.num_people() > 1 ? r_.subject_ids[n] : ""; }

  void LookAtBody(int n) {
    const Body& body = r_.scene.people[n].body;
    const double stature = kStature * body.rod_length;
    const double index = body.mass / (stature * stature);
    const bool rod = body.rod_length >= kShortRod && body.rod_length <= kLongRod;
    if (!rod) Add(FindingKind::kRod, Who(n), body.rod_length);
    if (!(body.mass >= kLightest && body.mass <= kHeaviest) ||
        (rod && !(index >= kThinnest && index <= kFattest))) {
      Add(FindingKind::kMass, r_.subject_ids[n], body.mass);
    }
    double speed = 0.0;
    int fastest = 0;
    for (int t = 1; t < r_.num_frames(); ++t) {
      const double now = (r_.hip[n][t] - r_.hip[n][t - 1]).norm() / r_.scene.dt;
      if (now > speed) speed = now, fastest = t;
    }
    if (speed <= kFastest) return;
    const std::string who = Who(n);
    Add(FindingKind::kSpeed, (who.empty() ? "" : who + ", ") + "frame " + std::to_string(fastest),
        speed);
  }

  void LookAtMotion(int n, const PushAndMotion& motion) {
    const double angle = motion.angle.value_or(0.0), degrees = std::round(angle / kDegree);
    const bool net = std::any_of(r_.scene.pushes.begin(), r_.scene.pushes.end(),
                                 [](const auto& p) { return p.kind != PushKind::kExternal; });
    // Who is moving already when a recording begins may be so.
    const bool moving = r_.initial_velocity != InitialVelocity::kZero;
    if (motion.push_late > 0.0 && !moving) {
      Add(FindingKind::kLate, Who(n), motion.push_late);
    } else if (angle > kAgainst) {
      Add(FindingKind::kAgainst, Who(n), degrees);
    } else if (angle > kAside) {
      Add(FindingKind::kAside, Who(n), degrees);
    } else if (net && !moving &&
               (motion.least_gain > kNetFactor || motion.largest_gain < 1.0 / kNetFactor)) {
      Add(FindingKind::kNetGain, Who(n), motion.gain);
    } else if (!net && (motion.least_gain > kTooMuch || motion.largest_gain < kTooLittle)) {
      Add(FindingKind::kGain, Who(n), motion.gain);
    } else if (motion.push_early > 0.0) {
      Add(FindingKind::kEarly, Who(n), motion.push_early);
    }
  }

  void LookAtRows(const ScenePush& push) {
    double peak = 0.0;
    for (const Vector4<double>& row : push.force) peak = std::max(peak, HorizontalForce(row));
    const std::string who = Who(push.person);
    if (peak > kStrongPush) Add(FindingKind::kStrong, who, peak);
    if (FirstRowStandsOut(push.force))
      Add(FindingKind::kFirstRow, who, HorizontalForce(push.force[0]));
    const double rest = RestingForce(push, r_.scene.dt);
    if (rest > 0.0) Add(FindingKind::kZero, who, rest);
    if (rest == 0.0 && HasNoEnd(push, r_.num_frames())) {
      Add(FindingKind::kNoEnd, who, HorizontalForce(push.force.back()));
    }
  }

  const PendulumRecording& r_;
  std::vector<Finding> found_;
};

std::string Case(const Finding& finding, const char* unit) {
  std::string who = finding.recording;
  if (!finding.about.empty()) who += (who.empty() ? "" : ", ") + finding.about;
  if (finding.kind == FindingKind::kCopy) return finding.recording + " in " + finding.about;
  const double value = finding.value;
  return who + ": " + (value > 100.0 ? std::to_string(std::lround(value)) : Rounded(value, 3)) +
         (*unit != '\0' ? " " : "") + unit;
}

}  // namespace

const std::vector<FindingRow>& Names(FindingKind) {
  using Kind = FindingKind;
  static const std::vector<FindingRow> kRows = {
      {"push against motion", Kind::kAgainst, "the person moves against the push", "degrees off",
       "is the push's sign right, and are `up` and `forward`?", true},
      {"push beside motion", Kind::kAside, "the person moves in another direction than the push",
       "degrees off", "are `up` and `forward` right, and the direction of the push?", true},
      {"impulse", Kind::kGain, "the speed that the push gives is not its impulse over the mass",
       "times it",
       "is the force in N (1 kN = 1000 N, 1 kgf = 9.81 N, 1 lbf = 4.45 N), its gain right, and the "
       "mass in kg?",
       true},
      {"net impulse", Kind::kNetGain,
       "the motion during a net push is not what its force makes of the mass", "times it",
       "was it computed from this motion, with this mass and in N? a measured push is external",
       true},
      {"late push", Kind::kLate, "the person moves before being pushed", "s",
       "is the push's start right (start_frame, first_frame), and the sensor's clock "
       "(pushid-push --sensor_start, --estimate_offset)? a person who moves all the time needs "
       "initial_velocity",
       true},
      {"early push", Kind::kEarly, "the person moves long after being pushed", "s late",
       "is the push's start right (start_frame, first_frame), and the sensor's clock "
       "(pushid-push --sensor_start, --estimate_offset)?",
       true},
      {"force at rest", Kind::kZero, "the force does not return to zero", "N at the end",
       "the sensor has an offset, which counts as a push: subtract it (pushid-push does)", true},
      {"push without an end", Kind::kNoEnd, "the push ends while its force is large",
       "N at the end", "is the record cut off? Give all of it", true},
      {"strong push", Kind::kStrong, "the push is above 1 kN", "N",
       "people rarely push so hard: is its unit N, and is its window right?", false},
      {"first row", Kind::kFirstRow, "the push's first row stands out", "N",
       "the person already moves when the push begins: see pushid-push --initial_velocity", false},
      {"mass", Kind::kMass, "the mass is unusual for the height of the hip", "kg",
       "is mass_kg right, and in kg?", true},
      {"rod", Kind::kRod, "the distance between hip and ankles is implausible", "m",
       "are `joints` and the unit (length_unit) right?", true},
      {"speed", Kind::kSpeed, "the hip is implausibly fast", "m/s",
       "does a marker jump there, and are length_unit and fps right?", true},
      {"frame rate", Kind::kRate, "the frame rate is unusual", "per second",
       "is fps really frames per second?", true},
      {"facing", Kind::kFacing, "according to the ankles people do not face forward", "degrees off",
       "are `up` and `forward` right, and the ankles not exchanged?", true},
      {"copy", Kind::kCopy, "the same motion is repeated", "",
       "copies add nothing and count once: leave them out (--leave_out)", true},
  };
  return kRows;
}

bool FirstRowStandsOut(const std::vector<Vector4<double>>& force) {
  if (force.size() < 3) return false;
  double others = 0.0;
  for (size_t t = 1; t < force.size(); ++t) others = std::max(others, HorizontalForce(force[t]));
  return HorizontalForce(force[0]) > kStandsOut * others;
}

std::vector<Finding> FindingsOf(const PendulumRecording& recording) {
  return Judge(recording).Look();
}

// By the line between the ankles, where it is long enough.
std::vector<Finding> FacingFindings(const Recording& recording) {
  std::vector<Finding> found;
  // Forward is the way of the push: a group that nobody and nothing pushes may face each other.
  const bool moved = !recording.pushes.empty() || !recording.ground.empty();
  if (!moved && recording.people.size() > 1) return found;
  for (const RecordedPerson& person : recording.people) {
    const Eigen::Vector2d to_the_left = (person.left_ankle[0] - person.right_ankle[0]).head<2>();
    const double facing = std::fabs(std::atan2(-to_the_left.x(), to_the_left.y()));
    if (to_the_left.norm() < kApart || facing <= kFacesElsewhere) continue;
    found.push_back(
        {FindingKind::kFacing, recording.id, person.subject_id, std::round(facing / kDegree)});
  }
  return found;
}

std::vector<Finding> FindingsOf(const Recording& recording) {
  std::vector<Finding> found =
      FindingsOf(MakePendulumRecording(recording, SkeletonMapping::kExact));
  for (Finding& finding : FacingFindings(recording)) found.push_back(std::move(finding));
  return found;
}

std::vector<int> CopyOf(const std::vector<PendulumRecording>& recordings) {
  std::vector<int> first(recordings.size(), -1);
  for (size_t i = 0; i < recordings.size(); ++i) {
    for (size_t j = i + 1; first[i] < 0 && j < recordings.size(); ++j) {
      if (first[j] < 0 && SameMotion(recordings[i], recordings[j])) first[j] = static_cast<int>(i);
    }
  }
  return first;
}

std::vector<Finding> FindingsOf(const std::vector<PendulumRecording>& recordings) {
  std::vector<Finding> found;
  for (const PendulumRecording& recording : recordings) {
    for (Finding& finding : FindingsOf(recording)) found.push_back(std::move(finding));
  }
  std::map<int, std::vector<std::string>> copies;
  const std::vector<int> first = CopyOf(recordings);
  for (size_t i = 0; i < first.size(); ++i) {
    if (first[i] >= 0) copies[first[i]].push_back(recordings[i].id);
  }
  for (const auto& [of, ids] : copies) {
    found.push_back(
        {FindingKind::kCopy, recordings[of].id, ListOfNames(ids), static_cast<double>(ids.size())});
  }
  return found;
}

std::vector<Finding> FitFindings(std::vector<Finding> findings) {
  const auto other = [](const Finding& finding) { return !RowOf(finding.kind).in_fits; };
  findings.erase(std::remove_if(findings.begin(), findings.end(), other), findings.end());
  return findings;
}

std::vector<std::string> FindingTexts(const std::vector<Finding>& findings) {
  std::vector<std::string> texts;
  for (const FindingRow& row : Names(FindingKind{})) {
    std::vector<std::string> cases;
    for (const Finding& finding : findings) {
      if (finding.kind == row.value) cases.push_back(Case(finding, row.unit));
    }
    if (cases.empty()) continue;
    const std::string count =
        std::to_string(cases.size()) + (cases.size() == 1 ? " case" : " cases");
    std::string list;
    for (std::size_t i = 0; i < std::min(cases.size(), kNamedCases); ++i) {
      list += (i > 0 ? "; " : "") + cases[i];
    }
    texts.push_back(row.what + (" in " + count) + " (" + list +
                    (cases.size() > kNamedCases ? "; ..." : "") + "); " + row.advice);
  }
  return texts;
}

Warnings FindingWarnings(const std::vector<Finding>& findings) {
  const std::vector<std::string> texts = FindingTexts(findings);
  return {texts.begin(), texts.end()};
}

}  // namespace pushid
