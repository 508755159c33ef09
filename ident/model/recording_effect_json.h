// ident: the effect of recordings in a model's file.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "ident/fit/recording_effect.h"

namespace pushid {

nlohmann::ordered_json ToJson(const RecordingEffect& effect);
// Throws what nlohmann's JSON throws, and std::runtime_error for what cannot be.
RecordingEffect RecordingEffectFromJson(const nlohmann::ordered_json& json);

}  // namespace pushid
