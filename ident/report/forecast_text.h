// ident: how well hips are forecast that were seen to begin, in words and tables.
#pragma once

#include <string>

#include "ident/figures/text_table.h"
#include "ident/model/identified_model.h"

namespace pushid {

std::string ForecastSentence(const ForecastStack& forecasts);
// A row for each time that was seen.
TextTable ForecastTable(const ForecastStack& forecasts);
std::string ForecastText(const ForecastStack& forecasts);

}  // namespace pushid
