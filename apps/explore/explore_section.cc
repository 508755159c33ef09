// apps: sliders and pictures of the explorable person, and what explore.js needs to know.
#include "apps/explore/explore_section.h"

#include <cstddef>
#include <cstring>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/explore/explore.h"
#include "ident/model/model_rollout.h"
#include "ident/prediction/predictive_bands.h"
#ifdef PUSHID_EXPLORE
#include "explore_assets.inc"  // kExploreWasm in base64, kExploreScript
#include "models/rollout.h"
#else
constexpr char kExploreWasm[] = "", kExploreScript[] = "";
#endif

namespace pushid {
namespace {

using Json = nlohmann::json;

constexpr char kHtml[] = R"html(<style>
.exp-sliders{display:grid;grid-template-columns:repeat(auto-fill,minmax(17rem,1fr));gap:.1rem 1.4rem;font-size:.85rem}
.exp-sliders label{display:grid;grid-template-columns:6rem 1fr 8rem;gap:.5rem;align-items:center}
.exp-sliders input{min-width:0}.exp-sliders output{font-variant-numeric:tabular-nums;white-space:nowrap}
.exp-pictures{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(20rem,100%),1fr));gap:.6rem;margin-top:.6rem}
.exp-pictures svg{background:var(--box);border-radius:4px;width:100%;height:300px}
.exp-band{fill:#3b82f6;fill-opacity:.2}.exp-path{stroke:#3b82f6;stroke-width:2}
.exp-pictures polyline.g{stroke:var(--line)}
@media print{.exp-sliders{display:none}}
</style>
<div class="exp-sliders" id="exp-sliders"></div>
<details><summary>held parameters</summary><div class="exp-sliders" id="exp-held"></div></details>
<div class="controls"><button id="exp-play" type="button">play</button>
<button id="exp-reset" type="button">as fitted</button><output id="exp-clock"></output></div>
<div class="exp-pictures">
<svg id="exp-stage" role="img" aria-label="the pushed person from the side"></svg>
<svg id="exp-graph" role="img" aria-label="where the hip is over time, with its band"></svg></div>
<p class="key"><span class="predicted">as the sliders say</span> <span class="body">as fitted</span> <span class="pushed">push</span></p>
<p id="exp-said" aria-live="polite"></p>
<noscript><p>Sliders need JavaScript; everything else on this page does not.</p></noscript>
)html";

// Where a parameter has an effect on who is pushed along x.
bool Moves(const ModelOptions& options, const ParameterSet<double>& parameters, int id) {
  const ParameterFacts& facts = AllParameterFacts()[id];
  ParameterSet<double> other = parameters;
  const double by = facts.transform == Transform::kIdentity ? 0.1 * facts.scale : 0.1;
  other[id] = Shifted(facts.transform, other[id], by);
  for (const double impulse : {-80.0, 30.0, 80.0}) {
    ExploredPush push;
    push.mass = kReferenceMass;
    push.impulse = impulse;
    const Scene scene = SceneOf(push);
    const int frames = static_cast<int>(push.frames);
    RolloutPath<double> paths[2];
    int inside = frames;
    for (int k = 0; k < 2; ++k) {
      const RolloutStatus status = Rollout<double>(scene, options, {k == 0 ? parameters : other},
                                                   InitialVelocities(scene), frames, &paths[k]);
      if (!status.ok) inside = std::min(inside, status.frame);
    }
    for (int t = 0; t < inside; ++t) {
      if (paths[0].At(t, 0).q != paths[1].At(t, 0).q) return true;
    }
  }
  return false;
}

Json Slider(const std::string& name, const std::string& unit, double lower, double upper,
            double value) {
  return {{"name", name},  {"unit", unit}, {"lower", lower}, {"upper", upper}, {"value", value},
          {"meaning", ""}, {"log", false}, {"held", false},  {"input", -1},    {"parameter", -1}};
}

// From a third to three times a positive value; otherwise as far again, or three typical sizes.
Json SliderOf(const ParameterSpec& spec, double value) {
  Json slider = Slider(spec.name, spec.unit, 0.02, 0.98, value);
  if (spec.transform == Transform::kLog) {
    slider["lower"] = std::max(spec.lower, value / 3.0);
    slider["upper"] = std::min(spec.upper, 3.0 * value);
    slider["log"] = true;
  } else if (spec.transform == Transform::kIdentity) {
    const double reach = std::max(std::abs(value), 3.0 * spec.scale);
    slider["lower"] = std::max(spec.lower, value - reach);
    slider["upper"] = std::min(spec.upper, value + reach);
  }
  slider["meaning"] = spec.meaning;
  slider["held"] = !spec.free;
  slider["parameter"] = static_cast<int>(spec.id);
  return slider;
}

