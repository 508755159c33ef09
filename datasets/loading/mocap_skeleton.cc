// datasets: skeleton.json: which joints are particles, and how they are connected.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>

#include "datasets/files/json_fields.h"
#include "datasets/loading/mocap_folder.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;
constexpr int kMostJoints = 1000;
constexpr int kUpAxis = 1;  // the literature's clips have y up
constexpr double kMetresPerMillimetre = 1e-3;

// A list of whole numbers from `lowest` to below `joints`.
std::vector<int> Indices(const char* key, int lowest, int joints, JsonFields* fields) {
  std::vector<int> indices;
  if (!fields->Require(key, "a list of joints")) return indices;
  for (const Json& value : fields->List(key)) {
    const bool fits =
        value.is_number_integer() && value.get<int>() >= lowest && value.get<int>() < joints;
    if (!fits) {
      fields->Fail(key, "holds " + Shown(value) + "; its numbers are joints, below " +
                            std::to_string(joints));
      return {};
    }
    indices.push_back(value.get<int>());
  }
  return indices;
}

Eigen::Matrix3Xd Offsets(int joints, JsonFields* fields) {
  Eigen::Matrix3Xd offsets = Eigen::Matrix3Xd::Zero(3, joints);
  if (!fields->Require("offsets_mm", "three numbers a joint")) return offsets;
  const Json& list = fields->List("offsets_mm");
  const auto is_offset = [](const Json& row) {
    return row.is_array() && row.size() == 3 &&
           std::all_of(row.begin(), row.end(), [](const Json& x) { return x.is_number(); });
  };
  if (static_cast<int>(list.size()) != joints ||
      !std::all_of(list.begin(), list.end(), is_offset)) {
    fields->Fail("offsets_mm", "must be " + std::to_string(joints) + " lists of three numbers");
    return offsets;
  }
  for (int i = 0; i < joints; ++i) {
    for (int k = 0; k < 3; ++k) offsets(k, i) = kMetresPerMillimetre * list[i][k].get<double>();
  }
  return offsets;
}

// "x -> -x; joints 1-6 <-> 7-12, 20-28 <-> 29-37": the joint on the other side, and the axis.
std::vector<int> MirroredJoints(const std::string& text, int joints, int* axis,
                                JsonFields* fields) {
  std::vector<int> mirrored(joints);
  for (int i = 0; i < joints; ++i) mirrored[i] = i;
  std::smatch match;
  static const std::regex kAxis("([xyz]) -> -\\1"), kPair("(\\d+)-(\\d+) <-> (\\d+)-(\\d+)");
  if (!std::regex_search(text, match, kAxis)) {
    fields->Fail("mirror", "must read like 'x -> -x; joints 1-6 <-> 7-12'");
    return mirrored;
  }
  *axis = match[1].str()[0] - 'x';
  for (std::sregex_iterator it(text.begin(), text.end(), kPair), end; it != end; ++it) {
    const int first = std::stoi((*it)[1]), last = std::stoi((*it)[2]);
    const int other = std::stoi((*it)[3]), other_last = std::stoi((*it)[4]);
    if (last < first || other_last - other != last - first ||
        std::max(last, other_last) >= joints) {
      fields->Fail("mirror", "pairs joints that do not match: " + it->str());
      return mirrored;
    }
    for (int i = 0; i <= last - first; ++i) {
      mirrored[first + i] = other + i;
      mirrored[other + i] = first + i;
    }
  }
  return mirrored;
}

// duplicates: joint -> the used joint in the same place.
std::vector<int> Duplicates(int joints, JsonFields* fields) {
  std::vector<int> same(joints, -1);
  if (!fields->Has("duplicates")) return same;
  for (const auto& [key, value] : fields->At("duplicates").items()) {
    int64_t joint = -1;
    if (!ParseInteger(key, &joint) || joint < 0 || joint >= joints || !value.is_number_integer() ||
        value.get<int>() < 0 || value.get<int>() >= joints) {
      fields->Fail("duplicates", "must pair joints, not '" + key + "' and " + Shown(value));
      return same;
    }
    same[joint] = value.get<int>();
  }
  return same;
}

void SetLayout(const std::vector<int>& mirrored, const std::vector<int>& same, JsonFields* fields,
               MocapSkeleton* skeleton) {
  const int joints = skeleton->tree.num_joints();
  const Eigen::Matrix3Xd rest = JointPositions(skeleton->tree, Eigen::VectorXd::Zero(3 * joints));
  ParticleLayout& layout = skeleton->layout;
  std::vector<int> particle(joints, -1);
  const int count = static_cast<int>(skeleton->used.size());
  for (int i = 0; i < count; ++i) particle[skeleton->used[i]] = i;
  layout.joints = joints;
  layout.up_axis = kUpAxis;
  layout.weights.assign(count, 1.0f);
  layout.fixed = Eigen::Matrix3Xf::Zero(3, count);
  for (int j = 0; j < joints; ++j) {
    if (same[j] < 0) continue;
    if (particle[same[j]] < 0) return fields->Fail("duplicates", "names a joint that is not used");
    layout.weights[particle[same[j]]] += 1.0f;
  }
  for (int i = 0; i < count; ++i) {
    const int joint = skeleton->used[i], parent = skeleton->tree.parents[joint];
    layout.names.push_back("joint" + std::to_string(joint));
    layout.mirrored.push_back(particle[mirrored[joint]]);
    if (layout.mirrored.back() < 0) {
      return fields->Fail("mirror", "turns used joints into others that are not used");
    }
    const int end = parent >= 0 && same[parent] >= 0 ? same[parent] : parent;
    const bool moves = end >= 0 && particle[end] >= 0;
    layout.parents.push_back(moves ? particle[end] : kFixedPoint);
    // A joint that is not used never moves: it stands where it does at rest.
    if (!moves && end >= 0) layout.fixed.col(i) = rest.col(end).cast<float>();
  }
}

}  // namespace

