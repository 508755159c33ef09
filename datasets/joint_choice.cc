// datasets: which joints of a skeleton the pendulum is read from.
#include "datasets/joint_choice.h"

#include <iterator>
#include <vector>

#include "datasets/number_text.h"

namespace pushid {
namespace {

// The FZJ push skeleton: hip; spine to head; right arm, left arm; right leg 14-17, left leg 18-21.
constexpr int kFzjParents[] = {-1, 0,  1,  2, 3,  4,  3,  6, 7,  8,  3,
                               10, 11, 12, 0, 14, 15, 16, 0, 18, 19, 20};
constexpr int kFzjRightAnkle = 16, kFzjLeftAnkle = 20;

bool IsFzjSkeleton(const BvhSkeleton& skeleton) {
  if (skeleton.joints.size() != std::size(kFzjParents)) return false;
  for (std::size_t i = 0; i < std::size(kFzjParents); ++i) {
    if (skeleton.joints[i].parent != kFzjParents[i]) return false;
  }
  return true;
}

// "mixamorig:Left_Foot" -> "leftfoot".
std::string Simplified(const std::string& name) {
  std::string simple;
  const std::size_t prefix = name.rfind(':');
  for (char c : prefix == std::string::npos ? name : name.substr(prefix + 1)) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) simple += c;
  }
  return simple;
}

// The first candidate that a joint is called; -1 when there is none.
int FindByName(const BvhSkeleton& skeleton, const std::vector<std::string>& candidates) {
  for (const std::string& candidate : candidates) {
    for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
      if (Simplified(skeleton.joints[i].name) == candidate) return static_cast<int>(i);
    }
  }
  return -1;
}

int FindAnkle(const BvhSkeleton& skeleton, const std::string& side) {
  const std::string letter = side.substr(0, 1);
  const int joint =
      FindByName(skeleton, {side + "ankle", letter + "ankle", "ankle" + side, "ankle" + letter,
                            side + "foot", letter + "foot", "foot" + side, "foot" + letter});
  if (joint >= 0 || !IsFzjSkeleton(skeleton)) return joint;
  return side == "left" ? kFzjLeftAnkle : kFzjRightAnkle;
}

// The joint that `reference` means, or else `fallback`; an Error when there is neither.
Result<int> Choose(const std::string& path, const BvhSkeleton& skeleton, const char* key,
                   const std::optional<JointReference>& reference, int fallback) {
  const int count = static_cast<int>(skeleton.joints.size());
  if (!reference) {
    if (fallback >= 0) return fallback;
    Error error = UnknownJointError(path, skeleton, "");
    error.message = std::string("no joint could be recognised as ") + key +
                    "; name it in the manifest: \"joints\": {\"hip\": ..., \"left_ankle\": ..., "
                    "\"right_ankle\": ...}; the skeleton has " +
                    error.message.substr(error.message.find("it has ") + 7);
    return error;
  }
  if (!reference->name.empty()) {
    const int joint = skeleton.Find(reference->name);
    if (joint >= 0) return joint;
    Error error = UnknownJointError(path, skeleton, reference->name);
    error.message = std::string("joints: ") + key + ": " + error.message;
    return error;
  }
  if (reference->index >= 0 && reference->index < count) return reference->index;
  return Error{std::string("joints: ") + key + " is joint " + std::to_string(reference->index) +
                   ", but the skeleton has joints 0 to " + std::to_string(count - 1),
               path, 0};
}

}  // namespace

Result<PendulumJoints> ChoosePendulumJoints(const std::string& path, const BvhSkeleton& skeleton,
                                            const JointMapping& mapping) {
  const int named_hip = FindByName(skeleton, {"hips", "hip", "pelvis"});
  const Result<int> hip =
      Choose(path, skeleton, "hip", mapping.hip, named_hip >= 0 ? named_hip : 0);
  if (!hip.ok()) return hip.error();
  const Result<int> left =
      Choose(path, skeleton, "left_ankle", mapping.left_ankle, FindAnkle(skeleton, "left"));
  if (!left.ok()) return left.error();
  const Result<int> right =
      Choose(path, skeleton, "right_ankle", mapping.right_ankle, FindAnkle(skeleton, "right"));
  if (!right.ok()) return right.error();
  const PendulumJoints joints{hip.value(), left.value(), right.value()};
  if (joints.hip == joints.left_ankle || joints.hip == joints.right_ankle ||
      joints.left_ankle == joints.right_ankle) {
    return Error{"hip, left_ankle and right_ankle must be three different joints, not " +
                     Quoted(skeleton.joints[joints.hip].name) + ", " +
                     Quoted(skeleton.joints[joints.left_ankle].name) + " and " +
                     Quoted(skeleton.joints[joints.right_ankle].name) +
                     "; name them by \"joints\" in the manifest",
                 path, 0};
  }
  return joints;
}

}  // namespace pushid
