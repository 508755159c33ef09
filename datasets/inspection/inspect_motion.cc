#include "datasets/inspection/inspect_motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/units.h"
#include "datasets/loading/motion_tracks.h"

namespace pushid {
namespace {

using Track = std::vector<Eigen::Vector3d>;

constexpr double kUsualRod = 0.9;                        // m
constexpr double kShortestRod = 0.5, kLongestRod = 1.3;  // m; adults 0.7 to 1.1
constexpr double kJumpSpeed = 12.0;     // m/s; no joint of a pushed person is as fast
constexpr double kSmallestJump = 0.05;  // m; less is noise, however high the rate
constexpr double kStaticSpeed = 0.05;   // m/s of the hip
constexpr double kStaticTime = 0.25;    // s
constexpr double kOnset = 0.02;         // m
constexpr double kFromRest = 0.6;       // speed at first over the largest before the onset
constexpr std::size_t kNamed = 4;       // points named in a warning

std::string Seconds(double s) { return Rounded(s, 3) + " s"; }

std::string SomeOf(std::vector<std::string> texts) {
  const bool more = texts.size() > kNamed;
  if (more) texts.resize(kNamed);
  return ListOfNames(texts) + (more ? ", ..." : "");
}

// The axis that a direction is nearest to.
int LargestAxis(const Eigen::Vector3d& direction) {
  int axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return axis;
}

// "-y": the same with its sign.
std::string AxisName(const Eigen::Vector3d& direction) {
  const int axis = LargestAxis(direction);
  return std::string(direction[axis] < 0.0 ? "-" : "") + "xyz"[axis];
}

constexpr double kTurned = 0.5;    // rad between the ankles' line at first and in the mean
constexpr double kSideways = 0.8;  // rad between the way of a walk and where the person faces
constexpr double kStride = 1.0;    // s, about
constexpr double kWalked = 0.3;    // m; less has no direction

// The axis nearest to the rod.
Eigen::Vector3d UpOf(const Eigen::Vector3d& rod) {
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  const int axis = LargestAxis(rod);
  up[axis] = rod[axis] < 0.0 ? -1.0 : 1.0;
  return up;
}

// Across `up`; zero where it is not seen.
Eigen::Vector3d Across(const Eigen::Vector3d& v, const Eigen::Vector3d& up) {
  return v.allFinite() ? Eigen::Vector3d(v - v.dot(up) * up) : Eigen::Vector3d::Zero();
}

double Angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0));
}

std::string Degrees(double radians) {
  return std::to_string(std::lround(radians * 180.0 / M_PI)) + " degrees";
}

// The farthest that the hip gets, at either end of the recording.
Eigen::Vector3d WayOf(const Track& hip, const Eigen::Vector3d& up, int first) {
  for (size_t t = hip.size(); t-- > static_cast<size_t>(first);) {
    if (hip[t].allFinite()) return Across(hip[t] - hip[first], up);
  }
  return Eigen::Vector3d::Zero();
}

// Frames in which all of the chosen points were seen have their mean, others NaN.
Track MeanOf(const PointMotion& motion, const std::vector<int>& chosen) {
  Track mean(motion.num_frames(), Eigen::Vector3d::Zero());
  for (int index : chosen) {
    for (int t = 0; t < motion.num_frames(); ++t) mean[t] += motion.positions[index][t];
  }
  for (Eigen::Vector3d& position : mean) position /= static_cast<double>(chosen.size());
  return mean;
}

// Frames on end in which one of the chosen points was not seen.
int LongestHidden(const PointMotion& motion, const std::vector<int>& chosen) {
  int longest = 0;
  for (int index : chosen) {
    int run = 0;
    for (const Eigen::Vector3d& position : motion.positions[index]) {
      run = position.allFinite() ? 0 : run + 1;
      longest = std::max(longest, run);
    }
  }
  return longest;
}

struct Facing {
  Eigen::Vector3d to_the_left = Eigen::Vector3d::Zero();
  std::string by;     // "the pelvis", "the ankles"
  std::string doubt;  // empty: none
};

