// ident: glTF files written.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>

#include "datasets/files/atomic_file.h"
#include "datasets/files/number_text.h"
#include "ident/bodies/body_files.h"
#include "ident/bodies/gltf_shapes.h"
#include "models/decompositions.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

// Codes of the standard.
constexpr int kFloat = 5126, kArrayBuffer = 34962;
constexpr std::uint32_t kGlbMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

constexpr double kBoneWidth = 0.11;                                  // of its length
constexpr float kFootprintWidth = 0.09f, kFootprintHeight = 0.004f;  // m
constexpr double kHeadHeight = 0.2;                                  // m
constexpr double kShortestBone = 1e-4;  // m; shorter ones are not drawn
constexpr double kSameLength = 1e-6;    // m; bones that change by less keep their length

// Okabe and Ito's colours, which the colour-blind tell apart; linear, as glTF has them.
constexpr std::array<std::array<double, 3>, 6> kColours = {{{0.000, 0.168, 0.445},
                                                            {0.791, 0.347, 0.000},
                                                            {0.000, 0.342, 0.171},
                                                            {0.604, 0.191, 0.386},
                                                            {0.093, 0.456, 0.815},
                                                            {0.665, 0.112, 0.000}}};

// From x forward, y left, z up to glTF's z forward, x left, y up.
Eigen::Matrix3d AxesOf(const GltfScene& scene) {
  Eigen::Matrix3d axes;
  if (scene.y_up) return Eigen::Matrix3d::Identity();
  axes << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  return axes;
}

void AppendWord(std::uint32_t word, std::string* bytes) {
  for (int shift = 0; shift < 32; shift += 8) bytes->push_back(static_cast<char>(word >> shift));
}

std::string Base64(const std::string& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k > bytes.size() ? '=' : kDigits[three >> (18 - 6 * k) & 63];
    }
  }
  return text;
}

class GltfWriter {
 public:
  explicit GltfWriter(const GltfScene& scene) : scene_(scene), axes_(AxesOf(scene)) {
    std::size_t frames = 0;
    for (const GltfPerson& person : scene.people) frames = std::max(frames, person.frames.size());
    std::vector<float> times;
    for (std::size_t t = 0; t < frames; ++t) times.push_back(static_cast<float>(t * scene.dt));
    times_ = Accessor(times, 1);
    octahedron_ = Shape(GltfShape::Octahedron());
    for (std::size_t n = 0; n < scene.people.size(); ++n) AddPerson(scene.people[n], n);
    for (const GltfFootprint& print : scene.footprints) AddFootprint(print);
  }

  // Without buffers, which the two kinds of files hold differently.
  Json Document() const {
    const Json scene = {{"name", scene_.name}, {"nodes", people_}};
    const Json animation = {
        {"name", scene_.name}, {"channels", channels_}, {"samplers", samplers_}};
    return {{"asset", {{"version", "2.0"}, {"generator", "pushid"}}},
            {"scene", 0},
            {"scenes", Json::array({scene})},
            {"nodes", nodes_},
            {"meshes", meshes_},
            {"materials", materials_},
            {"animations", Json::array({animation})},
            {"accessors", accessors_},
            {"bufferViews", views_}};
  }
  const std::string& bytes() const { return bytes_; }

