// ident: forecasts from first frames, in words.
#include "ident/report/forecast_text.h"

#include <cmath>

#include "datasets/files/number_text.h"

namespace pushid {

std::string ForecastSentence(const ForecastStack& f) {
  const std::string judged =
      f.folds > 0
          ? "by models fitted without them, in " + std::to_string(f.folds) +
                " folds, with weights learned on the other folds"
          : "by the model that was fitted to them: too few people or recordings to leave some out, "
            "so the weights are not learned, and new ones will err more";
  return "After first frames (--observed) forecasts are put together with weights that depend on "
         "the time seen and the time ahead. Forecasts of " +
         std::to_string(f.recordings) + " recordings " + judged +
         ". The unknown force of the filter that forecasts dies out in " +
         Rounded(f.noise.force_time, 2) + " s; its tail is " + Rounded(f.tail_strength, 2) +
         " times as strong and " + Rounded(f.tail_time, 2) +
         " times as long as the model's. Single steps of the model itself are likeliest with an "
         "unknown force of " +
         Rounded(f.likeliest.force, 2) +
         " m/s^2 (standard deviation over the mass) that dies out in " +
         Rounded(f.likeliest.force_time, 2) + " s.";
}

TextTable ForecastTable(const ForecastStack& f) {
  std::vector<std::string> header = {"seen, s", "recordings", "together"};
  for (int c = 0; c < kNumForecasters; ++c) {
    header.push_back(std::string(NameOf(static_cast<Forecaster>(c))));
  }
  TextTable table = TextTable::OfNumbers(header);
  for (const ForecasterErrors& row : f.scores) {
    std::vector<std::string> cells = {Rounded(row.seconds, 2), std::to_string(row.recordings),
                                      Rounded(row.stack, 3)};
    for (double mean : row.mean) cells.push_back(std::isnan(mean) ? "-" : Rounded(mean, 3));
    table.Add(cells);
  }
  return table;
}

std::string ForecastText(const ForecastStack& f) {
  return ForecastSentence(f) + "\nmean distance of the hip from the forecast, m\n" +
         ForecastTable(f).ToString();
}

}  // namespace pushid
