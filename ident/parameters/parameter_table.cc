// ident: the parameters of a fit.
#include "ident/parameters/parameter_table.h"

#include <algorithm>
#include <cmath>

#include "models/parameters.h"

namespace pushid {

ParameterTable BaseTable() {
  ParameterTable table;
  for (const ParameterFacts& facts : AllParameterFacts()) table.Add(facts);
  return table;
}

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

double PoolingSigma(const ParameterSpec& spec) {
  return spec.pooling_sigma * (spec.transform == Transform::kIdentity ? spec.scale : 1.0);
}

bool AnyPooled(const ParameterTable& table) {
  return std::any_of(table.specs.begin(), table.specs.end(),
                     [](const ParameterSpec& spec) { return spec.free && spec.pooled; });
}

}  // namespace pushid