 private:
  // Numbers with their range, `width` of them an element.
  int Accessor(const std::vector<float>& numbers, int width, bool of_vertices = false) {
    static constexpr const char* kTypes[] = {"", "SCALAR", "", "VEC3", "VEC4"};
    Json view = {{"buffer", 0},
                 {"byteOffset", bytes_.size()},
                 {"byteLength", numbers.size() * sizeof(float)}};
    if (of_vertices) view["target"] = kArrayBuffer;
    std::vector<float> low(numbers.begin(), numbers.begin() + width), high = low;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      low[i % width] = std::min(low[i % width], numbers[i]);
      high[i % width] = std::max(high[i % width], numbers[i]);
      std::uint32_t word = 0;
      std::memcpy(&word, &numbers[i], sizeof word);
      AppendWord(word, &bytes_);
    }
    accessors_.push_back({{"bufferView", views_.size()},
                          {"componentType", kFloat},
                          {"count", numbers.size() / width},
                          {"type", kTypes[width]},
                          {"min", low},
                          {"max", high}});
    views_.push_back(view);
    return static_cast<int>(accessors_.size()) - 1;
  }

  Json Shape(const GltfShape& shape) {
    return {{"POSITION", Accessor(shape.places, 3, true)},
            {"NORMAL", Accessor(shape.normals, 3, true)}};
  }

  int AddNode(Json node, Json* siblings) {
    siblings->push_back(nodes_.size());
    nodes_.push_back(std::move(node));
    return static_cast<int>(nodes_.size()) - 1;
  }

  void AddPerson(const GltfPerson& person, std::size_t index) {
    const auto& colour = kColours[index % kColours.size()];
    materials_.push_back({{"name", person.name},
                          {"pbrMetallicRoughness",
                           {{"baseColorFactor", {colour[0], colour[1], colour[2], 1.0}},
                            {"metallicFactor", 0.0},
                            {"roughnessFactor", 0.8}}}});
    const Json primitive = {{"attributes", octahedron_}, {"material", materials_.size() - 1}};
    meshes_.push_back(
        {{"name", "bone of " + person.name}, {"primitives", Json::array({primitive})}});
    const int node = AddNode({{"name", person.name}, {"children", Json::array()}}, &people_);
    std::vector<int> joints;
    for (std::size_t j = 0; j < person.joints.size(); ++j) {
      const int parent = person.parents[j];
      const Eigen::Vector3d offset = Offset(person, static_cast<int>(j));
      const int above = parent < 0 ? node : joints[parent];
      Json children = Children(above);
      joints.push_back(
          AddNode({{"name", person.joints[j]}, {"translation", List(offset)}}, &children));
      nodes_[above]["children"] = children;
      if (parent >= 0) AddBone(offset, above);
    }
    if (person.head >= 0) {
      const Eigen::Vector3d neck = Offset(person, person.head);
      AddBone(kHeadHeight *
                  (neck.norm() > kShortestBone ? neck.normalized() : Eigen::Vector3d::UnitY()),
              joints[person.head]);
    }
    for (std::size_t j = 0; j < joints.size(); ++j) Animate(person, static_cast<int>(j), joints[j]);
  }

  Json Children(int node) const { return nodes_[node].value("children", Json::array()); }

  // The mesh of the person that was added last, from a joint along its offset to another.
  void AddBone(const Eigen::Vector3d& offset, int joint) {
    const double length = offset.norm();
    if (length < kShortestBone) return;
    const Eigen::Quaterniond turn = TurnBetween(Eigen::Vector3d::UnitY(), offset);
    const double width = kBoneWidth * length;
    Json children = Children(joint);
    AddNode({{"mesh", meshes_.size() - 1},
             {"rotation", {turn.x(), turn.y(), turn.z(), turn.w()}},
             {"scale", {width, length, width}}},
            &children);
    nodes_[joint]["children"] = children;
  }

  // In the rest, from the parent; of a root, from the origin.
  Eigen::Vector3d Offset(const GltfPerson& person, int joint) const {
    const int parent = person.parents[joint];
    const Eigen::Vector3d from =
        parent < 0 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(person.rest.col(parent));
    return axes_ * (person.rest.col(joint) - from);
  }

  static Json List(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

  void Animate(const GltfPerson& person, int joint, int node) {
    const int parent = person.parents[joint];
    const Eigen::Vector3d offset = Offset(person, joint);
    std::vector<float> turns, places;
    bool moves = parent < 0, rotates = false;
    Eigen::Quaternionf before = Eigen::Quaternionf::Identity();
    for (const PosedJoints& frame : person.frames) {
      Eigen::Matrix3d above = Eigen::Matrix3d::Identity();
      Eigen::Vector3d place = frame.positions.col(joint);
      if (parent >= 0) {
        above = frame.rotations[parent].transpose();
        place = above * (place - frame.positions.col(parent));
      }
      place = axes_ * place;
      moves = moves || (place - offset).norm() > kSameLength;
      for (int i = 0; i < 3; ++i) places.push_back(static_cast<float>(place[i]));
      const Eigen::Matrix3d local = axes_ * above * frame.rotations[joint] * axes_.transpose();
      rotates = rotates || !local.isIdentity(1e-9);
      Eigen::Quaternionf turn(Eigen::Quaterniond(local).normalized().cast<float>());
      if (turn.dot(before) < 0.0f) turn.coeffs() *= -1.0f;  // the short way between two frames
      before = turn;
      turns.insert(turns.end(), turn.coeffs().data(), turn.coeffs().data() + 4);
    }
    if (rotates) AddChannel(node, "rotation", Accessor(turns, 4), times_);
    if (moves) AddChannel(node, "translation", Accessor(places, 3), times_);
  }

  // A flat box as high as nothing while nobody stands on it.
  void AddFootprint(const GltfFootprint& print) {
    if (box_.is_null()) box_ = Shape(GltfShape::Box());
    const Json primitive = {{"attributes", box_}, {"material", print.person}};
    meshes_.push_back({{"name", print.name}, {"primitives", Json::array({primitive})}});
    const Eigen::Matrix3d turned =
        axes_ * Eigen::AngleAxisd(print.heading, Eigen::Vector3d::UnitZ()) * axes_.transpose();
    const Eigen::Quaterniond turn(turned);
    const float size[] = {kFootprintWidth, kFootprintHeight, static_cast<float>(print.length)};
    const int node = AddNode({{"name", print.name},
                              {"mesh", meshes_.size() - 1},
                              {"translation", List(axes_ * print.middle)},
                              {"rotation", {turn.x(), turn.y(), turn.z(), turn.w()}},
                              {"scale", size}},
                             &people_);
    std::vector<float> times, scales;
    const auto key = [&](double time, float factor) {
      times.push_back(static_cast<float>(time));
      for (const float length : size) scales.push_back(factor * length);
    };
    if (print.from > 0.0) key(0.0, 0.0f);
    key(print.from, 1.0f);
    const double last = (scene_.people[print.person].frames.size() - 1) * scene_.dt;
    if (print.to <= last) key(print.to, 0.0f);
    if (times.size() < 2) return;  // it stands throughout
    const int input = Accessor(times, 1);
    AddChannel(node, "scale", Accessor(scales, 3), input, "STEP");
  }

  void AddChannel(int node, const char* path, int accessor, int input,
                  const char* interpolation = "LINEAR") {
    channels_.push_back(
        {{"sampler", samplers_.size()}, {"target", {{"node", node}, {"path", path}}}});
    samplers_.push_back({{"input", input}, {"output", accessor}, {"interpolation", interpolation}});
  }

  const GltfScene& scene_;
  const Eigen::Matrix3d axes_;
  int times_ = 0;
  Json octahedron_, box_;
  Json people_ = Json::array(), nodes_ = Json::array(), meshes_ = Json::array(),
       materials_ = Json::array(), channels_ = Json::array(), samplers_ = Json::array(),
       accessors_ = Json::array(), views_ = Json::array();
  std::string bytes_;
};

