// datasets: the joints of the pendulum and the roles of a body, by name; mapping files, and what
// they share with manifests.
#include "datasets/manifest/joint_mapping.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "datasets/files/json_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/manifest/recording.h"

namespace pushid {
namespace {

// Whether a skeleton has the 22 joints of the FZJ push recordings (those of
// models/restoration/body.h) in their order, by its parents.
bool IsFzjSkeleton(const BvhSkeleton& skeleton) {
  return std::equal(kBodyParents.begin(), kBodyParents.end(), skeleton.joints.begin(),
                    skeleton.joints.end(),
                    [](int parent, const BvhJoint& joint) { return joint.parent == parent; });
}

// "mixamorig:Left_Foot" without what stands before a colon, in small letters and digits alone:
// "leftfoot"; and what stands before the colon.
std::string SimplifiedName(const std::string& name) {
  const std::size_t prefix = name.rfind(':');
  return PlainName(prefix == std::string::npos ? name : name.substr(prefix + 1));
}

std::string PrefixOf(const std::string& name) {
  const std::size_t colon = name.rfind(':');
  return colon == std::string::npos ? "" : name.substr(0, colon);
}

// "left" and "ankle": "leftankle", "lankle", "ankleleft", "anklel".
std::vector<std::string> NamesOnSide(const std::string& side, const std::string& part) {
  const std::string letter = side.substr(0, 1);
  return {side + part, letter + part, part + side, part + letter};
}

// The joints of a skeleton or the points of another file, as a choice sees them.
struct Source {
  const std::string& path;
  std::vector<std::string> names;
  const BvhSkeleton* skeleton = nullptr;  // null: points
  std::vector<std::string> simplified{};