// The facing by the pelvis at frame `first`; without one by the line between the ankles, averaged
// over a second, as one foot is ahead in mid-stride. Doubtful where that line turns, or where the
// person walks to its side. rod: from ankles to hip; metres: of the file's unit.
Facing FacingOf(const PointMotion& motion, const PelvisSides& pelvis, const Track& hip,
                const Track& left, const Track& right, const Eigen::Vector3d& rod, int first,
                double metres) {
  const Eigen::Vector3d up = UpOf(rod);
  Facing facing;
  if (pelvis.known()) {
    const Eigen::Vector3d line =
        MeanOf(motion, pelvis.left)[first] - MeanOf(motion, pelvis.right)[first];
    facing.to_the_left = Across(line, up);
    facing.by = "the pelvis";
    if (!facing.to_the_left.isZero()) return facing;
  }
  const size_t stride = motion.rate_hz > 0.0 ? static_cast<size_t>(kStride * motion.rate_hz) : 1;
  for (size_t t = first; t < std::min(left.size(), first + stride); ++t) {
    facing.to_the_left += Across(left[t] - right[t], up);
  }
  facing.by = "the ankles";
  const Eigen::Vector3d at_first = Across(left[first] - right[first], up);
  const Eigen::Vector3d way = WayOf(hip, up, first);
  const Eigen::Vector3d forward = facing.to_the_left.cross(up);
  if (facing.to_the_left.isZero() || at_first.isZero()) {
    facing.doubt = "the ankles are in one place";
  } else if (Angle(at_first, facing.to_the_left) > kTurned) {
    facing.doubt = "one foot is ahead, or the person turns: the line between the ankles turns by " +
                   Degrees(Angle(at_first, facing.to_the_left));
  } else if (metres * way.norm() > kWalked && Angle(way, forward) > kSideways) {
    facing.doubt = "the hip goes " + Degrees(Angle(way, forward)) + " off it";
  }
  return facing;
}

// `to_project` takes the file's coordinates to metres, z up, x where the person faces.
PersonSteps StepsOf(const PointMotion& motion, const PendulumJoints& joints,
                    const Eigen::Matrix3d& to_project) {
  const auto track = [&](const std::vector<int>& chosen) {
    Track mean = MeanOf(motion, chosen);
    for (Eigen::Vector3d& position : mean) position = to_project * position;
    return mean;
  };
  // Loading does not use a toe or heel that is lost for long either.
  const double gap = PreparationOptions{}.max_gap_s * motion.rate_hz;
  RecordedPerson person;
  for (const PendulumTrack& row : kPendulumTracks) {
    const std::vector<int>& chosen = joints.*row.joints;
    const bool lost = chosen.empty() || LongestHidden(motion, chosen) > gap;
    if (row.required || !lost) person.*row.track = track(chosen);
  }
  return FindSteps(person, motion.rate_hz);
}

class MotionInspector {
 public:
  MotionInspector(const PointMotion& motion, const PelvisSides& pelvis, Inspection* found)
      : motion_(motion), pelvis_(pelvis), found_(*found) {}

  void Look(const std::optional<PendulumJoints>& joints) {
    Rate();
    Gaps();
    if (joints) Body(*joints);
    Jumps();
  }

 private:
  void Rate() {
    const int frames = motion_.num_frames();
    found_.rate_hz = motion_.rate_hz;
    std::string text = std::to_string(frames);
    if (motion_.rate_hz > 0.0) {
      text +=
          " at " + Rounded(motion_.rate_hz) + " per second, " + Seconds(frames / motion_.rate_hz);
      const double whole = WholeFrameRate(motion_.rate_hz);
      if (Rounded(whole) != Rounded(motion_.rate_hz)) {
        text += "; taken as " + Rounded(whole) + " (\"fps\" in the manifest wins)";
      }
      if (motion_.rate_hz < 30.0) {
        found_.Warn("a push lasts only a few frames at " + Rounded(motion_.rate_hz) +
                    " frames per second");
      }
    } else {
      found_.Warn("the file does not give its frame rate: give fps in the manifest");
    }
    found_.Fact("frames", text);
    if (frames < 3) found_.Warn("at least three frames are needed");
  }

