// ident: the probability of a step, to JSON and back.
#include "ident/model/step_probability_json.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "ident/model/json_pieces.h"

namespace pushid {

namespace {
using Json = nlohmann::ordered_json;
}  // namespace

Json ToJson(const StepProbability& p) {
  Json covariance = Json::array();
  for (int i = 0; i < 2; ++i) {
    covariance.push_back(NumbersJson({p.covariance(i, 0), p.covariance(i, 1)}));
  }
  return {{"intercept", NumberJson(p.coefficients[0])},
          {"slope_per_m", NumberJson(p.coefficients[1])},
          {"covariance", covariance},
          {"tracks", p.tracks},
          {"stepped", p.stepped},
          {"people", p.clusters}};
}

StepProbability StepProbabilityFromJson(const Json& json) {
  StepProbability p;
  p.coefficients = {NumberFrom(json.at("intercept")), NumberFrom(json.at("slope_per_m"))};
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      p.covariance(i, j) = NumberFrom(json.at("covariance").at(i).at(j));
    }
  }
  p.tracks = json.at("tracks");
  p.stepped = json.at("stepped");
  p.clusters = json.at("people");
  if (!p.coefficients.allFinite() || p.stepped < 0 || p.stepped > p.tracks) {
    throw std::runtime_error("step_probability has numbers that cannot be");
  }
  return p;
}

}  // namespace pushid
