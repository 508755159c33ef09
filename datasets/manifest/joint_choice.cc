// datasets: which joints or markers of a file the pendulum is read from.
#include "datasets/manifest/joint_choice.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/manifest/body_roles.h"

namespace pushid {

bool IsFzjSkeleton(const BvhSkeleton& skeleton) {
  return std::equal(kBodyParents.begin(), kBodyParents.end(), skeleton.joints.begin(),
                    skeleton.joints.end(),
                    [](int parent, const BvhJoint& joint) { return joint.parent == parent; });
}

std::string SimplifiedName(const std::string& name) {
  std::string simple;
  const std::size_t prefix = name.rfind(':');
  for (char c : prefix == std::string::npos ? name : name.substr(prefix + 1)) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) simple += c;
  }
  return simple;
}

std::string PrefixOf(const std::string& name) {
  const std::size_t colon = name.rfind(':');
  return colon == std::string::npos ? "" : name.substr(0, colon);
}

std::vector<std::string> NamesOnSide(const std::string& side, const std::string& part) {
  const std::string letter = side.substr(0, 1);
  return {side + part, letter + part, part + side, part + letter};
}

namespace {

// What differs between the joints of a skeleton and the points of other files.
struct Source {
  const std::string& path;
  std::vector<std::string> names;
  const BvhSkeleton* skeleton = nullptr;  // null: points
  std::vector<std::string> simplified{};

