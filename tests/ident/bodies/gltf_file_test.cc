// glTF files, read back by hand and by an independent program.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdlib>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "ident/bodies/body_files.h"
#include "models/restoration/restoration.h"
#include "tests/models/body_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

std::string FromBase64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(digits.find(c));
    count += 6;
    if (count >= 8) bytes.push_back(static_cast<char>(bits >> (count -= 8) & 255));
  }
  return bytes;
}

// A file's scene at its key frames, by the rules of the standard.
class GltfReader {
 public:
  GltfReader(Json json, std::string bytes) : json_(std::move(json)), bytes_(std::move(bytes)) {
    for (std::size_t n = 0; n < json_["nodes"].size(); ++n) {
      for (int child : json_["nodes"][n].value("children", std::vector<int>{})) {
        parent_[child] = static_cast<int>(n);
      }
    }
  }

  std::vector<float> Numbers(int accessor) const {
    const Json& one = json_["accessors"][accessor];
    const Json& view = json_["bufferViews"][one["bufferView"].get<int>()];
    std::vector<float> numbers(view["byteLength"].get<std::size_t>() / sizeof(float));
    EXPECT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(),
              bytes_.size());
    std::memcpy(numbers.data(), bytes_.data() + view["byteOffset"].get<std::size_t>(),
                numbers.size() * sizeof(float));
    return numbers;
  }

  Eigen::Affine3d World(int node, int frame) const {
    const Eigen::Affine3d local = Local(node, frame);
    return parent_.count(node) ? World(parent_.at(node), frame) * local : local;
  }

  int Find(const std::string& name, int from = 0) const {
    for (std::size_t n = from; n < json_["nodes"].size(); ++n) {
      if (json_["nodes"][n].value("name", "") == name) return static_cast<int>(n);
    }
    return -1;
  }

  const Json& json() const { return json_; }

 private:
  Eigen::Affine3d Local(int node, int frame) const {
    const Json& one = json_["nodes"][node];
    std::vector<float> place = one.value("translation", std::vector<float>{0, 0, 0});
    std::vector<float> turn = one.value("rotation", std::vector<float>{0, 0, 0, 1});
    const Json& animation = json_["animations"][0];
    for (const Json& channel : animation["channels"]) {
      if (channel["target"]["node"] != node || channel["target"]["path"] == "scale") continue;
      const Json& sampler = animation["samplers"][channel["sampler"].get<int>()];
      const std::vector<float> all = Numbers(sampler["output"]);
      const bool turns = channel["target"]["path"] == "rotation";
      const int width = turns ? 4 : 3;
      (turns ? turn : place).assign(all.begin() + width * frame, all.begin() + width * (frame + 1));
    }
    return Eigen::Translation3d(place[0], place[1], place[2]) *
           Eigen::Quaterniond(turn[3], turn[0], turn[1], turn[2]);
  }

  const Json json_;
  const std::string bytes_;
  std::map<int, int> parent_;
};

// Two people: one carried by the pendulum and turned, one whose bones also change their length.
BodyScene TwoPeople() {
  BodyScene scene;
  scene.id = "pair";
  scene.dt = 1.0 / 60.0;
  scene.subject_ids = {"Anna", "Ben"};
  BodyMotion carried = RigidRestoration().Restore({MovingPerson(StandingPose(), 80, 12)})[0];
  BodyMotion stretched = carried;
  for (size_t t = 0; t < carried.size(); ++t) {
    const double s = static_cast<double>(t);
    carried[t] = Placed(carried[t], 0.1 * s, {0, 0, 0});
    stretched[t] = Placed(stretched[t], -0.05 * s, {0.5, 0.2, 0});
    stretched[t].col(kLeftWrist) += Eigen::Vector3d(0.02 * s, 0.01 * s, 0.03 * s);
  }
  scene.bodies = {carried, stretched};
  return scene;
}

void ExpectHolds(const BodyScene& scene, const GltfReader& file) {
  const std::vector<std::string> names = DefaultJointNames();
  for (int n = 0; n < scene.num_people(); ++n) {
    const int person = file.Find(scene.subject_ids[n]);
    ASSERT_GE(person, 0);
    for (int t : {0, 5, 11}) {
      for (int j = 0; j < kBodyJoints; ++j) {
        const int node = file.Find(names[j], person);
        ASSERT_GE(node, 0) << names[j];
        const Eigen::Vector3d place = file.World(node, t).translation();
        // z up, x forward, y left are y, z and x there.
        const Eigen::Vector3d world(place.z(), place.x(), place.y());
        EXPECT_LT((world - scene.bodies[n][t].col(j)).norm(), 1e-4) << names[j] << " at " << t;
      }
    }
  }
}

