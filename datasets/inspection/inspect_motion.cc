// datasets: inspection of a motion.
#include "datasets/inspection/inspect_motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tuple>

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

// "-y".
std::string AxisName(const Eigen::Vector3d& direction) {
  const int axis = LargestAxis(direction);
  return StrCat(direction[axis] < 0.0 ? "-" : "", "xyz"[axis]);
}

constexpr double kTurned = 0.5;    // rad between the ankles' line at first and in the mean
constexpr double kSideways = 0.8;  // rad between the way of a walk and where the person faces
constexpr double kStride = 1.0;    // s, about
constexpr double kWalked = 0.3;    // m; less has no direction

// The part of a vector across `up`; zero where it is not seen.
Eigen::Vector3d Across(const Eigen::Vector3d& v, const Eigen::Vector3d& up) {
  return v.allFinite() ? Eigen::Vector3d(v - v.dot(up) * up) : Eigen::Vector3d::Zero();
}

double Angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0));
}

std::string Degrees(double radians) {
  return StrCat(std::lround(radians * 180.0 / M_PI), " degrees");
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
      const std::vector<Eigen::Vector3d>& track = motion_.positions[i];
      const auto missing = static_cast<int>(std::count_if(
          track.begin(), track.end(), [](const auto& place) { return !place.allFinite(); }));
      if (missing > 0) hidden.emplace_back(missing, motion_.names[motion_.chosen[i]]);
    }
    if (hidden.empty()) return;
    std::stable_sort(hidden.begin(), hidden.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<std::string> texts;
    for (const auto& [missing, name] : hidden) texts.push_back(StrCat(name, " ", missing));
    found_.Warn(StrCat("gaps in ", hidden.size(), " of ", motion_.positions.size(),
                       " points; frames not seen: ", SomeOf(texts)));
  }

  void Body(const PendulumJoints& joints) {
    hip_ = MeanTrack(motion_.positions, joints.hip);
    left_ = MeanTrack(motion_.positions, joints.left_ankle);
    right_ = MeanTrack(motion_.positions, joints.right_ankle);
    on_base_ = !pelvis_.known() && joints.left_ankle == joints.right_ankle;
    const int frames = motion_.num_frames();
    const auto seen = [this](int t) { return (hip_[t] + left_[t] + right_[t]).allFinite(); };
    while (first_ < frames && !seen(first_)) ++first_;
    Places(joints);
    if (first_ == frames) {
      return found_.Warn("hip and both ankles are never visible together: there is no rod to fit");
    }
    if (first_ > 0) {
      found_.Warn(StrCat("hip and ankles are first seen together at frame ", first_,
                         ": set first_frame to ", first_, " or later"));
    }
    rod_ = hip_[first_] - 0.5 * (left_[first_] + right_[first_]);
    Unit(rod_.norm());
    Axes();
    for (const Eigen::Vector3d& position : hip_) {
      found_.hip.push_back(metres_ * (position - hip_[first_]));
    }
    Onset();
    Start();
    Steps(joints);
  }

  // Finds steps in the person's own axes, forward where they face.
  void Steps(const PendulumJoints& joints) {
    const Result<Eigen::Matrix3d> turn = AxesRotation(up_, AxisName(to_the_left_.cross(rod_)));
    if (!(motion_.rate_hz > 0.0) || !turn.ok()) return;
    const Eigen::Matrix3d to_project = metres_ * turn.value();
    // Loading does not use a toe or heel that is lost for long either.
    const double gap = PreparationOptions{}.max_gap_s * motion_.rate_hz;
    RecordedPerson person;
    for (const PendulumTrack& row : kPendulumTracks) {
      const std::vector<int>& chosen = joints.*row.joints;
      const bool lost = chosen.empty() || LongestHidden(motion_, chosen) > gap;
      if (!row.required && lost) continue;
      person.*row.track = MeanTrack(motion_.positions, chosen);
      for (Eigen::Vector3d& position : person.*row.track) position = to_project * position;
    }
    found_.steps = FindSteps(person, motion_.rate_hz);
    found_.Fact("steps", StepsText(*found_.steps, motion_.rate_hz));
  }

  void Places(const PendulumJoints& joints) {
    const auto names = [this](const std::vector<int>& chosen) {
      std::string text;
      for (int index : chosen) text += (text.empty() ? "" : " + ") + motion_.names[index];
      return text;
    };
    found_.Fact("hip", names(joints.hip));
    for (const auto& [what, left, right] :
         {std::tuple("ankles", &joints.left_ankle, &joints.right_ankle),
          std::tuple("toes", &joints.left_toe, &joints.right_toe)}) {
      if (left->empty() || right->empty()) continue;
      found_.Fact(what, names(*left) + " (left), " + names(*right) + " (right)");
    }
    for (const std::vector<int>* place : {&joints.hip, &joints.left_ankle, &joints.right_ankle}) {
      for (int index : *place) {
        if (const int longest = LongestHidden(motion_, {index}); longest > 0) {
          found_.Warn(
              StrCat(motion_.names[index], " is hidden for up to ", longest, " frames",
                     motion_.rate_hz > 0.0 ? " (" + Seconds(longest / motion_.rate_hz) + ")" : "",
                     ": --max_gap_s sets the longest gap that is interpolated"));
        }
      }
    }
  }

  // The file's word, otherwise what makes a person of the rod.
  void Unit(double rod) {
    const std::optional<LengthUnit> fits = UnitThatGives(rod, kShortestRod, kLongestRod);
    const LengthUnit unit = motion_.unit ? *motion_.unit : fits.value_or(LengthUnit::kMillimetre);
    metres_ = MetresPer(unit);
    found_.Fact("unit", NameOf(unit) + (motion_.unit ? ", as given in the file or its mapping"
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

  // Sets the facing by the pelvis at the first frame; without one by the line between the ankles,
  // averaged over a second, as one foot is ahead in mid-stride. Returns a doubt where that line
  // turns, or where the person walks to its side.
  std::string FindFacing(std::string* by) {
    Eigen::Vector3d up = Eigen::Vector3d::Zero();  // the axis nearest to the rod
    const int axis = LargestAxis(rod_);
    up[axis] = rod_[axis] < 0.0 ? -1.0 : 1.0;
    if (pelvis_.known()) {
      *by = "the pelvis";
      to_the_left_ = Across(MeanTrack(motion_.positions, pelvis_.left)[first_] -
                                MeanTrack(motion_.positions, pelvis_.right)[first_],
                            up);
      if (!to_the_left_.isZero()) return "";
    }
    *by = "the ankles";
    const double rate = motion_.rate_hz;
    const size_t stride = rate > 0.0 ? static_cast<size_t>(kStride * rate) : 1;
    for (size_t t = first_; t < std::min(left_.size(), first_ + stride); ++t) {
      to_the_left_ += Across(left_[t] - right_[t], up);
    }
    const Eigen::Vector3d at_first = Across(left_[first_] - right_[first_], up);
    if (on_base_) return "";
    if (to_the_left_.isZero() || at_first.isZero()) return "the ankles are in one place";
    if (Angle(at_first, to_the_left_) > kTurned) {
      return "one foot is ahead, or the person turns: the line between the ankles turns by " +
             Degrees(Angle(at_first, to_the_left_));
    }
    const auto last = std::find_if(hip_.rbegin(), hip_.rend(),
                                   [](const Eigen::Vector3d& place) { return place.allFinite(); });
    const Eigen::Vector3d way = Across(*last - hip_[first_], up), forward = to_the_left_.cross(up);
    if (metres_ * way.norm() <= kWalked || Angle(way, forward) <= kSideways) return "";
    return "the hip goes " + Degrees(Angle(way, forward)) + " off it";
  }

  void Axes() {
    up_ = AxisName(rod_);
    std::string by;
    const std::string doubt = FindFacing(&by);
    const Eigen::Vector3d forward = to_the_left_.cross(rod_);
    const std::string faces = forward.norm() > 0.0 ? AxisName(forward) : "?";
    found_.Fact("axes", up_ + " is up" +
                            (on_base_ ? ""
                                      : ", the person faces " + faces + " (by " + by +
                                            (doubt.empty() ? ")" : ", unsure)")));
    if (!doubt.empty()) {
      found_.Warn("the facing direction is uncertain: " + doubt +
                  "; set \"forward\" according to the room");
    }
    if (up_ != "z") {
      found_.Warn(up_ + " is up in the file: set \"up\": \"" + up_ + "\"" +
                  (faces == "?" ? "" : ", \"forward\": \"" + faces + "\"") + " in the manifest");
    }
    if (!motion_.up.empty() && motion_.up != "+" + up_ && motion_.up != up_) {
      found_.Warn("the file declares " + motion_.up + " as up, but the person stands along " + up_);
    }
  }

  void Start() {
    if (!(motion_.rate_hz > 0.0)) return;
    const int window = std::max(2, static_cast<int>(kStaticTime * motion_.rate_hz));
    const int last = std::min<int>(first_ + window, static_cast<int>(found_.hip.size()) - 1);
    if (last <= first_ || !found_.hip[last].allFinite()) return;
    const double speed =
        (found_.hip[last] - found_.hip[first_]).norm() * motion_.rate_hz / (last - first_);
    const bool still = speed <= kStaticSpeed;
    const int soon = still ? last : last + window;
    if (found_.onset_frame >= 0 && found_.onset_frame <= soon && PushedFromRest()) {
      found_.Fact("start", "at rest, and pushed within the first " +
                               Seconds(found_.onset_frame / motion_.rate_hz));
      return;
    }
    found_.Fact("start", StrCat(still ? "static" : "moving", " (hip ", Rounded(speed, 2), " m/s)"));
    if (!still) {
      found_.Warn(
          "the person moves at the start: skip the motion by first_frame, or set initial_velocity "
          "to estimated or free");
    }
  }

  // Whether the hip gathers speed before the onset, as a push makes it do: a person who walks in is
  // as fast at first as later.
  bool PushedFromRest() const {
    const int end = found_.onset_frame, step = std::max(1, (end - first_) / 4);
    const auto way = [&](int t) { return (found_.hip[t + step] - found_.hip[t]).norm(); };
    double longest = 0.0;
    for (int t = first_; t + step <= end; t += step) longest = std::max(longest, way(t));
    return longest > 0.0 && way(first_) < kFromRest * longest;
  }

  // The hip's first 2 cm across the up axis, as the propagation of pushes counts it.
  void Onset() {
    const int axis = LargestAxis(rod_);
    Eigen::Vector3d farthest = Eigen::Vector3d::Zero();
    for (std::size_t t = first_; t < found_.hip.size(); ++t) {
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
    found_.Fact("onset", StrCat("the hip has moved 2 cm at frame ", found_.onset_frame,
                                motion_.rate_hz > 0.0
                                    ? " (" + Seconds(found_.onset_frame / motion_.rate_hz) + ")"
                                    : "",
                                "; at most it moves ", Rounded(farthest.norm(), 3),
                                " m, mostly along ", AxisName(farthest)));
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
      jumps.push_back(StrCat(motion_.names[motion_.chosen[i]], " ", Rounded(largest, 3),
                             " m at frame ", where));
    }
    if (!jumps.empty()) {
      found_.Warn(StrCat("jumps in ", jumps.size(), " points: ", SomeOf(jumps)));
    }
  }

  const PointMotion& motion_;
  const PelvisSides& pelvis_;
  Inspection& found_;
  Track hip_, left_, right_;
  int first_ = 0;         // the frame at which all of them are first seen
  bool on_base_ = false;  // of support, which has no left and no right
  Eigen::Vector3d rod_, to_the_left_ = Eigen::Vector3d::Zero();
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
