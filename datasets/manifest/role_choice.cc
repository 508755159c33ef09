// datasets: the names that joints and markers have in the field, and whose roles they are.
#include <algorithm>
#include <string_view>

#include "datasets/manifest/joint_choice.h"

namespace pushid {
namespace {

constexpr int kNamings = 4;

// One word per role and naming, as SimplifiedName has it; '|' before the next best one, '+' between
// those whose mean it is. Words of arms and legs are sought on both sides (NamesOnSide).
struct RoleWords {
  int role;  // on the right, where there are two
  bool sided;
  std::array<const char*, kNamings> words;
};

// Namings: joints (FZJ, Xsens, SMPL, OpenSim's joints); limbs (CMU's BVH, Mixamo, Rokoko, Xsens'
// segments, Blender); bones (OpenSim's bodies, CMU's ASF); markers (Plug-in Gait and its joint
// centres, OpenSim). A word may mean two things, as Mixamo's LeftShoulder is a clavicle: hence
// whole namings, and not word by word.
constexpr RoleWords kWords[] = {
    {kLowerSpine, false, {"spine1|spine", "lowerback|l5|spine", "lowerback|lumbar", "l5"}},
    {kMiddleSpine, false, {"spine2|spine1", "l3|spine|spine1", "upperback", "l3"}},
    {kUpperSpine,
     false,
     {"spine3|spine2|chest|thorax|torso|back", "t8|chest|spine1|spine2", "thorax|torso",
      "t10+strn|t10|t8|sternum|strn"}},
    {kNeck,
     false,
     {"neck|neck1", "neck|neck1", "neck|lowerneck|cerv7", "c7+clav|c7|neck|c7spinous"}},
    {kBodyHead,
     false,
     {"head", "head", "head|skull",
      "lfhd+rfhd+lbhd+rbhd|lfhd+rfhd|lbhd+rbhd|tophead|vtex|vertex|head"}},
    {kRightClavicle,
     true,
     {"clavicle|collar|sternoclavicular", "shoulder|collar|clavicle", "clavicle|scapula", ""}},
    {kRightShoulder,
     true,
     {"shoulder|acromial|glenohumeral", "arm|upperarm|uparm", "humerus|upperarm",
      "sjc|sho|acr|shoulder|acromium|acromion|shouldertop"}},
    {kRightElbow,
     true,
     {"elbow", "forearm|lowerarm|lowarm", "ulna|radius|forearm",
      "ejc|lel+mel|elblat+elbmed|elbowlat+elbowmed|elb+melb|elb|lel|elbow|elbowlat"}},
    {kRightWrist,
     true,
     {"wrist|radiushand|hand", "hand|wrist", "hand|wrist",
      "wjc|wra+wrb|wristlat+wristmed|faradius+faulna|wri|wrist|wristlat"}},
    {kRightHip,
     true,
     {"hip|hipjoint", "upleg|upperleg|thigh", "femur|hipjoint", "hjc|hipjc|fep|hip"}},
    {kRightKnee,
     true,
     {"knee|walkerknee", "leg|lowerleg|lowleg|shin|calf", "tibia",
      "kjc|kneejc|feo|lfc+mfc|knelat+knemed|kneelat+kneemed|kne+mkne|kne|lfc|knee|kneelat"}},
};

constexpr int kSpine[] = {kLowerSpine, kMiddleSpine, kUpperSpine};

int OnLeft(int role) {
  return role + (role < kRightHip ? kLeftShoulder - kRightShoulder : kLeftHip - kRightHip);
}

std::vector<std::string> Split(std::string_view text, char at) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(at), text.size());
    parts.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

class RoleFinder {
 public:
  // Only joints with `prefix` ("Anna:") are looked at: others may be another person's.
  RoleFinder(const std::vector<std::string>& names, const std::string& prefix) {
    for (const std::string& name : names) {
      simplified_.push_back(PrefixOf(name) == prefix ? SimplifiedName(name) : "");
    }
  }

  // What the naming calls all roles that `roles` lacks; a joint plays one role.
  BodyRoles Named(int naming, BodyRoles roles) const {
    for (const RoleWords& row : kWords) {
      const char* words = row.words[naming];
      if (row.sided) {
        Fill(row.role, "right", words, &roles);
        Fill(OnLeft(row.role), "left", words, &roles);
      } else {
        Fill(row.role, "", words, &roles);
      }
    }
    return roles;
  }

  // The joints of "asi|asis" on a side, or of a word alone.
  std::vector<int> Find(const std::string& side, const std::string& words) const {
    for (const std::string& set : Split(words, '|')) {
      std::vector<int> found;
      const std::vector<std::string> parts = Split(set, '+');
      for (const std::string& part : parts) {
        const int joint = FindPart(side, part);
        if (joint >= 0) found.push_back(joint);
      }
      if (found.size() == parts.size()) return found;
    }
    return {};
  }

 private:
  // -1 where there is none, or more than one.
  int FindPart(const std::string& side, const std::string& part) const {
    std::vector<std::string> spellings;
    if (side.empty()) {
      spellings.push_back(part);
    } else {
      spellings = NamesOnSide(side, part);
    }
    for (const std::string& spelling : spellings) {
      const auto first = std::find(simplified_.begin(), simplified_.end(), spelling);
      if (first == simplified_.end()) continue;
      if (std::find(first + 1, simplified_.end(), spelling) != simplified_.end()) continue;
      return static_cast<int>(first - simplified_.begin());
    }
    return -1;
  }

