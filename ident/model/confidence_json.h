// ident: profiles, bootstrap, diagnostics and advice as JSON, without loss.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "ident/diagnostics/diagnostics.h"
#include "ident/uncertainty/bootstrap.h"
#include "ident/uncertainty/profile.h"

namespace pushid {

nlohmann::ordered_json ToJson(const std::vector<Profile>& profiles);
nlohmann::ordered_json ToJson(const Bootstrap& bootstrap);
nlohmann::ordered_json ToJson(const Diagnostics& diagnostics);
nlohmann::ordered_json AdviceJson(const std::vector<Advice>& advice);

// These throw std::exception on damaged input, as the parts of a reader do.
std::vector<Profile> ProfilesFromJson(const nlohmann::ordered_json& json);
Bootstrap BootstrapFromJson(const nlohmann::ordered_json& json);
Diagnostics DiagnosticsFromJson(const nlohmann::ordered_json& json);
std::vector<Advice> AdviceFrom(const nlohmann::ordered_json& json);

}  // namespace pushid