Result<MocapSkeleton> ReadMocapSkeleton(const std::string& path) {
  Result<JsonDocument> document = JsonDocument{path, Human36mSkeleton(), {}};
  if (path.empty()) {
    document.value().content = Json::parse(document.value().text);
  } else {
    document = ReadJsonDocument(path);
  }
  if (!document.ok()) return document.error();
  JsonFields fields(document.value(), document.value().content, "", "skeleton");
  const int joints = fields.Whole("joints", "a number of joints", 1, kMostJoints);
  MocapSkeleton skeleton;
  skeleton.tree.parents = Indices("parents", -1, joints, &fields);
  skeleton.tree.offsets = Offsets(joints, &fields);
  skeleton.used = Indices("used", 0, joints, &fields);
  const std::vector<int> same = Duplicates(joints, &fields);
  const std::vector<int> mirrored =
      MirroredJoints(fields.Text("mirror", "which joints a mirror pairs"), joints,
                     &skeleton.layout.mirrored_axis, &fields);
  bool in_order = static_cast<int>(skeleton.tree.parents.size()) == joints;
  for (int i = 0; in_order && i < joints; ++i) in_order = skeleton.tree.parents[i] < i;
  if (!in_order) fields.Fail("parents", "must name an earlier joint for each joint, or -1");
  if (!std::is_sorted(skeleton.used.begin(), skeleton.used.end(), std::less_equal<int>()) ||
      skeleton.used.empty()) {
    fields.Fail("used", "must list joints once each, in ascending order");
  }
  if (!fields.failed()) SetLayout(mirrored, same, &fields, &skeleton);
  if (fields.error()) return *fields.error();
  return skeleton;
}

namespace {

constexpr int kTestSeed36 = 1234567890, kPairs = 4;
constexpr int kFirstStart = 16, kPrefix = 50, kSuffix = 100;  // frames

}  // namespace

// Parents and offsets as the literature's forward kinematics has them. Of 32 joints ten are hips'
// roots, or stand where another does.
const char* Human36mSkeleton() {
  return R"({
  "joints": 32,
  "parents": [-1, 0, 1, 2, 3, 4, 0, 6, 7, 8, 9, 0, 11, 12, 13, 14, 12, 16, 17, 18, 19, 20, 19, 22,
    12, 24, 25, 26, 27, 28, 27, 30],
  "offsets_mm": [[0, 0, 0], [-132.948591, 0, 0], [0, -442.894612, 0], [0, -454.206447, 0],
    [0, 0, 162.767078], [0, 0, 74.999437], [132.948826, 0, 0], [0, -442.894413, 0],
    [0, -454.20659, 0], [0, 0, 162.767426], [0, 0, 74.999948], [0, 0.1, 0], [0, 233.383263, 0],
    [0, 257.077681, 0], [0, 121.134938, 0], [0, 115.002227, 0], [0, 257.077681, 0],
    [0, 151.034226, 0], [0, 278.882773, 0], [0, 251.733451, 0], [0, 0, 0], [0, 0, 99.999627],
    [0, 100.000188, 0], [0, 0, 0], [0, 257.077681, 0], [0, 151.031437, 0], [0, 278.892924, 0],
    [0, 251.72868, 0], [0, 0, 0], [0, 0, 99.999888], [0, 137.499922, 0], [0, 0, 0]],
  "used": [2, 3, 4, 5, 7, 8, 9, 10, 12, 13, 14, 15, 17, 18, 19, 21, 22, 25, 26, 27, 29, 30],
  "duplicates": {"16": 13, "20": 19, "23": 22, "24": 13, "28": 27, "31": 30},
  "mirror": "x -> -x; joints 1-5 <-> 6-10, 16-23 <-> 24-31"
})";
}

std::vector<std::pair<int, int>> PairedWindowStarts(int frames, int frames_of_other) {
  std::vector<std::pair<int, int>> starts;
  const auto range = [](int n) { return n - kPrefix - kSuffix - kFirstStart - 1; };
  if (range(frames) < 0 || range(frames_of_other) < 0) return starts;
  std::mt19937 random(kTestSeed36);
  const auto draw = [&random](int largest) {
    uint32_t mask = 0;
    while (mask < static_cast<uint32_t>(largest)) mask = 2 * mask + 1;
    if (mask == 0) return kFirstStart;
    uint32_t word = 0;
    do {
      word = static_cast<uint32_t>(random()) & mask;
    } while (word > static_cast<uint32_t>(largest));
    return kFirstStart + static_cast<int>(word);
  };
  for (int i = 0; i < kPairs; ++i) {
    const int first = draw(range(frames));
    starts.emplace_back(first, draw(range(frames_of_other)));
  }
  return starts;
}

}  // namespace pushid
