// ident: a training run to its end, its state in a file, which is good for the very same training
// alone, and its course as JSON and as a picture.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "models/restoration/trainer.h"

namespace pushid {

struct CheckpointOptions {
  std::string checkpoint;      // file; empty: none
  bool keep_finished = false;  // one more at the end: where further trainings follow
};

// How a training went.
struct TrainingCourse {
  std::vector<TrainingPoint> curve;
  bool resumed = false;
};

// Until the trainer is done, from a checkpoint of this key on if there is one; the last stays until
// it is removed. A finished training needs none, so that one that cannot be written does not lose
// its result. key: what the training depends on, data included. told: about every new point,
// whose stage it may name. The points are added to the course. Errors: a checkpoint that cannot be
// written.
MaybeError RunToEnd(Trainer* trainer, const std::string& key, const CheckpointOptions& options,
                    const std::function<void(TrainingPoint* point)>& told, TrainingCourse* course);

void RemoveCheckpoint(const std::string& file);

// In the file of what was trained.
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