  void Fill(int role, const std::string& side, const std::string& words, BodyRoles* roles) const {
    if (roles->Has(role)) return;
    for (const std::string& word : Split(words, '|')) {
      const std::vector<int> found = Find(side, word);
      // A mean leaves its joints to others: a hip between the hip joints.
      const bool free = found.size() > 1 || std::find(roles->joints.begin(), roles->joints.end(),
                                                      found) == roles->joints.end();
      if (found.empty() || !free) continue;
      roles->joints[role] = found;
      return;
    }
  }

  std::vector<std::string> simplified_;
};

int CountOf(const BodyRoles& roles) {
  return static_cast<int>(std::count_if(roles.joints.begin(), roles.joints.end(),
                                        [](const auto& list) { return !list.empty(); }));
}

// From the joint to its root, itself first.
std::vector<int> WayToRoot(const BvhSkeleton& skeleton, int joint) {
  std::vector<int> way;
  for (; joint >= 0; joint = skeleton.joints[joint].parent) way.push_back(joint);
  return way;
}

// The joints between the hip and where both arms part, as roles: of more than three the ones that
// divide the chain best, of two the lower and the upper, of one the upper. Joints in the same place
// as the one below do not count.
void SetSpine(const BvhSkeleton& skeleton, BodyRoles* roles) {
  const int hip = roles->Single(kBodyHip), left = roles->Single(kLeftShoulder),
            right = roles->Single(kRightShoulder);
  if (hip < 0 || left < 0 || right < 0) return;
  const std::vector<int> way = WayToRoot(skeleton, left), other = WayToRoot(skeleton, right);
  const auto parting = std::find_first_of(way.begin(), way.end(), other.begin(), other.end());
  const auto at_hip = std::find(parting, way.end(), hip);
  if (at_hip == way.end()) return;
  std::vector<int> chain(parting, at_hip);  // from above
  if (!chain.empty() && chain.front() == roles->Single(kNeck)) chain.erase(chain.begin());
  chain.erase(std::remove_if(chain.begin(), chain.end(),
                             [&](int joint) { return skeleton.joints[joint].offset.isZero(1e-9); }),
              chain.end());
  std::reverse(chain.begin(), chain.end());
  const int count = static_cast<int>(chain.size());
  for (int role : kSpine) roles->joints[role].clear();
  for (int i = 0; i < std::min(count, 3); ++i) {
    // Of k joints, those at k/3, 2k/3 and k.
    const int place = count > 3 ? (2 * (i + 1) * count + 3) / 6 - 1 : i;
    const int role = count >= 3 ? kSpine[i] : count == 2 ? kSpine[2 * i] : kUpperSpine;
    roles->joints[role] = {chain[place]};
  }
}

// Of hip and ankles the prefix that most of the file's names have: a manifest may name a joint that
// lacks it.
std::string CommonPrefix(const std::vector<std::string>& names, const PendulumJoints& pendulum) {
  std::string best;
  long most = -1;
  for (int joint : {pendulum.left_ankle[0], pendulum.right_ankle[0], pendulum.hip[0]}) {
    const std::string prefix = PrefixOf(names[joint]);
    const long count =
        std::count_if(names.begin(), names.end(),
                      [&prefix](const std::string& name) { return PrefixOf(name) == prefix; });
    if (count > most) best = prefix, most = count;
  }
  return best;
}

}  // namespace

Result<BodyRoles> ChooseRoles(const std::string& path, const std::vector<std::string>& names,
                              const BvhSkeleton* skeleton, const PendulumJoints& pendulum,
                              const JointMapping& mapping) {
  BodyRoles given;
  for (int role = 0; role < kBodyJoints; ++role) {
    const std::optional<JointReference> reference = mapping.Of(role);
    if (!reference) continue;
    Result<std::vector<int>> meant = JointsMeant(path, names, skeleton, RoleName(role), *reference);
    if (!meant.ok()) return meant.error();
    given.joints[role] = std::move(meant.value());
  }
  BodyRoles roles = given;
  if (skeleton != nullptr && IsFzjSkeleton(*skeleton)) {
    for (int role = 0; role < kBodyJoints; ++role) {
      if (!roles.Has(role)) roles.joints[role] = {role};
    }
    return roles;
  }
  roles.joints[kBodyHip] = pendulum.hip;
  roles.joints[kLeftAnkle] = pendulum.left_ankle;
  roles.joints[kRightAnkle] = pendulum.right_ankle;
  roles.joints[kLeftToe] = pendulum.left_toe;
  roles.joints[kRightToe] = pendulum.right_toe;
  const RoleFinder finder(names, CommonPrefix(names, pendulum));
  BodyRoles best = roles;
  for (int naming = 0; naming < kNamings; ++naming) {
    BodyRoles named = finder.Named(naming, roles);
    if (CountOf(named) > CountOf(best)) best = std::move(named);
  }
  if (skeleton != nullptr) {
    SetSpine(*skeleton, &best);
    for (int role : kSpine) {
      if (given.Has(role)) best.joints[role] = given.joints[role];
    }
  }
  best.left_asis = finder.Find("left", "asi|asis");
  best.right_asis = finder.Find("right", "asi|asis");
  best.back = finder.Find("", "lpsi+rpsi|lpsis+rpsis|psisl+psisr|sacr|vsacral|sacrum");
  return best;
}

std::string RolesText(const Result<BodyRoles>& roles) {
  if (!roles.ok()) return "none: " + roles.error().message;
  const std::vector<int> unfilled = UnfilledRoles(roles.value());
  if (!unfilled.empty()) return "none: not recognised: " + RoleList(unfilled);
  const std::vector<int> filled = FilledRoles(roles.value());
  return filled.empty() ? "all roles" : "all roles, filled from neighbours: " + RoleList(filled);
}

}  // namespace pushid
