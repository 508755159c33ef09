// ident: the course of a training, in the file of what was trained and as a picture.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "models/restoration/trainer.h"

namespace pushid {

inline nlohmann::ordered_json CurveJson(const std::vector<TrainingPoint>& curve) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const TrainingPoint& p : curve) {
    nlohmann::ordered_json point = {{"epoch", p.epoch},
                                    {"training_loss", p.training_loss},
                                    {"held_out_loss", p.validation_loss}};
    if (!p.stage.empty()) point["stage"] = p.stage;
    json.push_back(point);
  }
  return json;
}

// Loss against epoch, training and held-out; stages one after the other.
std::string TrainingCurveSvg(const std::vector<TrainingPoint>& curve, const std::string& title);

}  // namespace pushid
