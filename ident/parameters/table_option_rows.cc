// ident: rows of the options that edit the table of parameters.
#include <nlohmann/json.hpp>

#include "ident/parameters/option_names.h"
#include "ident/parameters/option_row_makers.h"

namespace pushid {
namespace {

using Row = FitOptionRow;
using Json = nlohmann::ordered_json;

Row ContrastRow() {
  Row row = WordsRow(
      "contrast", OptionStage::kTable,
      "a label with two values (patients and controls, eyes open and closed, before and after), of "
      "a recording or of a person in the manifest's subjects: the difference of every free "
      "parameter between them is fitted",
      [](const std::string& text, FitOptions* o) -> MaybeError {
        o->contrast = text;
        return std::nullopt;
      });
  row.text = [](const FitOptions& o) { return o.contrast; };
  row.json = "/contrast";
  row.write = [](const FitOptions& o) { return Json(o.contrast); };
  row.read = [](const Json& json, FitOptions* o) { o->contrast = json.get<std::string>(); };
  return MayBeAbsent(row);
}

Row CovariateRow() {
  Row row = WordsRow(
      "covariate", OptionStage::kTable,
      "numbers of people that parameters follow, as in 'Kp_theta ~ age + height; Kd_theta ~ age': "
      "keys of the manifest's subjects, mass (kg) or rod (m)",
      [](const std::string& text, FitOptions* o) -> MaybeError {
        const Result<std::vector<CovariatesOfParameter>> chosen = ParseCovariates(text);
        if (!chosen.ok()) return chosen.error();
        o->covariates = text;
        return std::nullopt;
      });
  row.text = [](const FitOptions& o) { return o.covariates; };
  row.json = "/covariate";
  row.write = [](const FitOptions& o) { return Json(o.covariates); };
  row.read = [](const Json& json, FitOptions* o) { o->covariates = json.get<std::string>(); };
  return MayBeAbsent(row);
}

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
