// ident: refits side by side as JSON, without loss.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "ident/uncertainty/refit_table.h"

namespace pushid {

nlohmann::ordered_json ToJson(const RefitTable& table);

// Throws std::exception on damaged input, as the parts of a reader do.
RefitTable RefitTableFromJson(const nlohmann::ordered_json& json);

}  // namespace pushid
