// ident: takeovers in and out.
#include "ident/model/takeover_json.h"

#include <nlohmann/json.hpp>

#include "ident/model/json_pieces.h"

namespace pushid {

namespace {
using Json = nlohmann::ordered_json;
}  // namespace

Json ToJson(const Takeover& t) {
  return {{"mu_N_s_m", NumberJson(t.mu)},
          {"Kp_theta_N_m_rad", NumberJson(t.kp_theta)},
          {"Kd_theta_N_m_s_rad", NumberJson(t.kd_theta)},
          {"rms_force_m_s2", NumberJson(t.rms_force)}};
}

Json ToJson(const ContactTakeover& t) {
  return {{"stiffness_N_m", NumberJson(t.stiffness)},
          {"damping_N_s_m", NumberJson(t.damping)},
          {"rms_force_m_s2", NumberJson(t.rms_force)}};
}

Takeover TakeoverFromJson(const Json& json) {
  return {NumberFrom(json.at("mu_N_s_m")), NumberFrom(json.at("Kp_theta_N_m_rad")),
          NumberFrom(json.at("Kd_theta_N_m_s_rad")), NumberFrom(json.at("rms_force_m_s2"))};
}

ContactTakeover ContactTakeoverFromJson(const Json& json) {
  return {NumberFrom(json.at("stiffness_N_m")), NumberFrom(json.at("damping_N_s_m")),
          NumberFrom(json.at("rms_force_m_s2"))};
}

}  // namespace pushid
