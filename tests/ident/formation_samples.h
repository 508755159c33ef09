// What the tests of formations share: a model of people who touch and settle.
#pragma once

#include "datasets/synthetic/synthetic_recordings.h"
#include "ident/formations/formation_run.h"
#include "ident/parameters/presets.h"
#include "models/formation.h"

namespace pushid {

inline IdentifiedModel ContactModel() {
  IdentifiedModel model;
  model.options = MakePreset("tail").value().model;
  model.options.interaction.spring = model.options.interaction.damping = true;
  model.parameters = PublishedTailParameters();
  model.parameters[kContactStiffness] = 2800.0;
  model.parameters[kContactDistance] = 0.42;
  model.parameters[kContactKappa] = 0.58;
  model.parameters[kContactDamping] = 270.0;
  model.parameters[kContactHeight] = 0.5;
  return model;
}

inline Scene SampleFormation(FormationShape shape, int people, const std::vector<int>& pushed,
                             const std::vector<HipPush>& pushes = {{80.0, 0.0, 0.2}}) {
  Scene scene =
      FormationScene(FormationPositions(shape, people, 0.42), {80.0, 0.95, 0.08}, 1.0 / 60.0);
  for (const HipPush& push : pushes) {
    for (int person : pushed) AddHipPush(person, push, &scene);
  }
  return scene;
}

}  // namespace pushid
