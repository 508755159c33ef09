// ident: the speed of a wave from its onsets.
#include "ident/formations/wave_speed.h"

#include <algorithm>

#include "datasets/files/number_text.h"
#include "ident/prediction/predictive_bands.h"
#include "ident/prediction/propagation.h"
#include "models/self_terms.h"

namespace pushid {

std::optional<WaveSpeed> SpeedOfWave(const Scene& scene, const std::vector<int>& onsets) {
  if (scene.pushes.size() != 1) return std::nullopt;
  int first = -1, foremost = -1;
  for (int n = 0; n < scene.num_people(); ++n) {
    if (onsets[n] < 0) continue;
    if (first < 0 || onsets[n] < onsets[first]) first = n;
    foremost = n;
  }
  if (first < 0) return std::nullopt;
  const WaveSpeed wave{first, foremost,
                       scene.people[foremost].start.q[0] - scene.people[first].start.q[0],
                       (onsets[foremost] - onsets[first]) * scene.dt};
  if (!(wave.metres > 0.0) || !(wave.seconds > 0.0)) return std::nullopt;
  return wave;
}

std::optional<WaveSpeed> SpeedOfWave(const FormationRun& run) {
  std::vector<int> onsets;
  for (const PersonSummary& person : run.summaries) onsets.push_back(person.onset_frame);
  return SpeedOfWave(run.recording.scene, onsets);
}

namespace {

constexpr int kDraws = 60;
constexpr double kLower = 0.05, kUpper = 0.95;

// One for each draw: the onset frame of everybody, or nobody where the rollout left the model's
// domain.
std::vector<std::vector<int>> DrawnOnsets(const FittedModel& model, const std::string& set,
                                          const FormationRun& run) {
  const bool replicas = model.bootstrap && !model.bootstrap->values.empty();
  if (!replicas && model.fit.uncertainty.covariance.size() == 0) return {};
  BandOptions options;
  options.samples = kDraws;
  if (replicas) options.bootstrap = &*model.bootstrap;
  const auto draws = SampleParameters(model.fit, options);
  if (!draws.ok()) return {};
  IdentifiedModel fitted = ModelOf(model.fit);
  fitted.by_unit.clear();  // no person of a formation is one of the fit
  std::vector<std::vector<int>> onsets;
  for (const ParameterSet<double>& draw : draws.value()) {
    IdentifiedModel drawn = WithShared(fitted, draw);
    if (SetValues(set, &drawn)) return {};
    const Prediction prediction = Predict(drawn, run.recording, run.num_frames());
    onsets.emplace_back();
    if (!prediction.status.ok) continue;
    for (const auto& hip : prediction.hip) onsets.back().push_back(OnsetFrame(hip));
  }
  return onsets;
}

OnsetBand BandOf(const std::vector<std::vector<int>>& draws, int person, double dt) {
  std::vector<double> seconds;
  for (const std::vector<int>& onsets : draws) {
    if (!onsets.empty() && onsets[person] >= 0) seconds.push_back(onsets[person] * dt);
  }
  if (seconds.empty()) return {};
  return {Quantile(seconds, kLower), Quantile(seconds, kUpper),
          static_cast<double>(seconds.size()) / static_cast<double>(draws.size())};
}

SpeedBand BandOfSpeed(const std::vector<std::vector<int>>& draws, const Scene& scene) {
  std::vector<double> speeds;
  for (const std::vector<int>& onsets : draws) {
    if (onsets.empty()) continue;
    if (const auto wave = SpeedOfWave(scene, onsets)) speeds.push_back(wave->MetresPerSecond());
  }
  SpeedBand band{0.0, 0.0, static_cast<int>(speeds.size()), static_cast<int>(draws.size())};
  if (band.known()) band.from = Quantile(speeds, kLower), band.to = Quantile(speeds, kUpper);
  return band;
}

}  // namespace

std::string HeldInDraws(const FittedModel& model, const std::string& set) {
  std::string held;
  const auto add = [&held](const std::string& text) { held += (held.empty() ? "" : ", ") + text; };
  const Result<std::vector<NamedValue>> values = ParseAssignments(set, "--set");
  const std::vector<NamedValue> replaced = values.ok() ? values.value() : std::vector<NamedValue>();
  for (const Estimate& e : model.fit.estimates) {
    const ParameterSpec* spec = model.fit.options.table.Find(e.name);
    const bool again = std::any_of(replaced.begin(), replaced.end(),
                                   [&e](const NamedValue& one) { return one.name == e.name; });
    const bool convention = spec != nullptr && HeldByConvention(spec->id);
    if (e.status != EstimateStatus::kFixed || again || convention) continue;
    add(e.name + " = " + Rounded(e.value, 4));
  }
  for (const NamedValue& one : replaced) add(one.name + " = " + Rounded(one.value, 4) + " (--set)");
  return held;
}

WaveBands BandsOfWave(const FittedModel& model, const std::string& set, const FormationRun& run) {
  const std::vector<std::vector<int>> draws = DrawnOnsets(model, set, run);
  WaveBands bands;
  if (draws.empty()) return bands;
  bands.failed = static_cast<int>(std::count_if(
      draws.begin(), draws.end(), [](const std::vector<int>& onsets) { return onsets.empty(); }));
  const Scene& scene = run.recording.scene;
  for (int n = 0; n < run.num_people(); ++n) bands.onsets.push_back(BandOf(draws, n, scene.dt));
  bands.speed = BandOfSpeed(draws, scene);
  return bands;
}

}  // namespace pushid
