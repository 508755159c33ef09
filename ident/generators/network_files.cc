// ident: the networks of each kind of generator, written and read.
#include <nlohmann/json.hpp>

#include "datasets/files/random.h"
#include "ident/generators/generator_files.h"
#include "ident/parameters/json_archive.h"

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

template <class Archive>
void Fields(Archive& a, ParticleStructure& s) {
  PUSHID_FIELDS(a, s, cell, skip, pose_operator, particles);
  if (a.Has("poses")) a("poses", s.poses);  // this and those below: older files have none
  a("controls", s.controls);
  if (a.Has("correlated_noise")) a("correlated_noise", s.correlated_noise);
  if (a.Has("corrected_frames")) a("corrected_frames", s.corrected_frames);
  a.Check(s.particles || s.poses, "particles or poses must be true");
  a.Check(s.controls >= 0 && s.controls <= kMostControls, "controls must be 0 to 1000");
  a.Check(s.corrected_frames >= 0 && s.corrected_frames <= kMostCorrected,
          "corrected_frames must be 0 to 100000");
}

template <class Archive>
void Fields(Archive& a, DiffusionStructure& s) {
  a("pooling", s.pooling);
  a("pooling_at", s.join);
  a("frame", s.frame);
}

Json TrainedParticles::Settings() const {
  Json json = {{"members", members.size()}};
  json.update(JsonOf(members.front().structure));
  json.update(Json{{"jitter", jitter},
                   {"ridge_share", ridge_share},
                   {"simlpe_share", simlpe_share},
                   {"simlpe", SimlpeSettings(partners.simlpe)}});
  return json;
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
  structure.correlated_noise = false;  // as in files without that entry
  ReadJson(json, &structure);
  trained.jitter = json.at("jitter");
  trained.ridge_share = ReadShare(json, "ridge_share");
  trained.simlpe_share = ReadShare(json, "simlpe_share");
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
  Json json = {{"members", members.size()}};
  json.update(JsonOf(members.front().structure));
  return json;
}

SharedNetworks ReadDiffusion(const nlohmann::ordered_json& json, const GeneratorSettings& settings,
                             TensorReader* reader) {
  Demand(settings.layout.num_particles() == kBodyJoints, "diffusion needs bodies of 22 joints");
  const auto trained = std::make_shared<TrainedDiffusion>();
  const auto structure = FromJson<DiffusionStructure>(json);
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
