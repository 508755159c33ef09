// ident: the parameters of a fit, and the presets.
#include "ident/parameters/parameter_table.h"

#include <algorithm>
#include <cmath>

#include "models/parameter_facts.h"

namespace pushid {
namespace {

// Every parameter fixed, at its row's value.
ParameterTable BaseTable() {
  ParameterTable table;
  for (const ParameterFacts& facts : AllParameterFacts()) table.Add(facts);
  return table;
}

Preset TailPreset() {
  Preset preset;
  preset.name = "tail";
  preset.table = BaseTable();
  ParameterTable& table = preset.table;
  struct Start {
    Parameter id;
    double value;
  };
  // Round numbers, not fitted ones. Each is the centre of a weak prior as wide as itself: stiffness
  // and cross term slide along a ridge that fits no better and predicts unseen pushes worse (hipADE
  // 0.112 against 0.096 m in cross-validation); the prior's exact centre hardly matters.
  for (const Start& start :
       {Start{kMu, 40}, Start{kKpTheta, 1400}, Start{kAx, -10}, Start{kTailGain, 1},
        Start{kTailTorque, 0.5}, Start{kTailTime, 0.2}, Start{kTailExponent, 1.5}}) {
    table[start.id].free = true;
    table[start.id].nominal = start.value;
    table[start.id].prior = Prior{start.value, std::abs(start.value)};
  }
  preset.settling_weight = 10.0;
  return preset;
}

Preset GroupPreset() {
  Preset preset = TailPreset();
  preset.name = "group";
  preset.model.interaction.spring = preset.model.interaction.damping = true;
  preset.self_force = SelfForceKind::kLinear;
  preset.settling_weight = 20.0;
  preset.pool = "all";
  preset.pool_by = PoolBy::kSetting;
  preset.pooling_sigma = 0.3;
  // Going on to 1e-10 takes twice as long and moves no parameter by more than 4 % of its standard
  // error; only the contact distance moves by a third of it, 0.3 mm.
  preset.function_tolerance = 1e-6;
  return preset;
}

Preset LdpPreset() {
  Preset preset;
  preset.name = "ldp";
  preset.table = BaseTable();
  ParameterTable& table = preset.table;
  table[kKpX].nominal = table[kKpY].nominal = 30;
  // LDP's 200 per frame at 60 Hz.
  table[kKdTheta].nominal = table[kKdPhi].nominal = 200.0 / 60.0;
  for (Parameter id : {kMu, kMuY, kKpTheta, kKpPhi, kKdTheta, kKdPhi}) table[id].free = true;
  preset.model.posture = Posture::kUpright;
  preset.model.gain_scaling = GainScaling::kMass;
  preset.model.friction = FrictionKind::kAnisotropic;
  preset.model.push = PushUse::kAsRecorded;
  preset.model.push_tail = PushTail::kNone;
  return preset;
}

}  // namespace

ParameterSpec& ParameterTable::Add(const ParameterFacts& facts) {
  ParameterSpec spec;
  spec.id = static_cast<Parameter>(specs.size());
  spec.name = facts.name;
  spec.unit = facts.unit;
  spec.nominal = facts.nominal;
  spec.lower = facts.lower;
  spec.upper = facts.upper;
  spec.scale = facts.scale;
  spec.transform = facts.transform;
  spec.meaning = facts.meaning;
  specs.push_back(std::move(spec));
  return specs.back();
}

const ParameterSpec* ParameterTable::Find(const std::string& name) const {
  for (const ParameterSpec& spec : specs) {
    if (spec.name == name) return &spec;
  }
  return nullptr;
}

ParameterSpec* ParameterTable::Find(const std::string& name) {
  return const_cast<ParameterSpec*>(static_cast<const ParameterTable*>(this)->Find(name));
}

std::vector<Parameter> ParameterTable::Free() const {
  std::vector<Parameter> free;
  for (const ParameterSpec& spec : specs) {
    if (spec.free) free.push_back(spec.id);
  }
  return free;
}

ParameterSet<double> ParameterTable::Values() const {
  ParameterSet<double> values{};
  for (const ParameterSpec& spec : specs) values[spec.id] = spec.nominal;
  return values;
}

ParameterMap ParameterTable::Map() const {
  ParameterMap map;
  map.values = Values();
  for (Parameter id : Free()) {
    const int deviation = specs[id].pooled ? map.num_deviations++ : -1;
    map.fitted.push_back({id, specs[id].transform, deviation});
  }
  return map;
}

Result<Preset> MakePreset(const std::string& name) {
  if (name == "tail") return TailPreset();
  if (name == "ldp") return LdpPreset();
  if (name == "group") return GroupPreset();
  return Error{"--preset is '" + name + "'; it must be tail, ldp or group"};
}

bool AnyPooled(const ParameterTable& table) {
  return std::any_of(table.specs.begin(), table.specs.end(),
                     [](const ParameterSpec& spec) { return spec.free && spec.pooled; });
}

void FreeSelfForce(SelfForceKind kind, ParameterTable* table) {
  if (kind != SelfForceKind::kLinear) return;
  for (int id = kAx; id <= kDq; ++id) {
    ParameterSpec& spec = table->specs[id];
    spec.free = true;
    // As weak as the preset's own priors: without them these terms drive the person instead.
    if (!spec.prior) spec.prior = Prior{spec.nominal, spec.scale};
  }
}

void FreeRod(const ModelOptions& model, ParameterTable* table) {
  if (!FreedByItsTerm(kRodLift, model)) return;
  ParameterSpec& spec = (*table)[kRodLift];
  spec.free = true;
  if (!spec.prior) spec.prior = Prior{spec.nominal, spec.nominal};
}

void FreeInteraction(const InteractionTerms& terms, ParameterTable* table) {
  ModelOptions model;
  model.interaction = terms;
  for (ParameterSpec& spec : table->specs) {
    if (!FreedByItsTerm(spec.id, model)) continue;
    spec.free = true;
    spec.prior = Prior{spec.nominal, std::abs(spec.nominal)};
  }
}

}  // namespace pushid