  bool is_bvh() const { return skeleton != nullptr; }
  std::string noun() const { return is_bvh() ? "joint" : "point"; }
  const char* whole() const { return is_bvh() ? "skeleton" : "file"; }
};

Error SeveralError(const Source& source, const std::string& key, const std::vector<int>& found) {
  const std::string &one = source.names[found[0]], &other = source.names[found[1]];
  return {key + " could be " + Quoted(one) + " or " + Quoted(other) +
              (one == other ? StrCat("; give its index, ", found[0], " or ", found[1], ",")
                            : "; name it in full") +
              " by \"joints\" in the manifest (each subject may have its own)",
          source.path};
}

// The first of the sets "a+b|c" whose names are all there; an empty list when there is none. `$`
// stands for the side and `@` for its letter. Points of several people that match one name are an
// Error, joints are taken in file order.
std::vector<int> FindDefault(const Source& source, const std::string& key, const std::string& side,
                             const std::string& sets) {
  for (const std::string& set : SplitList(sets, '|')) {
    std::vector<int> chosen;
    const std::vector<std::string> names = SplitList(set, '+');
    for (const std::string& pattern : names) {
      std::string name;
      for (char c : pattern) {
        name += c == '$' ? side : c == '@' ? side.substr(0, 1) : std::string(1, c);
      }
      std::vector<int> found;
      for (std::size_t i = 0; i < source.simplified.size(); ++i) {
        if (source.simplified[i] == name) found.push_back(static_cast<int>(i));
      }
      if (found.empty()) break;
      if (found.size() > 1 && !source.is_bvh()) throw SeveralError(source, key, found);
      chosen.push_back(found[0]);
    }
    if (chosen.size() == names.size()) return chosen;
  }
  return {};
}

std::vector<int> DefaultHip(const Source& source) {
  std::string sets = "hips|hip|pelvis";
  if (!source.is_bvh()) {
    sets +=
        "|midhip|hipcenter|lasi+rasi+lpsi+rpsi|lasis+rasis+lpsis+rpsis|asisl+asisr+psisl+psisr|"
        "lasi+rasi+sacr|lasis+rasis+vsacral|lasi+rasi|lasis+rasis|lhip+rhip|lefthip+righthip";
  }
  const std::vector<int> hip = FindDefault(source, RoleName(kBodyHip), "", sets);
  return hip.empty() && source.is_bvh() ? std::vector<int>{0} : hip;
}

std::vector<int> DefaultAnkle(const Source& source, int role) {
  std::string sets = "$ankle|@ankle|ankle$|ankle@|$foot|@foot|foot$|foot@";
  if (!source.is_bvh()) {
    // The middle of both malleoli, where there are both: ISB's L_FAL and L_TAM, LAL and LAM, ...
    sets +=
        "|@fal+@tam|@al+@am|@latmal+@medmal|@lmal+@mmal|@anklelat+@anklemed|"
        "@ank|@mall|@fal|@anklelat|@mal|@lm|mal@|malext@";
  }
  const std::string side = role == kLeftAnkle ? "left" : "right";
  const std::vector<int> ankle = FindDefault(source, RoleName(role), side, sets);
  const bool fzj = source.is_bvh() && IsFzjSkeleton(*source.skeleton);
  return ankle.empty() && fzj ? std::vector<int>{role} : ankle;
}

// Words of a role in four namings, as SimplifiedName has them; '|' before the next best one, '+'
// between those whose mean it is. Words of arms and legs are sought on both sides (NamesOnSide). A
// word may mean two things, as Mixamo's LeftShoulder is a clavicle: hence whole namings, and not
// word by word.
struct RoleWords {
  int role;             // on the right, where there are two
  const char* joints;   // of FZJ, Xsens, SMPL, OpenSim
  const char* limbs;    // CMU's BVH, Mixamo, Rokoko, segments of Xsens, Blender
  const char* bones;    // bodies of OpenSim, CMU's ASF
  const char* markers;  // Plug-in Gait and its joint centres, OpenSim
};

constexpr RoleWords kWords[] = {
    {kLowerSpine, "spine1|spine", "lowerback|l5|spine", "lowerback|lumbar", "l5"},
    {kMiddleSpine, "spine2|spine1", "l3|spine|spine1", "upperback", "l3"},
    {kUpperSpine, "spine3|spine2|chest|thorax|torso|back", "t8|chest|spine1|spine2", "thorax|torso",
     "t10+strn|t10|t8|sternum|strn"},
    {kNeck, "neck|neck1", "neck|neck1", "neck|lowerneck|cerv7", "c7+clav|c7|neck|c7spinous"},
    {kBodyHead, "head", "head", "head|skull",
     "lfhd+rfhd+lbhd+rbhd|lfhd+rfhd|lbhd+rbhd|tophead|vtex|vertex|head"},
    {kRightClavicle, "clavicle|collar|sternoclavicular", "shoulder|collar|clavicle",
     "clavicle|scapula", ""},
    {kRightShoulder, "shoulder|acromial|glenohumeral", "arm|upperarm|uparm", "humerus|upperarm",
     "sjc|sho|acr|shoulder|acromium|acromion|shouldertop"},
    {kRightElbow, "elbow", "forearm|lowerarm|lowarm", "ulna|radius|forearm",
     "ejc|lel+mel|elblat+elbmed|elbowlat+elbowmed|elb+melb|elb|lel|elbow|elbowlat"},
    {kRightWrist, "wrist|radiushand|hand", "hand|wrist", "hand|wrist",
     "wjc|wra+wrb|wristlat+wristmed|faradius+faulna|wri|wrist|wristlat"},
    {kRightHip, "hip|hipjoint", "upleg|upperleg|thigh", "femur|hipjoint", "hjc|hipjc|fep|hip"},
    {kRightKnee, "knee|walkerknee", "leg|lowerleg|lowleg|shin|calf", "tibia",
     "kjc|kneejc|feo|lfc+mfc|knelat+knemed|kneelat+kneemed|kne+mkne|kne|lfc|knee|kneelat"},
};
using Naming = const char* RoleWords::*;

constexpr int kSpine[] = {kLowerSpine, kMiddleSpine, kUpperSpine};

int OnLeft(int role) {
  return role + (role < kRightHip ? kLeftShoulder - kRightShoulder : kLeftHip - kRightHip);
}

class RoleFinder {
 public:
  // Joints without `prefix` ("Anna:") are ignored: they may be another person's.
  RoleFinder(const std::vector<std::string>& names, const std::string& prefix) {
    for (const std::string& name : names) {
      simplified_.push_back(PrefixOf(name) == prefix ? SimplifiedName(name) : "");
    }
  }

  // Adds the roles that `roles` lacks and the naming has names for; a joint plays one role.
  BodyRoles Named(Naming naming, BodyRoles roles) const {
    for (const RoleWords& row : kWords) {
      const bool sided = row.role > kBodyHead;
      Fill(row.role, sided ? "right" : "", row.*naming, &roles);
      if (sided) Fill(OnLeft(row.role), "left", row.*naming, &roles);
    }
    return roles;
  }

