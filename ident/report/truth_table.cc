// ident: reading the truth and setting it beside the estimates.
#include "ident/report/truth_table.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/files/json_file.h"
#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"

namespace pushid {
namespace {

constexpr double kFileRounding = 1e-6;  // of a parameter

bool IsFormation(const nlohmann::ordered_json& manifest) {
  return manifest.is_object() && manifest.contains("synthetic") &&
         manifest["synthetic"].is_object() && manifest["synthetic"].contains("formation");
}

}  // namespace

Result<std::map<std::string, double>> ReadTruth(const std::string& manifest_path) {
  const Result<JsonDocument> document = ReadJsonDocument(manifest_path);
  if (!document.ok()) return document.error();
  try {
    return document.value()
        .content.at("synthetic")
        .at("truth")
        .get<std::map<std::string, double>>();
  } catch (const nlohmann::json::exception&) {
    if (IsFormation(document.value().content)) {
      return Error{
          "a formation of pushid-simulate --formation: its truth is the model it was rolled out "
          "with; compare with that model's own report",
          manifest_path};
    }
    return Error{"no `synthetic.truth`: only recordings of pushid-simulate have a known truth",
                 manifest_path};
  }
}

std::string TruthTable(const FitResult& result, const std::map<std::string, double>& truth) {
  TextTable table({"parameter", "truth", "fitted", "std error", "95 % interval", "unit", ""},
                  {true, false, false, false, true, true, true});
  int covered = 0, compared = 0;
  for (const Estimate& e : result.estimates) {
    const auto known = truth.find(e.name);
    if (e.status == EstimateStatus::kFixed || known == truth.end()) continue;
    // Without noise the interval shrinks below what the files' decimals can hold.
    const double slack = kFileRounding * std::abs(known->second);
    const bool inside = e.lower95 - slack <= known->second && known->second <= e.upper95 + slack;
    ++compared;
    covered += inside;
    table.Add({e.name, Rounded(known->second, 4), Rounded(e.value, 4), Rounded(e.standard_error, 3),
               "[" + Rounded(e.lower95, 4) + ", " + Rounded(e.upper95, 4) + "]", e.unit,
               inside ? "covers" : "misses"});
  }
  return table.ToString() + std::to_string(covered) + " of " + std::to_string(compared) +
         " intervals cover the truth (on average one in 20 does not)\n";
}

}  // namespace pushid
