// ident: what the files of each kind of generator hold beside the settings of all, and how one is
// made of them. Of generator_files.cc alone.
//
// The readers throw nlohmann's exceptions, and Error's text where something does not fit.
#pragma once

#include <stdexcept>

#include "ident/generators/generator_files.h"
#include "ident/parameters/option_names.h"
#include "models/restoration/tensors.h"

namespace pushid {

inline void Demand(bool holds, const std::string& what) {
  if (!holds) throw std::runtime_error(what);
}
template <typename Value>
void ParseSetting(const nlohmann::ordered_json& json, const char* key, Value* value) {
  const MaybeError error = ParseName(key, json.at(key).get<std::string>(), value);
  if (error) throw std::runtime_error(error->message);
}
// How many networks a file has; their tensors are called MemberName(0), ...
int ReadMembers(const nlohmann::ordered_json& json);
inline std::string MemberName(size_t member) { return "member" + std::to_string(member); }

nlohmann::ordered_json KindJson(const TrainedParticles& trained);
nlohmann::ordered_json KindJson(const TrainedDiffusion& trained);

void AddTensors(const TrainedParticles& trained, TensorList* tensors);
void AddTensors(const TrainedDiffusion& trained, TensorList* tensors);

TrainedParticles ReadParticles(const nlohmann::ordered_json& json,
                               const GeneratorSettings& settings, TensorReader* reader);
TrainedDiffusion ReadDiffusion(const nlohmann::ordered_json& json,
                               const GeneratorSettings& settings, TensorReader* reader);

std::unique_ptr<MotionGenerator> MakeOfKind(const GeneratorSettings& settings,
                                            const TrainedParticles& trained,
                                            const GeneratorChanges& changes);
std::unique_ptr<MotionGenerator> MakeOfKind(const GeneratorSettings& settings,
                                            const TrainedDiffusion& trained,
                                            const GeneratorChanges& changes);

}  // namespace pushid
