// ident: rows of the options that edit the table of parameters.
#include <nlohmann/json.hpp>

#include "ident/parameters/option_row_makers.h"

namespace pushid {
namespace {

FitOptionRow EditRow(const char* name, std::string TableEdits::*list, const char* help) {
  return WordsRow(name, OptionStage::kTable, help, [list](const std::string& text, FitOptions* o) {
    TableEdits edits;
    edits.*list = text;
    return EditTable(edits, &o->table);
  });
}

}  // namespace

// Which parameters are fitted.
std::vector<FitOptionRow> TableOptionRows() {
  return {
      ContrastRow(),
      CovariateRow(),
      WordsRow("self_from", OptionStage::kOtherModel,
               "a model whose self parameters (all but those between people) are used and held "
               "fixed, such as a model of single people",
               nullptr),
      EditRow("free", &TableEdits::free, "parameters fitted: name or name=start, comma-separated"),
      EditRow("fix", &TableEdits::fix,
              "parameters held fixed: name or name=value, comma-separated"),
      EditRow("prior", &TableEdits::prior,
              "priors: name:mean:sigma in the parameter's unit, comma-separated"),
      Decided(WordsRow("pool", OptionStage::kModel,
                       "parameters that may differ by unit, comma-separated, or all, or none; "
                       "all,-mu: all but mu",
                       [](const std::string& text, FitOptions* o) -> MaybeError {
                         o->pool = text;
                         return std::nullopt;
                       })),
  };
}

}  // namespace pushid
