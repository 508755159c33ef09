// ident: forecasts compared.
#include "ident/training/best_forecast.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "datasets/files/number_text.h"
#include "ident/bodies/body_report.h"
#include "ident/figures/text_table.h"

namespace pushid {

Result<std::vector<ForecastCandidate>> CompareForecasts(
    const std::vector<BodyRecording>& recordings, const BestForecastOptions& options,
    const RunProgress& progress) {
  GeneratorValidationOptions of_generator = options.validation;
  of_generator.physics = options.chain.fit;
  const auto generator =
      CrossValidateGenerator(recordings, options.generator, of_generator, progress);
  if (!generator.ok()) return generator.error();
  const auto chain = CrossValidateChain(recordings, options.chain, of_generator.scheme,
                                        of_generator.folds, progress);
  if (!chain.ok()) return chain.error();
  const BodyEvaluation& scores = generator.value().evaluation;
  std::vector<ForecastCandidate> candidates = {{"diffusion", {}, scores.at("generator")},
                                               {"physics, restored bodies",
                                                {ForecastBy::kRestoration, 0.0},
                                                chain.value().evaluation.at("restoration")}};
  for (const double blend : of_generator.blends) {
    candidates.push_back({"diffusion, blended " + Rounded(blend, 3) + " with physics",
                          {ForecastBy::kGenerator, blend},
                          scores.at(BlendName(blend))});
  }
  std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    return a.summary.mean.value[kMpjpe] < b.summary.mean.value[kMpjpe];
  });
  return candidates;
}

std::string CandidatesText(const std::vector<ForecastCandidate>& candidates) {
  TextTable table({"held out", "MPJPE m", "+-", "hipADE m", "hipFDE m", "FSE cm"},
                  {true, false, false, false, false, false});
  for (const ForecastCandidate& candidate : candidates) {
    const BodyMean& mean = candidate.summary.mean;
    table.Add({candidate.name, Rounded(mean.value[kMpjpe], 3), Rounded(mean.error[kMpjpe], 2),
               Rounded(mean.value[kHipAde], 3), Rounded(mean.value[kHipFde], 3),
               Rounded(mean.value[kFse], 2)});
  }
  return table.ToString() + "chosen: " + candidates.front().name + "\n";
}

nlohmann::ordered_json ToJson(const std::vector<ForecastCandidate>& candidates) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const ForecastCandidate& candidate : candidates) {
    rows.push_back({{"name", candidate.name},
                    {"by", NameOf(candidate.choice.by)},
                    {"blend", candidate.choice.blend},
                    {"mean", MeanJson(candidate.summary.mean)}});
  }
  return rows;
}

}  // namespace pushid