  bool is_bvh() const { return skeleton != nullptr; }
  std::string noun() const { return is_bvh() ? "joint" : "point"; }
  const char* whole() const { return is_bvh() ? "skeleton" : "file"; }
};

std::vector<int> AllCalled(const Source& source, const std::string& simplified) {
  std::vector<int> found;
  for (std::size_t i = 0; i < source.simplified.size(); ++i) {
    if (source.simplified[i] == simplified) found.push_back(static_cast<int>(i));
  }
  return found;
}

Error SeveralError(const Source& source, const std::string& key, const std::vector<int>& found) {
  return {key + " could be " + Quoted(source.names[found[0]]) + " or " +
              Quoted(source.names[found[1]]) +
              "; name it in full by \"joints\" in the manifest (each subject may have its own)",
          source.path};
}

// The first set of candidates that are all there; an empty list when there is none. Points of
// several people that match the same name are an Error, joints are taken in file order.
Result<std::vector<int>> FindDefault(const Source& source, const std::string& key,
                                     const std::vector<std::vector<std::string>>& candidates) {
  for (const std::vector<std::string>& set : candidates) {
    std::vector<int> chosen;
    for (const std::string& name : set) {
      const std::vector<int> found = AllCalled(source, name);
      if (found.empty()) break;
      if (found.size() > 1 && !source.is_bvh()) return SeveralError(source, key, found);
      chosen.push_back(found[0]);
    }
    if (chosen.size() == set.size()) return chosen;
  }
  return std::vector<int>{};
}

Result<std::vector<int>> DefaultHip(const Source& source) {
  std::vector<std::vector<std::string>> candidates = {{"hips"}, {"hip"}, {"pelvis"}};
  if (!source.is_bvh()) {
    for (const auto& set :
         std::vector<std::vector<std::string>>{{"midhip"},
                                               {"hipcenter"},
                                               {"lasi", "rasi", "lpsi", "rpsi"},
                                               {"lasis", "rasis", "lpsis", "rpsis"},
                                               {"asisl", "asisr", "psisl", "psisr"},
                                               {"lasi", "rasi", "sacr"},
                                               {"lasis", "rasis", "vsacral"},
                                               {"lasi", "rasi"},
                                               {"lasis", "rasis"},
                                               {"lhip", "rhip"},
                                               {"lefthip", "righthip"}}) {
      candidates.push_back(set);
    }
  }
  Result<std::vector<int>> hip = FindDefault(source, "hip", candidates);
  if (hip.ok() && hip.value().empty() && source.is_bvh()) return std::vector<int>{0};
  return hip;
}

Result<std::vector<int>> DefaultAnkle(const Source& source, const std::string& key,
                                      const std::string& side) {
  const std::string letter = side.substr(0, 1);
  std::vector<std::vector<std::string>> candidates;
  for (const char* part : {"ankle", "foot"}) {
    for (const std::string& name : NamesOnSide(side, part)) candidates.push_back({name});
  }
  if (!source.is_bvh()) {
    // The middle of both malleoli, where there are both: ISB's L_FAL and L_TAM, LAL and LAM, ...
    for (const auto& [outer, inner] :
         {std::pair("fal", "tam"), std::pair("al", "am"), std::pair("latmal", "medmal"),
          std::pair("lmal", "mmal"), std::pair("anklelat", "anklemed")}) {
      candidates.push_back({letter + outer, letter + inner});
    }
    for (const std::string& name :
         {letter + "ank", letter + "mall", letter + "fal", letter + "anklelat", letter + "mal",
          letter + "lm", "mal" + letter, "malext" + letter}) {
      candidates.push_back({name});
    }
  }
  Result<std::vector<int>> ankle = FindDefault(source, key, candidates);
  if (ankle.ok() && ankle.value().empty() && source.is_bvh() && IsFzjSkeleton(*source.skeleton)) {
    return std::vector<int>{side == "left" ? kLeftAnkle : kRightAnkle};
  }
  return ankle;
}

// Another point of the foot that `ankle` belongs to; empty where there is none that is clear.
std::vector<int> OfFoot(const Source& source, const std::string& side, const PendulumJoints& joints,
                        const std::vector<int>& ankle, const std::vector<const char*>& parts) {
  for (const char* part : parts) {
    for (const std::string& name : NamesOnSide(side, part)) {
      std::vector<int> found;
      for (int i : AllCalled(source, name)) {
        const bool own = PrefixOf(source.names[i]) == PrefixOf(source.names[ankle[0]]);
        if (own && i != joints.left_ankle[0] && i != joints.right_ankle[0]) found.push_back(i);
      }
      if (found.size() == 1) return found;
    }
  }
  return {};
}

std::vector<int> ToeOf(const Source& source, const std::string& side, const PendulumJoints& joints,
                       const std::vector<int>& ankle) {
  if (source.is_bvh() && IsFzjSkeleton(*source.skeleton) &&
      (ankle[0] == kLeftAnkle || ankle[0] == kRightAnkle)) {
    return {ankle[0] + 1};
  }
  return OfFoot(source, side, joints, ankle,
                {"toebase", "toe", "toes", "bigtoe", "toetip", "mt2", "mt1", "mt5", "foot"});
}

std::vector<int> HeelOf(const Source& source, const std::string& side, const PendulumJoints& joints,
                        const std::vector<int>& ankle) {
  return OfFoot(source, side, joints, ankle, {"heel", "hee", "cal", "calc"});
}

Error InJoints(const std::string& key, Error error) {
  error.message = "joints: " + key + ": " + error.message;
  return error;
}

// The joint or point that one name or index means.
Result<int> Look(const Source& source, const std::string& key, const JointReference& reference) {
  const int count = static_cast<int>(source.names.size());
  if (reference.name.empty()) {
    if (reference.index >= 0 && reference.index < count) return reference.index;
    const std::string noun = source.noun();
    return Error{"joints: " + key + " is " + noun + " " + std::to_string(reference.index) +
                     ", but the " + source.whole() + " has " + noun + "s 0 to " +
                     std::to_string(count - 1),
                 source.path, 0};
  }
  for (int i = 0; i < count; ++i) {
    if (source.names[i] == reference.name) return i;
  }
  // "LASI" for "Anna:LASI".
  std::vector<int> found;
  for (int i = 0; i < count && !source.is_bvh(); ++i) {
    const std::size_t prefix = source.names[i].rfind(':');
    if (prefix != std::string::npos && source.names[i].substr(prefix + 1) == reference.name) {
      found.push_back(i);
    }
  }
  if (found.size() > 1) return InJoints(key, SeveralError(source, key, found));
  if (found.size() == 1) return found[0];
  return InJoints(key, UnknownNameError(source.path, source.noun(), source.names, reference.name));
}

Result<std::vector<int>> Meant(const Source& source, const std::string& key,
                               const JointReference& reference) {
  std::vector<int> chosen;
  const std::vector<JointReference> single = {reference};
  for (const JointReference& one : reference.mean_of.empty() ? single : reference.mean_of) {
    const Result<int> index = Look(source, key, one);
    if (!index.ok()) return index.error();
    chosen.push_back(index.value());
  }
  return chosen;
}

// What `reference` means, otherwise the role's default, which is only looked for where it is
// wanted: it may be ambiguous. An Error when there is neither.
Result<std::vector<int>> Choose(const Source& source, int role,
                                const std::optional<JointReference>& reference) {
  const std::string& key = RoleName(role);
  if (reference) return Meant(source, key, *reference);
  const Result<std::vector<int>> found =
      role == kBodyHip ? DefaultHip(source)
                       : DefaultAnkle(source, key, role == kLeftAnkle ? "left" : "right");
  if (!found.ok() || !found.value().empty()) return found;
  const std::string noun = source.noun();
  return Error{"no " + noun + " could be recognised as " + key +
                   "; name it in the manifest: \"joints\": {\"hip\": ..., \"left_ankle\": ..., "
                   "\"right_ankle\": ...}; the " +
                   source.whole() + " has " + ListOfNames(source.names, kNamesInErrors, noun + "s"),
               source.path};
}

Result<PendulumJoints> ChooseFrom(Source source, const JointMapping& mapping) {
  for (const std::string& name : source.names) source.simplified.push_back(SimplifiedName(name));
  const struct {
    int role;
    std::vector<int> PendulumJoints::*place;
  } required[] = {{kBodyHip, &PendulumJoints::hip},
                  {kLeftAnkle, &PendulumJoints::left_ankle},
                  {kRightAnkle, &PendulumJoints::right_ankle}};
  PendulumJoints joints;
  for (const auto& [role, place] : required) {
    Result<std::vector<int>> chosen = Choose(source, role, mapping.Of(role));
    if (!chosen.ok()) return chosen.error();
    joints.*place = std::move(chosen.value());
  }
  if (joints.hip == joints.left_ankle || joints.hip == joints.right_ankle ||
      joints.left_ankle == joints.right_ankle) {
    return Error{"hip, left_ankle and right_ankle must be three different " + source.noun() +
                     "s, not " + Quoted(source.names[joints.hip[0]]) + ", " +
                     Quoted(source.names[joints.left_ankle[0]]) + " and " +
                     Quoted(source.names[joints.right_ankle[0]]) +
                     "; name them by \"joints\" in the manifest",
                 source.path, 0};
  }
  for (const bool is_left : {true, false}) {
    const int role = is_left ? kLeftToe : kRightToe;
    std::vector<int>& toe = is_left ? joints.left_toe : joints.right_toe;
    toe = ToeOf(source, is_left ? "left" : "right", joints,
                is_left ? joints.left_ankle : joints.right_ankle);
    const std::optional<JointReference> named = mapping.Of(role);
    if (!named) continue;
    Result<std::vector<int>> meant = Meant(source, RoleName(role), *named);
    if (!meant.ok()) return meant.error();
    toe = std::move(meant.value());
  }
  joints.left_heel = HeelOf(source, "left", joints, joints.left_ankle);
  joints.right_heel = HeelOf(source, "right", joints, joints.right_ankle);
  return joints;
}

}  // namespace

Result<PendulumJoints> ChoosePendulumJoints(const std::string& path, const BvhSkeleton& skeleton,
                                            const JointMapping& mapping) {
  return ChooseFrom({path, skeleton.Names(), &skeleton}, mapping);
}

Result<PendulumJoints> ChoosePendulumPoints(const std::string& path,
                                            const std::vector<std::string>& names,
                                            const JointMapping& mapping) {
  return ChooseFrom({path, names}, mapping);
}

Result<std::vector<int>> JointsMeant(const std::string& path, const std::vector<std::string>& names,
                                     const BvhSkeleton* skeleton, const std::string& key,
                                     const JointReference& reference) {
  return Meant({path, names, skeleton}, key, reference);
}

JointMapping Overlaid(const JointMapping& first, const JointMapping& second) {
  JointMapping overlaid = second;
  for (int role = 0; role < kBodyJoints; ++role) {
    if (const auto joint = first.Of(role)) overlaid.Set(role, *joint);
  }
  return overlaid;
}

}  // namespace pushid
