// ident: recorded people as the people of a formation: their masses, and the postures in which
// their recordings begin (rod length, cart height, lean, and the skeleton of a body).
#pragma once

#include <vector>

#include "ident/bodies/body_recording.h"
#include "models/restoration/body.h"
#include "models/scene.h"

namespace pushid {

struct FormationPeople {
  std::vector<Pose> poses;     // at frame 0 of each person's first recording
  std::vector<double> masses;  // kg

  int count() const { return static_cast<int>(poses.size()); }
};

// Everybody once (PersonKey), in the order of the recordings.
FormationPeople DistinctPeople(const std::vector<BodyRecording>& recordings);

// Puts them in the places of the scene's people, facing +x, from the first again where there are
// fewer. Before pushes are added: those depend on the bodies. Returns the first pose of each
// person.
std::vector<Pose> PlacePeople(const FormationPeople& people, Scene* scene);

}  // namespace pushid
