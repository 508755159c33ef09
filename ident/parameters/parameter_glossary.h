// ident: every parameter in words, from its row (models/model_rows.h).
#pragma once

#include <string>

#include "ident/figures/text_table.h"

namespace pushid {

// Name, symbol (in the equation that heads the file of its term), unit, value where no preset sets
// one, bounds, meaning, and when to free it; a row each.
TextTable ParameterGlossary();

// The same as a table in Markdown.
std::string ParameterGlossaryMarkdown();

}  // namespace pushid
