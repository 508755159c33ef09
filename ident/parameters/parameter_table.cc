// ident: the parameters' facts.
#include "ident/parameters/parameter_table.h"

#include <algorithm>
#include <cmath>

#include "models/self_network.h"

namespace pushid {
namespace {

ParameterSpec Spec(Parameter id, const char* unit, double nominal, double lower, double upper,
                   double scale, Transform transform, const char* meaning) {
  ParameterSpec spec;
  spec.id = id;
  spec.name = kParameterNames[id];
  spec.unit = unit;
  spec.nominal = nominal;
  spec.lower = lower;
  spec.upper = upper;
  spec.scale = scale;
  spec.transform = transform;
  spec.meaning = meaning;
  return spec;
}

}  // namespace

ParameterTable BaseTable() {
  const Transform plain = Transform::kIdentity, log = Transform::kLog;
  ParameterTable table;
  auto add = [&table](ParameterSpec spec) { table.specs.push_back(std::move(spec)); };
  // Friction and cart gains may turn negative: the data must be able to say so.
  add(Spec(kMu, "N s/m", 100, -2000, 2000, 100, plain, "ground friction"));
  add(Spec(kMuY, "N s/m", 100, -2000, 2000, 100, plain, "ground friction along y"));
  add(Spec(kKpX, "N s/m", 0, -2000, 2000, 100, plain, "balance gain on the cart's velocity, x"));
  add(Spec(kKpY, "N s/m", 0, -2000, 2000, 100, plain, "balance gain on the cart's velocity, y"));
  add(Spec(kKpTheta, "N m/rad", 1500, 1, 1e5, 1500, log, "balance stiffness about y"));
  add(Spec(kKpPhi, "N m/rad", 1500, 1, 1e5, 1500, log, "balance stiffness about x"));
  add(Spec(kKdX, "kg", 0, -500, 500, 10, plain, "balance gain on the cart's acceleration, x"));
  add(Spec(kKdY, "kg", 0, -500, 500, 10, plain, "balance gain on the cart's acceleration, y"));
  add(Spec(kKdTheta, "N m s/rad", 70, 1e-3, 1e4, 70, log, "balance damping about y"));
  add(Spec(kKdPhi, "N m s/rad", 70, 1e-3, 1e4, 70, log, "balance damping about x"));
  add(Spec(kAx, "m/s^2/rad", 0, -200, 200, 10, plain, "cart force from the lean, x"));
  add(Spec(kAy, "m/s^2/rad", 0, -200, 200, 10, plain, "cart force from the lean, y"));
  add(Spec(kBx, "m/s/rad", 0, -50, 50, 2, plain, "cart force from the lean's rate, x"));
  add(Spec(kBy, "m/s/rad", 0, -50, 50, 2, plain, "cart force from the lean's rate, y"));
  add(Spec(kTx, "m/s", 0, -50, 50, 2, plain, "torque from the cart's velocity, x"));
  add(Spec(kTy, "m/s", 0, -50, 50, 2, plain, "torque from the cart's velocity, y"));
  add(Spec(kCq, "1/m", 0, -20, 20, 0.5, plain, "quadratic damping of the cart"));
  add(Spec(kDq, "1/rad", 0, -50, 50, 1, plain, "quadratic damping of the angles"));
  add(Spec(kTailGain, "1", 1, 1e-3, 50, 1, log, "tail force over the push's mean force"));
  add(Spec(kTailTorque, "1", 0.3, -50, 50, 0.3, plain, "tail torque over the push's mean torque"));
  add(Spec(kTailTime, "s", 0.2, 0.005, 5, 0.2, log, "tail's decay time after a push of 0.1 s"));
  add(Spec(kTailExponent, "1", 1, -5, 5, 1, plain, "growth of that time with the push's duration"));
  add(Spec(kContactStiffness, "N/m", 2000, 1, 1e5, 2000, log,
           "stiffness of contact between people"));
  add(Spec(kContactDistance, "m", 0.4, 0.05, 1.5, 0.4, log, "distance at which people touch"));
  add(Spec(kContactKappa, "1", 0.6, 0.01, 10, 0.6, log, "weight of the sideways distance"));
  add(Spec(kContactDamping, "N s/m", 100, 1e-3, 1e4, 100, log, "damping of contact"));
  add(Spec(kContactHeight, "1", 0.5, 0.01, 0.99, 0.5, Transform::kLogit,
           "height of contact, fraction of the rod"));
  add(Spec(kPotentialStrength, "N m", 150, 0.1, 1e5, 150, log, "strength of LDP's potential"));
  add(Spec(kPotentialLength, "m", 0.5, 0.02, 5, 0.5, log, "decay length of LDP's potential"));
  add(Spec(kNeighbourRange, "m", 0.5, 0.1, 3, 0.5, log, "cart distance at which LDP's terms end"));
  add(Spec(kLeanTheta, "N m", 100, -2000, 2000, 100, plain, "torque against leaning on others, y"));
  add(Spec(kLeanPhi, "N m", 100, -2000, 2000, 100, plain, "torque against leaning on others, x"));
  add(Spec(kDriveGain, "1", 0.5, -20, 20, 0.5, plain, "cart force over the contact lately felt"));
  add(Spec(kDriveTorque, "1", 0.2, -20, 20, 0.2, plain, "torque over the contact lately felt"));
  add(Spec(kDriveTime, "s", 0.3, 0.01, 5, 0.3, log, "how long contact is felt"));
  add(Spec(kRodLift, "1", 1, -10, 10, 0.5, plain, "rise of the cart over the rod's shortening"));
  return table;
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

bool AnyPooled(const ParameterTable& table) {
  return std::any_of(table.specs.begin(), table.specs.end(),
                     [](const ParameterSpec& spec) { return spec.free && spec.pooled; });
}

bool Acts(Parameter id, const ModelOptions& model) {
  const InteractionTerms& terms = model.interaction;
  switch (id) {
    case kMuY:
      return model.friction == FrictionKind::kAnisotropic;
    case kKdX:
    case kKdY:
      return model.cart_derivative == CartDerivative::kBackward;
    case kTailGain:
    case kTailTorque:
    case kTailTime:
    case kTailExponent:
      return model.push_tail == PushTail::kExponential;
    case kContactStiffness:
      return terms.spring;
    case kContactDamping:
      return terms.damping;
    case kContactDistance:
    case kContactKappa:
    case kContactHeight:
      return terms.Contact();
    case kPotentialStrength:
    case kPotentialLength:
      return terms.potential || terms.ldp_discrete;
    case kLeanTheta:
    case kLeanPhi:
      return terms.lean || terms.ldp_discrete;
    case kNeighbourRange:
      return terms.AtCarts();
    case kDriveGain:
    case kDriveTorque:
    case kDriveTime:
      return terms.drive;
    case kRodLift:
      return RodMoves(model);
    default:
      return true;
  }
}

}  // namespace pushid