using GltfTest = TempDirTest;

TEST_F(GltfTest, EveryJointStandsWhereTheBodyHasIt) {
  const BodyScene scene = TwoPeople();
  const auto files = Unwrapped(WriteBodyFiles(Path("m.gltf"), scene));
  EXPECT_EQ(files, std::vector<std::string>{Path("m.gltf")}) << "one file for everybody";
  const Json json = Json::parse(ReadText(Path("m.gltf")));
  EXPECT_EQ(json["asset"]["version"], "2.0");
  const std::string uri = json["buffers"][0]["uri"];
  const std::string head = "data:application/octet-stream;base64,";
  ASSERT_EQ(uri.substr(0, head.size()), head);
  const std::string bytes = FromBase64(uri.substr(head.size()));
  EXPECT_EQ(bytes.size(), json["buffers"][0]["byteLength"].get<std::size_t>());
  const GltfReader file(json, bytes);
  ExpectHolds(scene, file);
  // The key frames are those of the recording.
  const std::vector<float> times = file.Numbers(json["animations"][0]["samplers"][0]["input"]);
  ASSERT_EQ(times.size(), 12u);
  EXPECT_FLOAT_EQ(times[11], 11.0f / 60.0f);
  EXPECT_EQ(json["scenes"][0]["nodes"].size(), 2u);
}

TEST_F(GltfTest, TheBinaryFileHoldsTheSame) {
  const BodyScene scene = TwoPeople();
  ASSERT_TRUE(WriteBodyFiles(Path("m.glb"), scene).ok());
  const std::string file = ReadText(Path("m.glb"));
  const auto word = [&file](std::size_t at) {
    std::uint32_t value = 0;
    for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(file[at + i]);
    return value;
  };
  EXPECT_EQ(file.substr(0, 4), "glTF");
  EXPECT_EQ(word(4), 2u);
  EXPECT_EQ(word(8), file.size());
  const std::size_t json = word(12);
  EXPECT_EQ(json % 4, 0u);
  EXPECT_EQ(file.substr(16, 4), "JSON");
  EXPECT_EQ(file.substr(24 + json, 4), std::string("BIN\0", 4));
  EXPECT_EQ(word(20 + json), file.size() - 28 - json);
  const Json document = Json::parse(file.substr(20, json));
  EXPECT_FALSE(document["buffers"][0].contains("uri"));
  ExpectHolds(scene, GltfReader(document, file.substr(28 + json)));
}

