// ident: the networks of each kind of generator, written and read.
#include <nlohmann/json.hpp>

#include "datasets/files/random.h"
#include "ident/generators/generator_files.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMostControls = 1000, kMostCorrected = 100000, kMostBlocks = 1000;
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
