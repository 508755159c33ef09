// apps: the flags that describe a formation and the pushes on it.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "models/formation.h"
#include "models/restoration/body.h"

namespace pushid {

struct FormationFlags {
  std::string title;               // "10 people in a line, 0.45 m apart; 80 N s on person 0 at 0 s"
  Scene scene;                     // people and pushes
  std::vector<std::string> names;  // of people who come from a file; otherwise empty
  int frames = 0;
  std::vector<Pose> first_poses;  // of the recorded people of --people_from; otherwise empty
  std::string as_setting;         // whose parameters all people have; empty: the shared ones
};
// Errors name the flag.
FormationFlags FormationFlagsFromCommandLine();

}  // namespace pushid
