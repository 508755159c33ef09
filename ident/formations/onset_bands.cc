// ident: onsets under drawn parameters.
#include "ident/formations/onset_bands.h"

#include "ident/prediction/predictive_bands.h"
#include "ident/prediction/propagation.h"

namespace pushid {
namespace {

constexpr int kDraws = 60;
constexpr double kLower = 0.05, kUpper = 0.95;

}  // namespace

std::vector<OnsetBand> OnsetBands(const FittedModel& model, const std::string& set,
                                  const FormationRun& run) {
  const bool replicas = model.bootstrap && !model.bootstrap->values.empty();
  if (!replicas && model.fit.uncertainty.covariance.size() == 0) return {};
  BandOptions options;
  options.samples = kDraws;
  if (replicas) options.bootstrap = &*model.bootstrap;
  const auto draws = SampleParameters(model.fit, options);
  if (!draws.ok()) return {};
  IdentifiedModel drawn = ModelOf(model.fit);
  drawn.by_unit.clear();  // no person of a formation is one of the fit
  std::vector<std::vector<double>> onsets(run.num_people());
  int done = 0;
  for (const ParameterSet<double>& draw : draws.value()) {
    drawn.parameters = draw;
    if (SetValues(set, &drawn)) return {};
    const Prediction prediction = Predict(drawn, run.recording, run.num_frames());
    if (!prediction.status.ok) continue;  // this draw's person falls out of the model's domain
    ++done;
    for (int n = 0; n < run.num_people(); ++n) {
      const int onset = OnsetFrame(prediction.hip[n]);
      if (onset >= 0) onsets[n].push_back(run.Seconds(onset));
    }
  }
  if (done == 0) return {};
  std::vector<OnsetBand> bands(run.num_people());
  for (int n = 0; n < run.num_people(); ++n) {
    if (onsets[n].empty()) continue;
    bands[n] = {Quantile(onsets[n], kLower), Quantile(onsets[n], kUpper),
                static_cast<double>(onsets[n].size()) / done};
  }
  return bands;
}

}  // namespace pushid
