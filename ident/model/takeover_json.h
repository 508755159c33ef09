// ident: what learned terms take over, as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "residuals/takeover.h"

namespace pushid {

nlohmann::ordered_json ToJson(const Takeover& takeover);
nlohmann::ordered_json ToJson(const ContactTakeover& takeover);
// Throw nlohmann::json::exception or std::runtime_error on what is none.
Takeover TakeoverFromJson(const nlohmann::ordered_json& json);
ContactTakeover ContactTakeoverFromJson(const nlohmann::ordered_json& json);

}  // namespace pushid
