// ident: generators by kind, to and from settings and tensors.
#include "ident/generators/generator_kinds.h"

#include <memory>
#include <nlohmann/json.hpp>

#include "datasets/files/random.h"
#include "ident/generators/push_particles.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;
constexpr int kMostMembers = 100, kMostControls = 1000, kMostCorrected = 100000;

}  // namespace

int ReadMembers(const Json& json) {
  const int members = json.at("members");
  Demand(members >= 1 && members <= kMostMembers, "members must be 1 to 100");
  return members;
}

Json KindJson(const TrainedParticles& trained) {
  const ParticleStructure& structure = trained.members.front().structure;
  return {{"members", trained.members.size()},
          {"cell", NameOf(structure.cell)},
          {"skip", structure.skip},
          {"pose_operator", structure.pose_operator},
          {"particles", structure.particles},
          {"controls", structure.controls},
          {"correlated_noise", structure.correlated_noise},
          {"corrected_frames", structure.corrected_frames},
          {"jitter", trained.jitter},
          {"ridge_share", trained.ridge_share}};
}

Json KindJson(const TrainedDiffusion& trained) {
  const DiffusionStructure& structure = trained.members.front().structure;
  return {{"members", trained.members.size()}, {"pooling", NameOf(structure.pooling)}};
}

void AddTensors(const TrainedParticles& trained, TensorList* tensors) {
  for (size_t m = 0; m < trained.members.size(); ++m) {
    AddTensors(MemberName(m), trained.members[m], tensors);
  }
  if (trained.ridge_share <= 0.0) return;
  AddTensors("ridge", DenseLayer{trained.ridge.weights, trained.ridge.bias}, tensors);
}

void AddTensors(const TrainedDiffusion& trained, TensorList* tensors) {
  for (size_t m = 0; m < trained.members.size(); ++m) {
    AddTensors(MemberName(m), trained.members[m], tensors);
  }
}

TrainedParticles ReadParticles(const Json& json, const GeneratorSettings& settings,
                               TensorReader* reader) {
  TrainedParticles trained;
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
  if (trained.ridge_share <= 0.0) return trained;
  Demand(settings.observed > kRidgeDisplacements, "the ridge needs more observed frames");
  const DenseLayer ridge =
      TakeLayer("ridge", size * (1 + kRidgeDisplacements), size * settings.predicted, reader);
  trained.ridge = {ridge.weights, ridge.bias};
  return trained;
}

TrainedDiffusion ReadDiffusion(const Json& json, const GeneratorSettings& settings,
                               TensorReader* reader) {
  Demand(settings.layout.num_particles() == kBodyJoints, "diffusion needs bodies of 22 joints");
  TrainedDiffusion trained;
  DiffusionStructure structure;
  ParseSetting(json, "pooling", &structure.pooling);
  structure.pendulum = settings.pendulum;
  const int members = ReadMembers(json);
  for (int m = 0; m < members; ++m) {
    trained.members.push_back(TakeDiffusion(MemberName(m), structure, reader));
  }
  return trained;
}

std::unique_ptr<MotionGenerator> MakeOfKind(const GeneratorSettings& settings,
                                            const TrainedParticles& trained,
                                            const GeneratorChanges& changes) {
  ParticleGeneratorOptions options;
  options.project_bones = changes.project_bones;
  options.jitter = trained.jitter;
  options.noise_memory = changes.noise_memory;
  options.noise_scale = changes.noise_scale;
  options.correlated_noise = changes.correlated_noise;
  options.mirror = changes.mirror;
  if (settings.data == GeneratorData::kPushes) options.mirrored_controls = kMirroredPush;
  options.ridge_share =
      trained.ridge_share > 0.0 ? changes.ridge_share.value_or(trained.ridge_share) : 0.0;
  return std::make_unique<ParticleGenerator>(settings.layout, trained.members, trained.ridge,
                                             options);
}

std::unique_ptr<MotionGenerator> MakeOfKind(const GeneratorSettings& settings,
                                            const TrainedDiffusion& trained,
                                            const GeneratorChanges& changes) {
  const auto noise = [seed = changes.seed] {
    const auto random = std::make_shared<Random>(seed);
    return NormalSource([random] { return random->Normal(); });
  };
  DiffusionGeneratorOptions options = changes.diffusion;
  options.learnt_frames = settings.observed + settings.predicted;
  return std::make_unique<DiffusionGenerator>(settings.layout, trained.members, 1.0 / settings.rate,
                                              options, noise);
}

}  // namespace pushid
