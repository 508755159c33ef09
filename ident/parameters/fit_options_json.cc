// ident: options and parameter tables to and from JSON.
#include "ident/parameters/fit_options_json.h"

#include "ident/parameters/option_names.h"
#include "ident/parameters/self_network_io.h"

namespace pushid {

using Json = nlohmann::ordered_json;

Json TableJson(const ParameterTable& table) {
  Json rows = Json::array();
  for (const ParameterSpec& spec : table.specs) {
    Json row = {{"name", spec.name},       {"unit", spec.unit},
                {"nominal", spec.nominal}, {"bounds", {spec.lower, spec.upper}},
                {"scale", spec.scale},     {"transform", NameOf(spec.transform)},
                {"free", spec.free},       {"pooled", spec.pooled},
                {"meaning", spec.meaning}};
    if (spec.prior) row["prior"] = {{"mean", spec.prior->mean}, {"sigma", spec.prior->sigma}};
    rows.push_back(row);
  }
  return rows;
}

Json OptionsJson(const FitOptions& o) {
  return {{"preset", o.preset},
          {"self_force", SelfForceText(o.self_force, o.model.self_network.get())},
          {"mapping", NameOf(o.mapping)},
          {"posture", NameOf(o.model.posture)},
          {"gain_scaling", NameOf(o.model.gain_scaling)},
          {"friction", NameOf(o.model.friction)},
          {"push", NameOf(o.model.push)},
          {"push_tail", NameOf(o.model.push_tail)},
          {"cart_derivative", NameOf(o.model.cart_derivative)},
          {"interaction", NameOf(o.model.interaction)},
          {"sigmas",
           {{"hip_m", o.sigmas.hip},
            {"velocity_m_s", o.sigmas.velocity},
            {"angle_rad", o.sigmas.angle},
            {"rate_rad_s", o.sigmas.rate},
            {"robust", o.sigmas.robust}}},
          {"recording_weight", NameOf(o.recording_weight)},
          {"settling_weight", o.settling_weight},
          {"mode_weight", o.mode_weight},
          {"mode_margin_per_s", o.mode_margin},
          {"stability_weight", o.stability_weight},
          {"pool_by", NameOf(o.pool_by)},
          {"pooling_sigma", o.pooling_sigma},
          {"network_prior", o.network_prior},
          {"early_stopping", o.early_stopping},
          {"takeover_weight", o.takeover_weight},
          {"ensemble", o.ensemble},
          {"horizons", o.horizons},
          {"start", NameOf(o.start)},
          {"num_starts", o.num_starts},
          {"start_spread", o.start_spread},
          {"seed", o.seed},
          {"max_iterations", o.max_iterations},
          {"function_tolerance", o.function_tolerance},
          {"gradient_tolerance", o.gradient_tolerance},
          {"parameter_tolerance", o.parameter_tolerance}};
}

ParameterTable TableFrom(const Json& json, const ParameterTable& known) {
  ParameterTable table = known;
  for (const Json& row : json) {
    ParameterSpec* spec = table.Find(row.at("name").get<std::string>());
    if (spec == nullptr) {
      throw std::runtime_error("unknown parameter '" + row.at("name").get<std::string>() + "'");
    }
    spec->unit = row.at("unit");
    spec->nominal = row.at("nominal");
    spec->lower = row.at("bounds").at(0);
    spec->upper = row.at("bounds").at(1);
    spec->scale = row.at("scale");
    spec->transform = EnumFrom<Transform>(row, "transform");
    spec->free = row.at("free");
    spec->pooled = row.at("pooled");
    spec->meaning = row.at("meaning");
    spec->prior.reset();
    if (row.contains("prior")) {
      spec->prior = Prior{row.at("prior").at("mean"), row.at("prior").at("sigma")};
    }
  }
  return table;
}

FitOptions OptionsFrom(const Json& json) {
  FitOptions o;
  o.preset = json.at("preset");
  const auto self = ParseSelfForce("self_force", json.at("self_force").get<std::string>());
  if (!self.ok()) throw std::runtime_error(self.error().ToString());
  o.self_force = self.value().kind;
  o.mapping = EnumFrom<SkeletonMapping>(json, "mapping");
  o.model.posture = EnumFrom<Posture>(json, "posture");
  o.model.gain_scaling = EnumFrom<GainScaling>(json, "gain_scaling");
  o.model.friction = EnumFrom<FrictionKind>(json, "friction");
  o.model.push = EnumFrom<PushUse>(json, "push");
  o.model.push_tail = EnumFrom<PushTail>(json, "push_tail");
  o.model.cart_derivative = EnumFrom<CartDerivative>(json, "cart_derivative");
  if (MaybeError error = ParseName("interaction", json.at("interaction").get<std::string>(),
                                   &o.model.interaction)) {
    throw std::runtime_error(error->ToString());
  }
  const Json& sigmas = json.at("sigmas");
  o.sigmas = {sigmas.at("hip_m"), sigmas.at("velocity_m_s"), sigmas.at("angle_rad"),
              sigmas.at("rate_rad_s"), sigmas.at("robust")};
  o.recording_weight = EnumFrom<RecordingWeight>(json, "recording_weight");
  o.settling_weight = json.at("settling_weight");
  o.mode_weight = json.at("mode_weight");
  o.mode_margin = json.at("mode_margin_per_s");
  o.stability_weight = json.at("stability_weight");
  o.pool_by = EnumFrom<PoolBy>(json, "pool_by");
  o.pooling_sigma = json.at("pooling_sigma");
  o.network_prior = json.value("network_prior", o.network_prior);
  o.early_stopping = json.value("early_stopping", o.early_stopping);
  o.takeover_weight = json.value("takeover_weight", o.takeover_weight);
  o.ensemble = json.value("ensemble", o.ensemble);
  o.horizons = json.at("horizons").get<std::vector<int>>();
  o.start = EnumFrom<FitStart>(json, "start");
  o.num_starts = json.at("num_starts");
  o.start_spread = json.at("start_spread");
  o.seed = json.at("seed");
  o.max_iterations = json.at("max_iterations");
  o.function_tolerance = json.at("function_tolerance");
  o.gradient_tolerance = json.at("gradient_tolerance");
  o.parameter_tolerance = json.at("parameter_tolerance");
  return o;
}

}  // namespace pushid