  void Gaps() {
    std::vector<std::pair<int, std::string>> hidden;  // frames, point
    for (std::size_t i = 0; i < motion_.positions.size(); ++i) {
      std::vector<bool> seen;
      int missing = 0;
      for (const Eigen::Vector3d& position : motion_.positions[i]) {
        seen.push_back(position.allFinite());
        missing += seen.back() ? 0 : 1;
      }
      if (missing > 0) hidden.emplace_back(missing, motion_.names[motion_.chosen[i]]);
      found_.point_names.push_back(motion_.names[motion_.chosen[i]]);
      found_.seen.push_back(std::move(seen));
    }
    if (hidden.empty()) return;
    std::stable_sort(hidden.begin(), hidden.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<std::string> texts;
    for (const auto& [missing, name] : hidden)
      texts.push_back(name + " " + std::to_string(missing));
    found_.Warn("gaps in " + std::to_string(hidden.size()) + " of " +
                std::to_string(motion_.positions.size()) +
                " points; frames not seen: " + SomeOf(texts));
  }

  void Body(const PendulumJoints& joints) {
    const Track hip = MeanOf(motion_, joints.hip);
    const Track left = MeanOf(motion_, joints.left_ankle);
    const Track right = MeanOf(motion_, joints.right_ankle);
    int first = 0;
    const int frames = motion_.num_frames();
    while (first < frames && !(hip[first] + left[first] + right[first]).allFinite()) ++first;
    Places(joints);
    if (first == frames) {
      found_.Warn("hip and both ankles are never visible together: there is no rod to fit");
      return;
    }
    if (first > 0) {
      found_.Warn("hip and ankles are first seen together at frame " + std::to_string(first) +
                  ": set first_frame to " + std::to_string(first) + " or later");
    }
    const Eigen::Vector3d rod = hip[first] - 0.5 * (left[first] + right[first]);
    Unit(rod.norm());
    const Facing facing = FacingOf(motion_, pelvis_, hip, left, right, rod, first, metres_);
    Axes(rod, facing);
    for (const Eigen::Vector3d& position : hip) {
      found_.hip.push_back(metres_ * (position - hip[first]));
    }
    Onset(first, rod);
    Start(first);
    Steps(joints, facing.to_the_left, rod);
  }

  // Finds steps in the person's own axes, forward where they face.
  void Steps(const PendulumJoints& joints, const Eigen::Vector3d& to_the_left,
             const Eigen::Vector3d& rod) {
    const Result<Eigen::Matrix3d> turn = AxesRotation(up_, AxisName(to_the_left.cross(rod)));
    if (!(motion_.rate_hz > 0.0) || !turn.ok()) return;
    found_.steps = StepsOf(motion_, joints, metres_ * turn.value());
    found_.Fact("steps", StepsText(*found_.steps, motion_.rate_hz));
  }

  void Places(const PendulumJoints& joints) {
    const auto names = [this](const std::vector<int>& chosen) {
      std::string text;
      for (int index : chosen) text += (text.empty() ? "" : " + ") + motion_.names[index];
      return text;
    };
    const auto both = [&](const char* what, const std::vector<int>& left,
                          const std::vector<int>& right) {
      if (left.empty() || right.empty()) return;
      found_.Fact(what, names(left) + " (left), " + names(right) + " (right)");
    };
    found_.Fact("hip", names(joints.hip));
    both("ankles", joints.left_ankle, joints.right_ankle);
    both("toes", joints.left_toe, joints.right_toe);
    for (const std::vector<int>* place : {&joints.hip, &joints.left_ankle, &joints.right_ankle}) {
      for (int index : *place) {
        if (const int longest = LongestHidden(motion_, {index}); longest > 0) {
          found_.Warn(
              motion_.names[index] + " is hidden for up to " + std::to_string(longest) + " frames" +
              (motion_.rate_hz > 0.0 ? " (" + Seconds(longest / motion_.rate_hz) + ")" : "") +
              ": --max_gap_s sets the longest gap that is interpolated");
        }
      }
    }
  }

  // The file's word, otherwise what makes a person of the rod.
  void Unit(double rod) {
    const std::optional<LengthUnit> fits = UnitThatGives(rod, kShortestRod, kLongestRod);
    const LengthUnit unit = motion_.unit ? *motion_.unit : fits.value_or(LengthUnit::kMillimetre);
    metres_ = MetresPer(unit);
    found_.Fact("unit", NameOf(unit) + (motion_.unit ? ", as given in the file"
                                        : fits       ? ", inferred from the rod length"
                                                     : ", assumed"));
    if (!motion_.unit && !motion_.unit_text.empty()) {
      found_.Warn("the file's unit is " + Quoted(motion_.unit_text) + ", which is unknown");
    }
    if (fits && motion_.unit && *fits != unit) {
      found_.Warn("the file gives " + NameOf(unit) + ", but the person looks like " +
                  NameOf(*fits) + ": set length_unit");
    }
    if (!motion_.unit && unit != LengthUnit::kMillimetre) {
      found_.Warn("lengths look like " + NameOf(unit) +
                  "; mm is assumed unless length_unit is given");
    }
    found_.Fact("standing height", "hip " + Rounded(rod * metres_, 3) + " m above the ankles");
    if (!fits) {
      found_.Warn(
          "no unit gives a standing person: hip " + Rounded(rod * metres_, 3) +
          " m above the ankles; check hip and ankles, or give the unit by length_scale (about " +
          Rounded(kUsualRod / rod, 2) + " gives a person)");
    }
  }

  void Axes(const Eigen::Vector3d& rod, const Facing& facing) {
    up_ = AxisName(rod);
    const Eigen::Vector3d forward = facing.to_the_left.cross(rod);
    const std::string faces = forward.norm() > 0.0 ? AxisName(forward) : "?";
    found_.Fact("axes", up_ + " is up, the person faces " + faces + " (by " + facing.by +
                            (facing.doubt.empty() ? ")" : ", unsure)"));
    if (!facing.doubt.empty()) {
      found_.Warn("the facing direction is uncertain: " + facing.doubt +
                  "; set \"forward\" according to the room");
    }
    if (up_ != "z") {
      found_.Warn(up_ + " is up in the file: set \"up\": \"" + up_ + "\"" +
                  (faces == "?" ? "" : ", \"forward\": \"" + faces + "\"") + " in the manifest");
    }
    if (!motion_.up.empty() && motion_.up != "+" + up_ && motion_.up != up_) {
      found_.Warn("the file declares " + motion_.up + " as up, but the person stands along " + up_);
    }
    const double lean = std::acos(std::fmin(1.0, rod.cwiseAbs().maxCoeff() / rod.norm()));
    if (lean > 0.35) {
      found_.Warn("the person leans " + Rounded(lean * 180.0 / 3.14159265358979323846, 3) +
                  " degrees at the start");
    }
  }

  void Start(int first) {
    if (!(motion_.rate_hz > 0.0)) return;
    const int window = std::max(2, static_cast<int>(kStaticTime * motion_.rate_hz));
    const int last = std::min<int>(first + window, static_cast<int>(found_.hip.size()) - 1);
    if (last <= first || !found_.hip[last].allFinite()) return;
    const double speed =
        (found_.hip[last] - found_.hip[first]).norm() * motion_.rate_hz / (last - first);
    const bool still = speed <= kStaticSpeed;
    const int soon = still ? last : last + window;
    if (found_.onset_frame >= 0 && found_.onset_frame <= soon && PushedFromRest(first)) {
      found_.Fact("start", "at rest, and pushed within the first " +
                               Seconds(found_.onset_frame / motion_.rate_hz));
      return;
    }
    found_.Fact("start",
                std::string(still ? "static" : "moving") + " (hip " + Rounded(speed, 2) + " m/s)");
    if (!still) {
      found_.Warn(
          "the person moves at the start: skip the motion by first_frame, or set initial_velocity "
          "to estimated or free");
    }
  }

  // Whether the hip gathers speed before the onset, as a push makes it do: a person who walks in is
  // as fast at first as later.
  bool PushedFromRest(int first) const {
    const int end = found_.onset_frame, step = std::max(1, (end - first) / 4);
    const auto way = [&](int t) { return (found_.hip[t + step] - found_.hip[t]).norm(); };
    double longest = 0.0;
    for (int t = first; t + step <= end; t += step) longest = std::max(longest, way(t));
    return longest > 0.0 && way(first) < kFromRest * longest;
  }

  // The hip's first 2 cm across the up axis, as the propagation of pushes counts it.
  void Onset(int first, const Eigen::Vector3d& rod) {
    const int axis = LargestAxis(rod);
    Eigen::Vector3d farthest = Eigen::Vector3d::Zero();
    for (std::size_t t = first; t < found_.hip.size(); ++t) {
      Eigen::Vector3d across = found_.hip[t];
      if (!across.allFinite()) continue;
      across[axis] = 0.0;
      if (found_.onset_frame < 0 && across.norm() >= kOnset) {
        found_.onset_frame = static_cast<int>(t);
      }
      if (across.norm() > farthest.norm()) farthest = across;
    }
    if (found_.onset_frame < 0) {
      found_.Warn(
          "the hip moves " + Rounded(1000.0 * farthest.norm(), 2) +
          " mm at most, and an onset is seen from 20 mm on: if there is a push, it is small");
      return;
    }
    found_.Fact("onset", "the hip has moved 2 cm at frame " + std::to_string(found_.onset_frame) +
                             (motion_.rate_hz > 0.0
                                  ? " (" + Seconds(found_.onset_frame / motion_.rate_hz) + ")"
                                  : "") +
                             "; at most it moves " + Rounded(farthest.norm(), 3) +
                             " m, mostly along " + AxisName(farthest));
  }

  // Warns of jumps of a point between frames, where metres are known.
  void Jumps() {
    if (metres_ == 0.0 || !(motion_.rate_hz > 0.0)) return;
    std::vector<std::string> jumps;
    for (std::size_t i = 0; i < motion_.positions.size(); ++i) {
      const Track& track = motion_.positions[i];
      double largest = 0.0;
      std::size_t where = 0;
      for (std::size_t t = 1; t < track.size(); ++t) {
        const double way = metres_ * (track[t] - track[t - 1]).norm();
        if (way > largest) largest = way, where = t;  // false for NaN
      }
      if (largest * motion_.rate_hz < kJumpSpeed || largest < kSmallestJump) continue;
      jumps.push_back(motion_.names[motion_.chosen[i]] + " " + Rounded(largest, 3) +
                      " m at frame " + std::to_string(where));
    }
    if (!jumps.empty()) {
      found_.Warn("jumps in " + std::to_string(jumps.size()) + " points: " + SomeOf(jumps));
    }
  }

  const PointMotion& motion_;
  const PelvisSides& pelvis_;
  Inspection& found_;
  double metres_ = 0.0;  // 0: not known
  std::string up_;
};

}  // namespace

PelvisSides SidesOf(const Result<BodyRoles>& roles) {
  if (!roles.ok()) return {};
  const BodyRoles& r = roles.value();
  if (!r.left_asis.empty() && !r.right_asis.empty()) return {r.left_asis, r.right_asis};
  return {r.joints[kLeftHip], r.joints[kRightHip]};
}

void InspectMotion(const PointMotion& motion, const std::optional<PendulumJoints>& joints,
                   const PelvisSides& pelvis, Inspection* inspection) {
  MotionInspector(motion, pelvis, inspection).Look(joints);
}

}  // namespace pushid
