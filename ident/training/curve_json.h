// ident: the course of a training in the file of what was trained.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "models/restoration/regression_trainer.h"

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

}  // namespace pushid
