// ident: the effect of recordings, to JSON and back.
#include "ident/model/recording_effect_json.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "ident/model/json_pieces.h"

namespace pushid {

namespace {
using Json = nlohmann::ordered_json;
}  // namespace

Json ToJson(const RecordingEffect& effect) {
  Json json = {{"spread", NumberJson(effect.spread)},
               {"spread_standard_error", NumberJson(effect.spread_error)},
               {"error_scale_m", NumberJson(effect.error_scale)},
               {"explained", NumberJson(effect.explained)},
               {"blend_rate_per_s", NumberJson(effect.blend_rate)},
               {"widening_per_s2",
                NumbersJson({effect.widening[0], effect.widening[1], effect.widening[2]})},
               {"clusters", effect.clusters},
               {"recordings", Json::array()}};
  for (const EffectOfRecording& r : effect.recordings) {
    json["recordings"].push_back({{"id", r.id},
                                  {"person", r.person},
                                  {"condition", r.condition},
                                  {"effect", NumberJson(r.mean)},
                                  {"error", NumberJson(r.error)},
                                  {"alone", NumberJson(r.alone)}});
  }
  return json;
}

RecordingEffect RecordingEffectFromJson(const Json& json) {
  RecordingEffect effect;
  effect.spread = NumberFrom(json.at("spread"));
  effect.spread_error = NumberFrom(json.at("spread_standard_error"));
  effect.error_scale = NumberFrom(json.at("error_scale_m"));
  effect.explained = NumberFrom(json.at("explained"));
  effect.blend_rate = NumberFrom(json.at("blend_rate_per_s"));
  for (int i = 0; i < 3; ++i) effect.widening[i] = NumberFrom(json.at("widening_per_s2").at(i));
  effect.clusters = json.at("clusters");
  for (const Json& r : json.at("recordings")) {
    effect.recordings.push_back({r.at("id"), r.at("person"), r.at("condition"),
                                 NumberFrom(r.at("effect")), NumberFrom(r.at("error")),
                                 NumberFrom(r.at("alone"))});
  }
  const bool possible = effect.spread >= 0.0 && effect.error_scale > 0.0 &&
                        effect.blend_rate >= 0.0 && (effect.widening.array() >= 0.0).all();
  if (!possible) throw std::runtime_error("recording_effect has numbers that cannot be");
  return effect;
}

}  // namespace pushid
