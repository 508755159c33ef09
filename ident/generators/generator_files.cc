// ident: generators written and read.
#include "ident/generators/generator_files.h"

#include "datasets/files/number_text.h"
#include "ident/bodies/tensor_folder.h"
#include "ident/parameters/option_names.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;
constexpr TensorFolderKind kGeneratorFolder = {"generator", "--model",
                                               "pushid-train-generator --out", 1};
constexpr int kMostMembers = 100, kMostParticles = 1000;

std::string KindNames() {
  std::string names;
  for (const auto& row : Names(GeneratorKind{}))
    names += (names.empty() ? "" : ", ") + std::string(row.name);
  return names;
}

bool IsKind(const std::string& name) {
  GeneratorKind kind;
  return !ParseName("kind", name, &kind);
}

Json LayoutJson(const ParticleLayout& layout) {
  Json particles = Json::array();
  for (int i = 0; i < layout.num_particles(); ++i) {
    Json particle = {{"name", layout.names[i]},
                     {"mirrored", layout.mirrored[i]},
                     {"parent", layout.parents[i]},
                     {"weight", layout.weights[i]}};
    if (layout.parents[i] == kFixedPoint) {
      particle["fixed_m"] = {layout.fixed(0, i), layout.fixed(1, i), layout.fixed(2, i)};
    }
    particles.push_back(particle);
  }
  return {{"joints", layout.joints},
          {"up_axis", layout.up_axis},
          {"mirrored_axis", layout.mirrored_axis},
          {"particles", particles}};
}

// The readers below throw nlohmann's exceptions and Error's text where something does not fit.
void Demand(bool holds, const std::string& what) {
  if (!holds) throw std::runtime_error(what);
}

ParticleLayout LayoutFrom(const Json& json) {
  ParticleLayout layout;
  layout.joints = json.at("joints");
  layout.up_axis = json.at("up_axis");
  layout.mirrored_axis = json.at("mirrored_axis");
  const Json& particles = json.at("particles");
  const int count = static_cast<int>(particles.size());
  Demand(count > 0 && count <= kMostParticles, "there must be 1 to 1000 particles");
  Demand(layout.joints > 0 && layout.mirrored_axis >= 0 && layout.mirrored_axis < 3 &&
             layout.up_axis >= 0 && layout.up_axis < 3 && layout.up_axis != layout.mirrored_axis,
         "joints must be positive, up_axis and mirrored_axis two of 0, 1 and 2");
  layout.fixed = Eigen::Matrix3Xf::Zero(3, count);
  for (int i = 0; i < count; ++i) {
    const Json& particle = particles[i];
    layout.names.push_back(particle.at("name"));
    layout.mirrored.push_back(particle.at("mirrored"));
    layout.parents.push_back(particle.at("parent"));
    layout.weights.push_back(particle.at("weight"));
    Demand(layout.mirrored[i] >= 0 && layout.mirrored[i] < count && layout.parents[i] >= kNoBone &&
               layout.parents[i] < i,
           "particle " + std::to_string(i) + " names particles that there are not");
    if (layout.parents[i] != kFixedPoint) continue;
    for (int k = 0; k < 3; ++k) layout.fixed(k, i) = particle.at("fixed_m").at(k);
  }
  return layout;
}

Json SettingsJson(const TrainedParticles& trained) {
  const GeneratorSettings& settings = trained.settings;
  const ParticleStructure& structure = trained.members.front().structure;
  return {{"data", NameOf(settings.data)},
          {"observed", settings.observed},
          {"predicted", settings.predicted},
          {"rate_hz", settings.rate},
          {"layout", LayoutJson(settings.layout)},
          {"members", trained.members.size()},
          {"cell", NameOf(structure.cell)},
          {"skip", structure.skip},
          {"pose_operator", structure.pose_operator},
          {"particles", structure.particles},
          {"controls", structure.controls},
          {"jitter", trained.jitter},
          {"ridge_share", trained.ridge_share}};
}

