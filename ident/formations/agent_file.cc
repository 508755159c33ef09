// ident: agents for other simulators.
#include "ident/formations/agent_file.h"

#include <nlohmann/json.hpp>

#include "models/contact.h"
#include "models/self_force.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

// What of the model agents lack; empty: nothing.
std::string Untold(const IdentifiedModel& model) {
  const ModelOptions& o = model.options;
  if (o.stance != Stance::kSlide) return "feet that hold (--stance=slide)";
  if (o.delay != Delay::kNone) return "a reaction delay (--delay=none)";
  if (o.friction == FrictionKind::kCoulomb) return "dry friction (--friction=isotropic)";
  if (o.cart_derivative != CartDerivative::kNone) return "a derivative of the cart's velocity";
  if (o.learned != nullptr || !model.others.empty()) return "a network";
  if (!o.own_laws.empty()) return "laws of your own";
  if (o.interaction.Any() && !o.interaction.Mutual()) return "LDP's or a learned interaction";
  return "";
}

Json PairOf(double x, double y) { return Json::array({x + 0.0, y + 0.0}); }  // no -0

Json AgentOf(const IdentifiedModel& model, const ScenePerson& person, const std::string& id,
             double dt) {
  const ParameterSet<double>& p = model.parameters;
  const Body& body = person.body;
  const SelfForce self(model.options, body, person.start.q, dt);
  const GainScale& scale = self.scale;
  const double mass = body.mass,
               inertia = body.point_mass() * body.pendulum_length() * body.pendulum_length();
  const double touches = model.options.interaction.Any() ? 0.5 * p[kContactDistance] : 0.0;
  Json agent = {{"id", id},
                {"radius_m", touches},
                {"mass_kg", mass},
                {"point_mass_kg", body.point_mass()},
                {"rod_m", body.rod_length},
                {"pendulum_m", body.pendulum_length()},
                {"position_m", PairOf(person.start.q[0], person.start.q[1])},
                {"lean_rad", PairOf(person.start.q[2], person.start.q[3])}};
  agent["balance"] = {
      {"stiffness_Nm_per_rad", PairOf(scale.stiffness * p[kKpTheta], scale.stiffness * p[kKpPhi])},
      {"damping_Nms_per_rad", PairOf(scale.damping * p[kKdTheta], scale.damping * p[kKdPhi])},
      {"posture_rad", PairOf(self.posture[0], self.posture[1])},
      {"hold_Nm", PairOf(self.hold[0], self.hold[1])}};
  agent["steps"] = {{"drag_Ns_per_m",
                     PairOf(scale.force * (p[kMu] + p[kKpX]),
                            scale.force * (p[FrictionAlongY(model.options.friction)] + p[kKpY]))},
                    {"speed_drag_Ns2_per_m2", mass * p[kCq]},
                    {"lean_N_per_rad", PairOf(mass * p[kAx], mass * p[kAy])},
                    {"lean_rate_Ns_per_rad", PairOf(mass * p[kBx], mass * p[kBy])},
                    {"speed_torque_Ns", PairOf(mass * p[kTx], mass * p[kTy])},
                    {"rate_drag_Nms2_per_rad2", inertia * p[kDq]}};
  return agent;
}

}  // namespace

Result<Json> AgentsJson(const FormationRun& run, const IdentifiedModel& model) {
  const std::string untold = Untold(model);
  if (!untold.empty()) return Error{"agents cannot have what the model has: " + untold};
  const Scene& scene = run.recording.scene;
  const ParameterSet<double>& p = model.parameters;
  Json json = {{"schema", "pushid-agents/1"}, {"time_step_s", scene.dt}};
  for (int n = 0; n < scene.num_people(); ++n) {
    json["agents"].push_back(
        AgentOf(model, scene.people[n], run.recording.subject_ids[n], scene.dt));
  }
  const InteractionTerms& terms = model.options.interaction;
  if (terms.Any()) {
    json["contact"] = {{"stiffness_N_per_m", terms.spring ? p[kContactStiffness] : 0.0},
                       {"damping_Ns_per_m", terms.damping ? p[kContactDamping] : 0.0},
                       {"distance_m", p[kContactDistance]},
                       {"depth_over_width", p[kContactKappa]},
                       {"height_of_rod", p[kContactHeight]},
                       {"onset_m", kContactOnset},
                       {"softness_m", kContactSoftness}};
  }
  json["pushes"] = Json::array();
  for (const ScenePush& push : scene.pushes) {
    Json rows = Json::array();
    for (const Vector4<double>& row : push.force) rows.push_back({row[0], row[1], row[2], row[3]});
    json["pushes"].push_back({{"agent", run.recording.subject_ids[push.person]},
                              {"start_s", push.start_frame * scene.dt},
                              {"force_N_N_Nm_Nm", rows}});
  }
  return json;
}

}  // namespace pushid
