// ident: generators of diffusion, to and from settings and tensors.
#include <nlohmann/json.hpp>

#include "datasets/files/random.h"
#include "ident/generators/generator_files.h"
#include "ident/generators/trained_networks.h"

namespace pushid {

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
