// ident: what learned terms take over, as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "residuals/cost_functions/contact_takeover.h"
#include "residuals/cost_functions/network_takeover.h"

namespace pushid {

nlohmann::ordered_json ToJson(const Takeover& takeover);
nlohmann::ordered_json ToJson(const ContactTakeover& takeover);
// Throw nlohmann::json::exception or std::runtime_error on what is none.
Takeover TakeoverFromJson(const nlohmann::ordered_json& json);
ContactTakeover ContactTakeoverFromJson(const nlohmann::ordered_json& json);

}  // namespace pushid