  // The joints of "asi|asis" on a side, or of a word alone.
  std::vector<int> Find(const std::string& side, const std::string& words) const {
    for (const std::string& set : SplitList(words, '|')) {
      std::vector<int> found;
      const std::vector<std::string> parts = SplitList(set, '+');
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
    for (const std::string& spelling :
         side.empty() ? std::vector<std::string>{part} : NamesOnSide(side, part)) {
      const auto first = std::find(simplified_.begin(), simplified_.end(), spelling);
      if (first == simplified_.end()) continue;
      if (std::find(first + 1, simplified_.end(), spelling) != simplified_.end()) continue;
      return static_cast<int>(first - simplified_.begin());
    }
    return -1;
  }

  void Fill(int role, const std::string& side, const std::string& words, BodyRoles* roles) const {
    if (roles->Has(role)) return;
    for (const std::string& word : SplitList(words, '|')) {
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

// Another point of the foot that `ankle` belongs to; empty where there is none that is clear.
std::vector<int> OfFoot(const Source& source, const std::string& side, const PendulumJoints& joints,
                        const std::vector<int>& ankle, const std::string& words) {
  std::vector<std::string> others = source.names;
  for (int taken : {joints.left_ankle[0], joints.right_ankle[0]}) others[taken].clear();
  return RoleFinder(others, PrefixOf(source.names[ankle[0]])).Find(side, words);
}

std::vector<int> ToeOf(const Source& source, const std::string& side, const PendulumJoints& joints,
                       const std::vector<int>& ankle) {
  if (source.is_bvh() && IsFzjSkeleton(*source.skeleton) &&
      (ankle[0] == kLeftAnkle || ankle[0] == kRightAnkle)) {
    return {ankle[0] + 1};
  }
  return OfFoot(source, side, joints, ankle, "toebase|toe|toes|bigtoe|toetip|mt2|mt1|mt5|foot");
}

// The joint or point that one name or index means.
int Look(const Source& source, const std::string& key, const JointReference& reference) {
  const int count = static_cast<int>(source.names.size());
  const std::string noun = source.noun();
  if (reference.name.empty()) {
    if (reference.index >= 0 && reference.index < count) return reference.index;
    throw Error{StrCat("joints: ", key, " is ", noun, " ", reference.index, ", but the ",
                       source.whole(), " has ", noun, "s 0 to ", count - 1),
                source.path};
  }
  std::vector<int> found;  // "LASI" for "Anna:LASI"
  for (int i = 0; i < count; ++i) {
    const std::string& name = source.names[i];
    if (name == reference.name) return i;
    const std::size_t prefix = name.rfind(':');
    if (!source.is_bvh() && prefix != std::string::npos &&
        name.substr(prefix + 1) == reference.name) {
      found.push_back(i);
    }
  }
  if (found.size() == 1) return found[0];
  Error error = found.empty() ? UnknownNameError(source.path, noun, source.names, reference.name)
                              : SeveralError(source, key, found);
  error.message = "joints: " + key + ": " + error.message;
  throw error;
}

std::vector<int> Meant(const Source& source, const std::string& key,
                       const JointReference& reference) {
  if (reference.mean_of.empty()) return {Look(source, key, reference)};
  std::vector<int> chosen;
  for (const JointReference& one : reference.mean_of) chosen.push_back(Look(source, key, one));
  return chosen;
}

// The joints of `reference`, otherwise the role's default, which is only looked for where it is
// wanted, as it may be ambiguous. Throws an Error: neither is there.
std::vector<int> Choose(const Source& source, int role,
                        const std::optional<JointReference>& reference) {
  const std::string& key = RoleName(role);
  if (reference) return Meant(source, key, *reference);
  const std::vector<int> found = role == kBodyHip ? DefaultHip(source) : DefaultAnkle(source, role);
  if (!found.empty()) return found;
  const std::string noun = source.noun();
  throw Error{"no " + noun + " could be recognised as " + key +
                  "; name it in the manifest: \"joints\": {\"hip\": ..., \"left_ankle\": ..., "
                  "\"right_ankle\": ...}; the " +
                  source.whole() + " has " + ListOfNames(source.names, kNamesInErrors, noun + "s"),
              source.path};
}

PendulumJoints ChooseFrom(Source source, const JointMapping& mapping) {
  for (const std::string& name : source.names) source.simplified.push_back(SimplifiedName(name));
  PendulumJoints joints;
  joints.hip = Choose(source, kBodyHip, mapping.Of(kBodyHip));
  joints.left_ankle = Choose(source, kLeftAnkle, mapping.Of(kLeftAnkle));
  joints.right_ankle = Choose(source, kRightAnkle, mapping.Of(kRightAnkle));
  if (joints.hip == joints.left_ankle || joints.hip == joints.right_ankle ||
      (joints.left_ankle == joints.right_ankle && mapping.of_role.count(kBaseRole) == 0)) {
    throw Error{"hip, left_ankle and right_ankle must be three different " + source.noun() +
                    "s, not " + Quoted(source.names[joints.hip[0]]) + ", " +
                    Quoted(source.names[joints.left_ankle[0]]) + " and " +
                    Quoted(source.names[joints.right_ankle[0]]) +
                    "; name them by \"joints\" in the manifest",
                source.path};
  }
  for (const bool is_left : {true, false}) {
    const std::string side = is_left ? "left" : "right";
    const std::vector<int>& ankle = is_left ? joints.left_ankle : joints.right_ankle;
    const int role = is_left ? kLeftToe : kRightToe;
    const std::optional<JointReference> named = mapping.Of(role);
    (is_left ? joints.left_toe : joints.right_toe) =
        named ? Meant(source, RoleName(role), *named) : ToeOf(source, side, joints, ankle);
    (is_left ? joints.left_heel : joints.right_heel) =
        OfFoot(source, side, joints, ankle, "heel|hee|cal|calc");
  }
  return joints;
}

int CountOf(const BodyRoles& roles) {
  return static_cast<int>(std::count_if(roles.joints.begin(), roles.joints.end(),
                                        [](const auto& list) { return !list.empty(); }));
}

// The joints from `joint` to its root, `joint` first.
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
    // Three of k joints: those at k/3, 2k/3 and k.
    const int place = count > 3 ? (2 * (i + 1) * count + 3) / 6 - 1 : i;
    const int role = count >= 3 ? kSpine[i] : count == 2 ? kSpine[2 * i] : kUpperSpine;
    roles->joints[role] = {chain[place]};
  }
}

// The prefix of hip and ankles that most of the file's names have: a manifest may name a joint that
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

Result<PendulumJoints> ChoosePendulum(const std::string& path,
                                      const std::vector<std::string>& names,
                                      const BvhSkeleton* skeleton, const JointMapping& mapping) {
  return Caught([&] { return ChooseFrom({path, names, skeleton}, mapping); });
}

JointMapping Overlaid(const JointMapping& first, const JointMapping& second) {
  JointMapping overlaid = first;
  for (const auto& [role, joint] : second.of_role) {
    if (!first.Of(role)) overlaid.Set(role, joint);
  }
  return overlaid;
}

Result<BodyRoles> ChooseRoles(const std::string& path, const std::vector<std::string>& names,
                              const BvhSkeleton* skeleton, const PendulumJoints& pendulum,
                              const JointMapping& mapping) {
  const Result<BodyRoles> named = Caught([&] {
    BodyRoles meant;
    for (int role = 0; role < kBodyJoints; ++role) {
      if (const auto reference = mapping.Of(role)) {
        meant.joints[role] = Meant({path, names, skeleton}, RoleName(role), *reference);
      }
    }
    return meant;
  });
  if (!named.ok()) return named;
  const BodyRoles& given = named.value();
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
  for (Naming naming :
       {&RoleWords::joints, &RoleWords::limbs, &RoleWords::bones, &RoleWords::markers}) {
    BodyRoles by_naming = finder.Named(naming, roles);
    if (CountOf(by_naming) > CountOf(best)) best = std::move(by_naming);
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

namespace {

using Json = nlohmann::ordered_json;

void ReadColumns(JsonFields* fields, ColumnMapping* mapping) {
  if (!fields->Has("columns")) return;
  const Json& columns = fields->At("columns");
  if (!columns.is_object()) {
    fields->Fail("columns", "must be an object of \"point\": [\"x\", \"y\", \"z\"]");
    return;
  }
  for (const auto& [name, item] : columns.items()) {
    const auto xyz = ListOf<std::string>(item);
    if (!xyz || xyz->size() != 3 || name.empty()) {
      fields->Fail("columns",
                   "of " + Quoted(name) + " must be three column names, not " + Shown(item));
      return;
    }
    mapping->columns.push_back({name, (*xyz)[0], (*xyz)[1], (*xyz)[2]});
  }
}

constexpr int kHighestIndex = 1 << 30;
constexpr char kBase[] = "base";  // kBaseRole

std::optional<JointReference> ReadOne(const Json& value) {
  JointReference joint;
  if (value.is_string() && !value.get<std::string>().empty()) {
    joint.name = value.get<std::string>();
    return joint;
  }
  if (value.is_number_integer() && value.get<double>() >= 0 &&
      value.get<double>() < kHighestIndex) {
    joint.index = value.get<int>();
    return joint;
  }
  return std::nullopt;
}

std::optional<JointReference> ReadJoint(JsonFields* fields, const char* key) {
  if (!fields->Has(key)) return std::nullopt;
  const Json& value = fields->At(key);
  std::optional<JointReference> joint = ReadOne(value);
  if (value.is_array() && !value.empty()) {
    joint.emplace();
    for (const Json& item : value) {
      const std::optional<JointReference> one = ReadOne(item);
      if (!one) {
        joint.reset();
        break;
      }
      joint->mean_of.push_back(*one);
    }
  }
  if (!joint) {
    fields->Fail(
        key, "must be a joint's name or its index from 0, or a list of those, not " + Shown(value));
  }
  return joint;
}

}  // namespace

Result<ColumnMapping> ReadColumnMapping(const std::string& path) {
  return Caught([&] {
    const JsonDocument document = OrThrow(ReadJsonDocument(path));
    JsonFields fields(document, document.content, "", "mapping");
    OrThrow(fields.error());
    ColumnMapping mapping;
    ReadColumns(&fields, &mapping);
    mapping.joints = ReadJointMapping(&fields);
    mapping.time_column = fields.OptionalText("time", "");
    mapping.frame_rate = fields.OptionalNumber("frame_rate", "the frames per second", 0.0);
    const std::string problem = FrameRateProblem(mapping.frame_rate);
    if (fields.Has("frame_rate") && !problem.empty()) fields.Fail("frame_rate", problem);
    mapping.length = ReadLength(&fields);
    mapping.up = fields.OptionalText("up", "");
    mapping.forward = fields.OptionalText("forward", "");
    if (mapping.up.empty() != mapping.forward.empty()) {
      fields.Fail(mapping.up.empty() ? "forward" : "up",
                  "needs the other one: give up and forward");
    }
    const auto axes = Caught([&] { return AxesGiven(mapping.up, mapping.forward); });
    if (!axes.ok()) fields.Fail("up", "and forward: " + axes.error().message);
    fields.OnlyAsked();
    OrThrow(fields.error());
    return mapping;
  });
}

std::optional<JointReference> JointMapping::Of(int role) const {
  auto found = of_role.find(role);
  const bool of_ankle = role == kLeftAnkle || role == kRightAnkle;
  if (found == of_role.end() && of_ankle) found = of_role.find(kBaseRole);
  return found == of_role.end() ? std::nullopt : std::optional(found->second);
}

JointMapping ReadJointMapping(JsonFields* fields) {
  JointMapping mapping;
  if (!fields->Has("joints")) return mapping;
  JsonFields joints = fields->Inside(fields->At("joints"), "joints", "joints");
  for (int role = 0; role < kBodyJoints; ++role) {
    const std::optional<JointReference> joint = ReadJoint(&joints, RoleName(role).c_str());
    if (joint) mapping.Set(role, *joint);
  }
  // A robot's log has its base of support, and no ankles.
  if (const std::optional<JointReference> base = ReadJoint(&joints, kBase)) {
    if (mapping.Of(kLeftAnkle) || mapping.Of(kRightAnkle)) {
      joints.Fail(kBase, "is given together with ankles; it stands for both of them");
    }
    mapping.Set(kBaseRole, *base);
  }
  joints.OnlyAsked();
  fields->Add(joints);
  return mapping;
}

GivenLength ReadLength(JsonFields* fields) {
  constexpr const char *kUnit = "length_unit", *kScale = "length_scale";
  GivenLength given;
  if (fields->Has(kUnit)) given.length_unit = fields->Choice(kUnit, LengthUnit::kMillimetre);
  if (!fields->Has(kScale)) return given;
  const double metres = fields->Number(kScale, "the metres in one of the file's lengths");
  if (fields->failed()) return given;
  const std::string problem = LengthScaleProblem(metres);
  if (!problem.empty()) fields->Fail(kScale, problem);
  if (given.length_unit) {
    fields->Fail(kScale, "is given together with length_unit; give one of them");
  }
  given.length_scale = metres;
  return given;
}

}  // namespace pushid