TrainedParticles Read(const TensorFolder& folder, TensorReader* reader) {
  const Json& json = folder.settings;
  TrainedParticles trained;
  GeneratorSettings& settings = trained.settings;
  const auto parse = [&json](const char* key, auto* value) {
    const MaybeError error = ParseName(key, json.at(key).get<std::string>(), value);
    if (error) throw std::runtime_error(error->message);
  };
  parse("data", &settings.data);
  settings.observed = json.at("observed");
  settings.predicted = json.at("predicted");
  settings.rate = json.at("rate_hz");
  settings.layout = LayoutFrom(json.at("layout"));
  settings.training = folder.training;
  ParticleStructure structure;
  parse("cell", &structure.cell);
  structure.skip = json.at("skip");
  structure.pose_operator = json.at("pose_operator");
  structure.particles = json.at("particles");
  structure.controls = json.at("controls");
  const int members = json.at("members");
  trained.jitter = json.at("jitter");
  trained.ridge_share = json.at("ridge_share");
  Demand(settings.observed >= 1 && settings.predicted >= 1 && settings.rate > 0.0,
         "observed, predicted and rate_hz must be positive");
  Demand(members >= 1 && members <= kMostMembers && structure.controls >= 0 &&
             structure.controls <= kMostParticles,
         "members must be 1 to 100, and controls not negative");
  Demand(trained.jitter >= 0.0, "jitter must not be negative");
  Demand(trained.ridge_share >= 0.0 && trained.ridge_share <= 1.0,
         "ridge_share must lie between 0 and 1");
  const int size = settings.layout.num_coordinates();
  for (int m = 0; m < members; ++m) {
    trained.members.push_back(TakeParticles("member" + std::to_string(m), structure, size, reader));
  }
  if (trained.ridge_share <= 0.0) return trained;
  Demand(settings.observed > kRidgeDisplacements, "the ridge needs more observed frames");
  const DenseLayer ridge =
      TakeLayer("ridge", size * (1 + kRidgeDisplacements), size * settings.predicted, reader);
  trained.ridge = {ridge.weights, ridge.bias};
  return trained;
}

}  // namespace

MaybeError WriteGenerator(const std::string& folder, const TrainedParticles& trained) {
  TensorFolder content;
  content.kind = NameOf(GeneratorKind::kParticles);
  content.settings = SettingsJson(trained);
  content.training = trained.settings.training;
  for (size_t m = 0; m < trained.members.size(); ++m) {
    AddTensors("member" + std::to_string(m), trained.members[m], &content.tensors);
  }
  if (trained.ridge_share > 0.0) {
    AddTensors("ridge", DenseLayer{trained.ridge.weights, trained.ridge.bias}, &content.tensors);
  }
  return WriteTensorFolder(kGeneratorFolder, folder, content);
}

std::unique_ptr<MotionGenerator> MakeGenerator(const TrainedParticles& trained,
                                               const GeneratorChanges& changes) {
  ParticleGeneratorOptions options;
  options.project_bones = changes.project_bones;
  options.jitter = trained.jitter;
  options.noise_memory = changes.noise_memory;
  options.noise_scale = changes.noise_scale;
  options.ridge_share =
      trained.ridge_share > 0.0 ? changes.ridge_share.value_or(trained.ridge_share) : 0.0;
  return std::make_unique<ParticleGenerator>(trained.settings.layout, trained.members,
                                             trained.ridge, options);
}

Result<LoadedGenerator> LoadGenerator(const std::string& folder, const GeneratorChanges& changes) {
  const Result<TensorFolder> read = ReadTensorFolder(kGeneratorFolder, folder, KindNames(), IsKind);
  if (!read.ok()) return read.error();
  const std::string path = JsonFileOf(kGeneratorFolder, folder);
  TensorReader reader(read.value().tensors);
  TrainedParticles trained;
  try {
    trained = Read(read.value(), &reader);
  } catch (const std::exception& problem) {
    return Error{std::string("settings: ") + problem.what() + "; train again with this version",
                 path};
  }
  if (!reader.problem().empty()) {
    return Error{reader.problem() + "; train again with this version", path};
  }
  if (changes.ridge_share.value_or(0.0) > 0.0 && trained.ridge_share <= 0.0) {
    return Error{"this generator was trained without a ridge; leave out --ridge_share", path};
  }
  return LoadedGenerator{trained.settings, MakeGenerator(trained, changes)};
}

}  // namespace pushid