ExploredPush PushOf(const FittedModel& model) {
  const ModelOptions& options = model.fit.options.model;
  ExploredPush push;
  for (const auto& [name, subject] : model.fit.subjects) push.mass += subject.mass_kg;
  push.mass = model.fit.subjects.empty()
                  ? kReferenceMass
                  : push.mass / static_cast<double>(model.fit.subjects.size());
  ForEachChoice(options, push,
                [](auto choice, double& number) { number = static_cast<double>(choice); });
  push.others = options.interaction.Any() ? 1.0 : 0.0;
  return push;
}

Json Sliders(const FittedModel& model, const ExploredPush& push,
             const ParameterSet<double>& values) {
  constexpr int kDouble = sizeof(double);
  Json impulse = Slider("push", "N s", -150.0, 150.0, push.impulse);
  impulse["input"] = offsetof(ExploredPush, impulse) / kDouble;
  Json mass = Slider("mass", "kg", 30.0, 150.0, push.mass);
  mass["input"] = offsetof(ExploredPush, mass) / kDouble;
  Json rod = Slider("hip height", "m", 0.5, 1.2, push.rod);
  rod["input"] = offsetof(ExploredPush, rod) / kDouble;
  rod["meaning"] = "of the hip above the ankles: the rod";
  Json sliders = {impulse, mass, rod};
  for (const ParameterSpec& spec : model.fit.options.table.specs) {
    if (spec.id >= kFirstOwnParameter || !Acts(spec.id, model.fit.options.model)) continue;
    if (!Moves(model.fit.options.model, values, spec.id)) continue;
    sliders.push_back(SliderOf(spec, values[spec.id]));
  }
  return sliders;
}

// Which parameters differ among the draws about the estimate, and their values.
void AddDraws(const FitResult& fit, Json* data) {
  BandOptions options;
  options.samples = kMostDraws;
  std::vector<ParameterSet<double>> draws;
  if (const auto drawn = SampleParameters(fit, options); drawn.ok()) draws = drawn.value();
  std::vector<int> differ;
  for (int i = 0; i < kFirstOwnParameter; ++i) {
    bool any = false;
    for (const ParameterSet<double>& draw : draws) any = any || draw[i] != fit.parameters[i];
    if (any) differ.push_back(i);
  }
  (*data)["drawn"] = differ;
  (*data)["draws"] = Json::array();
  for (const ParameterSet<double>& draw : draws) {
    Json row = Json::array();
    for (const int i : differ) row.push_back(draw[i]);
    (*data)["draws"].push_back(row);
  }
}

// As pushid-formation has who is no subject of the fit.
ParameterSet<double> ValuesOf(const FitResult& fit, const ExploredPush& push) {
  IdentifiedModel model = ModelOf(fit);
  model.by_unit.clear();
  PendulumRecording recording;
  recording.scene = SceneOf(push);
  recording.subject_ids = {"explored"};
  return PeoplesParameters(model, recording).front();
}

}  // namespace

ReportSection ExploreSection(const FittedModel& model) {
  const ModelOptions& options = model.fit.options.model;
  ReportSection section;
  if (kExploreWasm[0] == '\0' || options.learned != nullptr || !options.own_laws.empty()) {
    return section;
  }
  section.id = "explore";
  section.title = "Try it";
  section.paragraphs = {
      "One person of this model, pushed at the hip for 0.2 s from upright stance, without anybody "
      "near. The band holds 90 % of what the uncertainty of the parameters allows, moved along "
      "with the sliders; people and pushes differ by more."};
  const ExploredPush push = PushOf(model);
  const ParameterSet<double> values = ValuesOf(model.fit, push);
  std::vector<double> inputs(sizeof push / sizeof(double));
  std::memcpy(inputs.data(), &push, sizeof push);
  Json data = {{"dt", push.dt},
               {"frames", push.frames},
               {"inputs", inputs},
               {"draws_at", offsetof(ExploredPush, draws) / sizeof(double)},
               {"values", values},
               {"estimate", model.fit.parameters},
               {"sliders", Sliders(model, push, values)}};
  AddDraws(model.fit, &data);
  section.widget = kHtml + ("<script type=\"application/json\" id=\"exp-data\">" + data.dump()) +
                   "</script>\n<script type=\"text/plain\" id=\"exp-wasm\">" + kExploreWasm +
                   "</script>\n<script>" + kExploreScript + "</script>\n";
  return section;
}

}  // namespace pushid