void AppendChunk(std::uint32_t kind, std::string content, char padding, std::string* file) {
  content.resize((content.size() + 3) / 4 * 4, padding);
  AppendWord(static_cast<std::uint32_t>(content.size()), file);
  AppendWord(kind, file);
  *file += content;
}

}  // namespace

MaybeError WriteGltf(const std::string& path, const GltfScene& scene) {
  const GltfWriter writer(scene);
  Json document = writer.Document();
  Json buffer = {{"byteLength", writer.bytes().size()}};
  constexpr std::string_view kBinary = ".glb";
  const bool binary = path.size() > kBinary.size() &&
                      EqualsIgnoringCase(path.substr(path.size() - kBinary.size()), kBinary);
  if (!binary) buffer["uri"] = "data:application/octet-stream;base64," + Base64(writer.bytes());
  document["buffers"] = Json::array({buffer});
  // Names come from files: what is no UTF-8 is replaced.
  const std::string json = document.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (!binary) return WriteFileAtomically(path, json);
  std::string chunks, file;
  AppendChunk(kJsonChunk, json, ' ', &chunks);
  AppendChunk(kBinaryChunk, writer.bytes(), '\0', &chunks);
  for (const std::uint32_t word :
       {kGlbMagic, std::uint32_t{2}, static_cast<std::uint32_t>(12 + chunks.size())}) {
    AppendWord(word, &file);
  }
  return WriteFileAtomically(path, file + chunks);
}

}  // namespace pushid
