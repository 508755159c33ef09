// ident: networks of generators, to and from settings and tensors.
#include "ident/generators/trained_networks.h"

#include <nlohmann/json.hpp>

#include "datasets/files/random.h"
#include "ident/generators/generator_files.h"
#include "ident/generators/push_particles.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;
constexpr int kMostControls = 1000, kMostCorrected = 100000;

}  // namespace

Json TrainedParticles::Settings() const {
  const ParticleStructure& structure = members.front().structure;
  return {{"members", members.size()},
          {"cell", NameOf(structure.cell)},
          {"skip", structure.skip},
          {"pose_operator", structure.pose_operator},
          {"particles", structure.particles},
          {"controls", structure.controls},
          {"correlated_noise", structure.correlated_noise},
          {"corrected_frames", structure.corrected_frames},
          {"jitter", jitter},
          {"ridge_share", ridge_share}};
}

TensorList TrainedParticles::Tensors() const {
  TensorList tensors = TensorsOf(members);
  if (ridge_share > 0.0) AddTensors("ridge", DenseLayer{ridge.weights, ridge.bias}, &tensors);
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
  structure.controls = json.at("controls");
  structure.corrected_frames = json.value("corrected_frames", 0);
  structure.correlated_noise = json.value("correlated_noise", false);  // older files have none
  trained.jitter = json.at("jitter");
  trained.ridge_share = json.at("ridge_share");
  Demand(structure.controls >= 0 && structure.controls <= kMostControls,
         "controls must be 0 to 1000");
  Demand(structure.corrected_frames >= 0 && structure.corrected_frames <= kMostCorrected,
         "corrected_frames must be 0 to 100000");
  Demand(trained.jitter >= 0.0, "jitter must not be negative");
  Demand(trained.ridge_share >= 0.0 && trained.ridge_share <= 1.0,
         "ridge_share must lie between 0 and 1");
  const int members = ReadMembers(json), size = settings.layout.num_coordinates();
  for (int m = 0; m < members; ++m) {
    trained.members.push_back(TakeParticles(MemberName(m), structure, size, reader));
  }
  if (trained.ridge_share <= 0.0) return networks;
  Demand(settings.observed > kRidgeDisplacements, "the ridge needs more observed frames");
  DenseLayer ridge;
  TensorFields(reader).Layer("ridge", size * (1 + kRidgeDisplacements), size * settings.predicted,
                             &ridge);
  trained.ridge = {ridge.weights, ridge.bias};
  return networks;
}

MaybeError TrainedParticles::Check(const GeneratorChanges& changes) const {
  if (changes.ridge_share.value_or(0.0) <= 0.0 || ridge_share > 0.0) return std::nullopt;
  return Error{"this generator was trained without a ridge; leave out --ridge_share"};
}

std::unique_ptr<MotionGenerator> TrainedParticles::Make(const GeneratorSettings& settings,
                                                        const GeneratorChanges& changes) const {
  ParticleGeneratorOptions options = changes.particles;
  options.jitter = jitter;
  if (settings.data == GeneratorData::kPushes) options.mirrored_controls = kMirroredPush;
  options.ridge_share = ridge_share > 0.0 ? changes.ridge_share.value_or(ridge_share) : 0.0;
  return std::make_unique<ParticleGenerator>(settings.layout, members, ridge, options);
}

nlohmann::ordered_json TrainedDiffusion::Settings() const {
  return {{"members", members.size()}, {"pooling", NameOf(members.front().structure.pooling)}};
}

SharedNetworks ReadDiffusion(const nlohmann::ordered_json& json, const GeneratorSettings& settings,
                             TensorReader* reader) {
  Demand(settings.layout.num_particles() == kBodyJoints, "diffusion needs bodies of 22 joints");
  const auto trained = std::make_shared<TrainedDiffusion>();
  DiffusionStructure structure;
  ParseSetting(json, "pooling", &structure.pooling);
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