// Bones point from their joint to the next one, and there is one for each and for the head.
TEST_F(GltfTest, BonesLieAlongTheBody) {
  BodyScene scene = TwoPeople();
  scene.bodies.pop_back();
  scene.subject_ids.pop_back();
  ASSERT_TRUE(WriteBodyFiles(Path("m.gltf"), scene).ok());
  const Json json = Json::parse(ReadText(Path("m.gltf")));
  const GltfReader file(json, FromBase64(std::string(json["buffers"][0]["uri"]).substr(37)));
  int bones = 0;
  const int knee = file.Find("LeftKnee"), ankle = file.Find("LeftAnkle");
  for (std::size_t n = 0; n < json["nodes"].size(); ++n) {
    const Json& node = json["nodes"][n];
    bones += node.contains("mesh") ? 1 : 0;
    const auto children = json["nodes"][knee]["children"].get<std::vector<int>>();
    if (!node.contains("mesh") ||
        std::find(children.begin(), children.end(), static_cast<int>(n)) == children.end()) {
      continue;
    }
    const double length = node["scale"][1];
    for (int t : {0, 11}) {
      const Eigen::Vector3d end =
          file.World(static_cast<int>(n), t) * Eigen::Vector3d(0.0, length, 0.0);
      EXPECT_LT((end - file.World(ankle, t).translation()).norm(), 1e-4);
    }
  }
  EXPECT_EQ(bones, 22) << "21 bones and a head";
  const Json& position =
      json["accessors"][json["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<int>()];
  EXPECT_EQ(position["count"], 24);
  EXPECT_EQ(position["max"], (std::vector<float>{1, 1, 1}));
  EXPECT_EQ(position["min"], (std::vector<float>{-1, 0, -1}));
}

// Ben's left foot stands from frame 3 to 9 and again from 11 on, where it points: 0.3 rad to the
// left.
TEST_F(GltfTest, AFootprintIsThereWhileTheFootStands) {
  BodyScene scene = TwoPeople();
  for (Pose& pose : scene.bodies[1]) pose = Placed(StandingPose(), 0.3, {0.5, 0.2, 0.0});
  const Eigen::Vector3d ankle = scene.bodies[1][0].col(kLeftAnkle);
  scene.footprints = {{}, {{Foot::kLeft, 3, 9, ankle.head<2>()}, {Foot::kLeft, 0, 2, {0, 0}}}};
  ASSERT_TRUE(WriteBodyFiles(Path("m.gltf"), scene).ok());
  const Json json = Json::parse(ReadText(Path("m.gltf")));
  const GltfReader file(json, FromBase64(std::string(json["buffers"][0]["uri"]).substr(37)));
  const int node = file.Find("left foot of Ben, 0.05-0.15 s");
  ASSERT_GE(node, 0);
  EXPECT_GE(file.Find("left foot of Ben, 0-0.0333 s"), 0);
  EXPECT_EQ(json["scenes"][0]["nodes"].size(), 4u);
  const Json& mesh = json["meshes"][json["nodes"][node]["mesh"].get<int>()];
  EXPECT_EQ(json["materials"][mesh["primitives"][0]["material"].get<int>()]["name"], "Ben");
  for (const Json& channel : json["animations"][0]["channels"]) {
    if (channel["target"]["node"] != node) continue;
    EXPECT_EQ(channel["target"]["path"], "scale");
    const Json& sampler = json["animations"][0]["samplers"][channel["sampler"].get<int>()];
    EXPECT_EQ(sampler["interpolation"], "STEP");
    EXPECT_EQ(file.Numbers(sampler["input"]), (std::vector<float>{0.0f, 0.05f, 0.15f}));
    const std::vector<float> scales = file.Numbers(sampler["output"]);
    ASSERT_EQ(scales.size(), 9u);
    EXPECT_EQ(scales[2], 0.0f);
    EXPECT_GT(scales[5], 0.2f);
    EXPECT_EQ(scales[8], 0.0f);
  }
  // Its long side lies under ankle and toe.
  const Eigen::Affine3d place = file.World(node, 0);
  const Eigen::Vector3d middle = place.translation(), along = place.linear().col(2);
  const Eigen::Vector3d foot = scene.bodies[1][0].col(kLeftToe) - ankle;
  const Eigen::Vector2d forward(along.z(), along.x()), way = foot.head<2>().normalized();
  EXPECT_LT((forward - way).norm(), 1e-6);
  const Eigen::Vector2d off = Eigen::Vector2d(middle.z(), middle.x()) - ankle.head<2>();
  EXPECT_NEAR(off.x() * way.y() - off.y() * way.x(), 0.0, 1e-6);
  EXPECT_GT(off.dot(way), 0.0);
  EXPECT_LE(middle.y(), 0.0);
}

TEST_F(GltfTest, NamesThatAreNoTextDoNotBreakIt) {
  BodyScene scene = TwoPeople();
  scene.subject_ids = {"\"Anna\\", "\xff\xfe"};
  ASSERT_TRUE(WriteBodyFiles(Path("m.gltf"), scene).ok());
  EXPECT_EQ(Json::parse(ReadText(Path("m.gltf")))["materials"][0]["name"], "\"Anna\\");
  EXPECT_FALSE(WriteBodyFiles(Path("no/folder/m.glb"), scene).ok());
}

TEST_F(GltfTest, AnIndependentReaderTakesIt) {
  if (std::system("command -v assimp >/dev/null 2>&1") != 0) GTEST_SKIP() << "assimp is not here";
  for (const char* name : {"m.glb", "m.gltf"}) {
    ASSERT_TRUE(WriteBodyFiles(Path(name), TwoPeople()).ok());
    const std::string command =
        "assimp info " + Path(name) + " > " + Path("info.txt") + " 2>/dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0) << name;
    const std::string info = ReadText(Path("info.txt"));
    EXPECT_TRUE(Contains(info, "Animations:         1"));
    EXPECT_TRUE(Contains(info, "Meshes:             2"));
    EXPECT_TRUE(Contains(info, "LeftAnkle"));
    EXPECT_TRUE(Contains(info, "Ben"));
  }
}

}  // namespace
}  // namespace pushid
