// ident: generators written and read.
#include "ident/generators/generator_files.h"

#include <nlohmann/json.hpp>

#include "datasets/manifest/recording.h"
#include "ident/bodies/tensor_folder.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;
// flag: what names the folder.
TensorFolderKind GeneratorFolder(const char* flag) {
  return {"generator", flag, "pushid-train-generator --out", 1};
}
constexpr int kMostParticles = 1000;

bool IsKind(const std::string& name) { return FromName<GeneratorKind>(name).has_value(); }

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
           "particle " + std::to_string(i) + " names particles that do not exist");
    if (layout.parents[i] != kFixedPoint) continue;
    for (int k = 0; k < 3; ++k) layout.fixed(k, i) = particle.at("fixed_m").at(k);
  }
  return layout;
}

Json SettingsJson(const TrainedNetworks& trained) {
  const GeneratorSettings& settings = trained.settings;
  Json json = {{"data", NameOf(settings.data)},
               {"observed", settings.observed},
               {"predicted", settings.predicted},
               {"rate_hz", settings.rate},
               {"layout", LayoutJson(settings.layout)}};
  if (settings.choice) {
    json["choice"] = {{"by", NameOf(settings.choice->by)}, {"blend", settings.choice->blend}};
  }
  for (const PushKind kind : settings.push_kinds) json["push_kinds"].push_back(NameOf(kind));
  json.update(trained.of_kind->Settings());
  return json;
}

TrainedNetworks Read(const TensorFolder& folder, TensorReader* reader) {
  const Json& json = *folder.settings;
  TrainedNetworks trained;
  GeneratorSettings& settings = trained.settings;
  ParseSetting(json, "data", &settings.data);
  settings.observed = json.at("observed");
  settings.predicted = json.at("predicted");
  settings.rate = json.at("rate_hz");
  Demand(!json.value("pendulum", false),
         "it corrects physics (--pendulum_input), which is gone: blend it with them, and train it "
         "again");
  for (const Json& name : json.value("push_kinds", Json::array())) {
    const std::optional<PushKind> kind = FromName<PushKind>(name.get<std::string>());
    Demand(kind.has_value(), "push_kinds has " + name.dump() + ", which is not a kind of push");
    settings.push_kinds.push_back(*kind);
  }
  settings.layout = LayoutFrom(json.at("layout"));
  if (json.contains("choice")) {
    settings.choice.emplace();
    ParseSetting(json["choice"], "by", &settings.choice->by);
    settings.choice->blend = json["choice"].at("blend");
    Demand(settings.choice->blend >= 0.0 && settings.choice->blend <= 1.0,
           "blend must lie between 0 and 1");
  }
  settings.training = folder.training;
  Demand(settings.observed >= 1 && settings.predicted >= 1 && settings.rate > 0.0,
         "observed, predicted and rate_hz must be positive");
  GeneratorKind kind{};
  ParseName("kind", folder.kind, &kind);  // ReadTensorFolder has checked it
  trained.of_kind = RowOf(kind).read(json, settings, reader);
  return trained;
}

}  // namespace

int ReadMembers(const Json& json) {
  constexpr int kMostMembers = 100;
  const int members = json.at("members");
  Demand(members >= 1 && members <= kMostMembers, "members must be 1 to 100");
  return members;
}

MaybeError WriteGenerator(const std::string& folder, const TrainedNetworks& trained) {
  return WriteTensorFolder(GeneratorFolder("--out"), folder,
                           {NameOf(trained.kind()), SettingsJson(trained),
                            trained.settings.training, trained.of_kind->Tensors()});
}

std::unique_ptr<MotionGenerator> MakeGenerator(const TrainedNetworks& trained,
                                               const GeneratorChanges& changes) {
  return trained.of_kind->Make(trained.settings, changes);
}

Result<LoadedGenerator> LoadGenerator(const std::string& folder, const GeneratorChanges& changes,
                                      const char* flag) {
  const Result<TensorFolder> read = ReadTensorFolder(
      GeneratorFolder(flag), folder, Listed(AllNames<GeneratorKind>(), ","), IsKind);
  if (!read.ok()) return read.error();
  const std::string path = JsonFileOf(GeneratorFolder(flag), folder);
  TensorReader reader(read.value().tensors);
  TrainedNetworks trained;
  try {
    trained = Read(read.value(), &reader);
  } catch (const std::exception& problem) {
    return Error{std::string("settings: ") + problem.what() + "; train again with this version",
                 path};
  }
  if (!reader.problem().empty()) {
    return Error{reader.problem() + "; train again with this version", path};
  }
  if (const MaybeError error = trained.of_kind->Check(changes)) return Error{error->message, path};
  return LoadedGenerator{trained.kind(), trained.settings, MakeGenerator(trained, changes),
                         nullptr};
}

}  // namespace pushid
