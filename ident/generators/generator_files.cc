// ident: generators written and read.
#include "ident/generators/generator_files.h"

#include <nlohmann/json.hpp>

#include "datasets/files/number_text.h"
#include "datasets/files/random.h"
#include "datasets/manifest/recording.h"
#include "ident/bodies/tensor_folder.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;
// flag: what names the folder.
TensorFolderKind GeneratorFolder(const char* flag) {
  return {"generator", flag, "pushid-train-generator --out", 1};
}
constexpr int kMostParticles = 1000, kMostControls = 1000, kMostCorrected = 100000,
              kMostBlocks = 1000;

bool IsKind(const std::string& name) { return FromName<GeneratorKind>(name).has_value(); }

std::string KindNames() {
  std::string names;
  for (const std::string& name : AllNames<GeneratorKind>()) {
    names += (names.empty() ? "" : ", ") + name;
  }
  return names;
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
  Json json = {{"data", NameOf(settings.data)},   {"observed", settings.observed},
               {"predicted", settings.predicted}, {"rate_hz", settings.rate},
               {"pendulum", settings.pendulum},   {"layout", LayoutJson(settings.layout)}};
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
  settings.pendulum = json.value("pendulum", false);  // files from before have none
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
  const Result<TensorFolder> read =
      ReadTensorFolder(GeneratorFolder(flag), folder, KindNames(), IsKind);
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

namespace {

constexpr char kSimlpePartner[] = "simlpe";  // of its tensors, beside particles

Json SimlpeSettings(const std::vector<SimlpeNetwork>& members) {
  return {{"members", members.size()},
          {"blocks", members.empty() ? 0 : members.front().blocks.size()}};
}

std::vector<SimlpeNetwork> ReadSimlpeMembers(const std::string& name, const Json& json,
                                             const GeneratorSettings& settings,
                                             TensorReader* reader) {
  const int count = ReadMembers(json), blocks = json.at("blocks");
  Demand(blocks >= 1 && blocks <= kMostBlocks, "blocks must be 1 to 1000");
  std::vector<SimlpeNetwork> members;
  for (int m = 0; m < count; ++m) {
    members.push_back(TakeSimlpe(MemberName(m, name), settings.observed,
                                 settings.layout.num_coordinates(), blocks, reader));
  }
  return members;
}

double ReadShare(const Json& json, const char* key) {
  const double share = json.value(key, 0.0);  // older files know no siMLPe
  Demand(share >= 0.0 && share <= 1.0, std::string(key) + " must lie between 0 and 1");
  return share;
}

}  // namespace

Json TrainedParticles::Settings() const {
  const ParticleStructure& structure = members.front().structure;
  return {{"members", members.size()},
          {"cell", NameOf(structure.cell)},
          {"skip", structure.skip},
          {"pose_operator", structure.pose_operator},
          {"particles", structure.particles},
          {"poses", structure.poses},
          {"controls", structure.controls},
          {"correlated_noise", structure.correlated_noise},
          {"corrected_frames", structure.corrected_frames},
          {"jitter", jitter},
          {"ridge_share", ridge_share},
          {"simlpe_share", simlpe_share},
          {"simlpe", SimlpeSettings(partners.simlpe)}};
}

TensorList TrainedParticles::Tensors() const {
  TensorList tensors = TensorsOf(members);
  const RidgeForecast& ridge = partners.ridge;
  if (ridge_share > 0.0) AddTensors("ridge", DenseLayer{ridge.weights, ridge.bias}, &tensors);
  AddMembers(kSimlpePartner, partners.simlpe, &tensors);
  return tensors;
}

SharedNetworks ReadParticles(const Json& json, const GeneratorSettings& settings,
                             TensorReader* reader) {
  const auto networks = std::make_shared<TrainedParticles>();
  TrainedParticles& trained = *networks;
  ParticleStructure structure;
  ParseSetting(json, "cell", &structure.cell);
  structure.skip = json.at("skip");
  structure.pose_operator = json.at("pose_operator");
  structure.particles = json.at("particles");
  structure.poses = json.value("poses", true);  // older files have none
  Demand(structure.particles || structure.poses, "particles or poses must be true");
  structure.controls = json.at("controls");
  structure.corrected_frames = json.value("corrected_frames", 0);
  structure.correlated_noise = json.value("correlated_noise", false);  // older files have none
  trained.jitter = json.at("jitter");
  trained.ridge_share = ReadShare(json, "ridge_share");
  trained.simlpe_share = ReadShare(json, "simlpe_share");
  Demand(structure.controls >= 0 && structure.controls <= kMostControls,
         "controls must be 0 to 1000");
  Demand(structure.corrected_frames >= 0 && structure.corrected_frames <= kMostCorrected,
         "corrected_frames must be 0 to 100000");
  Demand(trained.jitter >= 0.0, "jitter must not be negative");
  const int members = ReadMembers(json), size = settings.layout.num_coordinates();
  for (int m = 0; m < members; ++m) {
    trained.members.push_back(TakeParticles(MemberName(m), structure, size, reader));
  }
  if (trained.simlpe_share > 0.0) {
    trained.partners.simlpe =
        ReadSimlpeMembers(kSimlpePartner, json.at("simlpe"), settings, reader);
  }
  if (trained.ridge_share <= 0.0) return networks;
  Demand(settings.observed > kRidgeDisplacements, "the ridge needs more observed frames");
  DenseLayer ridge;
  TensorFields(reader).Layer("ridge", size * (1 + kRidgeDisplacements), size * settings.predicted,
                             &ridge);
  trained.partners.ridge = {ridge.weights, ridge.bias};
  return networks;
}

MaybeError TrainedParticles::Check(const GeneratorChanges& changes) const {
  if (changes.ridge_share.value_or(0.0) > 0.0 && ridge_share <= 0.0) {
    return Error{"this generator was trained without a ridge; leave out --ridge_share"};
  }
  if (changes.simlpe_share.value_or(0.0) > 0.0 && simlpe_share <= 0.0) {
    return Error{"this generator was trained without siMLPe; leave out --simlpe_share"};
  }
  return std::nullopt;
}

std::unique_ptr<MotionGenerator> TrainedParticles::Make(const GeneratorSettings& settings,
                                                        const GeneratorChanges& changes) const {
  ParticleGeneratorOptions options = changes.particles;
  options.jitter = jitter;
  options.ridge_share = changes.ridge_share.value_or(ridge_share);
  options.simlpe_share = changes.simlpe_share.value_or(simlpe_share);
  return std::make_unique<ParticleGenerator>(settings.layout, members, partners, options);
}

Json TrainedSimlpe::Settings() const { return SimlpeSettings(members); }

SharedNetworks ReadSimlpe(const Json& json, const GeneratorSettings& settings,
                          TensorReader* reader) {
  const auto trained = std::make_shared<TrainedSimlpe>();
  trained->members = ReadSimlpeMembers(kMember, json, settings, reader);
  return trained;
}

std::unique_ptr<MotionGenerator> TrainedSimlpe::Make(const GeneratorSettings& settings,
                                                     const GeneratorChanges&) const {
  return std::make_unique<SimlpeGenerator>(settings.layout, members);
}

nlohmann::ordered_json TrainedDiffusion::Settings() const {
  const DiffusionStructure& structure = members.front().structure;
  return {{"members", members.size()},
          {"pooling", NameOf(structure.pooling)},
          {"pooling_at", NameOf(structure.join)},
          {"frame", NameOf(structure.frame)}};
}

SharedNetworks ReadDiffusion(const nlohmann::ordered_json& json, const GeneratorSettings& settings,
                             TensorReader* reader) {
  Demand(settings.layout.num_particles() == kBodyJoints, "diffusion needs bodies of 22 joints");
  const auto trained = std::make_shared<TrainedDiffusion>();
  DiffusionStructure structure;
  ParseSetting(json, "pooling", &structure.pooling);
  ParseSetting(json, "pooling_at", &structure.join);
  ParseSetting(json, "frame", &structure.frame);
  Demand(structure.frame == MotionFrame::kGroup || !settings.pendulum,
         "people's own frames know no pendulum");
  structure.pendulum = settings.pendulum;
  const int members = ReadMembers(json);
  for (int m = 0; m < members; ++m) {
    trained->members.push_back(TakeDiffusion(MemberName(m), structure, reader));
  }
  return trained;
}

std::unique_ptr<MotionGenerator> TrainedDiffusion::Make(const GeneratorSettings& settings,
                                                        const GeneratorChanges& changes) const {
  const auto noise = [seed = changes.seed] {
    const auto random = std::make_shared<Random>(seed);
    return NormalSource([random] { return random->Normal(); });
  };
  DiffusionGeneratorOptions options = changes.diffusion;
  options.learnt_frames = settings.observed + settings.predicted;
  return std::make_unique<DiffusionGenerator>(settings.layout, members, 1.0 / settings.rate,
                                              options, noise);
}

}  // namespace pushid
