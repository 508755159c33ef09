// apps: one forecast as pictures and files.
#pragma once

#include "apps/flags/generate_flags.h"
#include "ident/forecasts/forecast_scene.h"

namespace pushid {

// What --poses_out, --strip_out and --page_out ask for; their names go to stdout.
MaybeError ShowForecast(const ForecastScene& scene, const GenerateFlags& flags);

}  // namespace pushid
