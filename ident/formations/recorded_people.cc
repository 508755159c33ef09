// ident: who was recorded, and where they stand in a formation.
#include "ident/formations/recorded_people.h"

#include <set>
#include <string>

#include "ident/formations/formation_run.h"
#include "ident/uncertainty/clusters.h"

namespace pushid {

FormationPeople DistinctPeople(const std::vector<BodyRecording>& recordings) {
  FormationPeople people;
  std::set<std::string> seen;
  for (const BodyRecording& recording : recordings) {
    for (int n = 0; n < recording.num_people(); ++n) {
      if (!seen.insert(PersonKey(recording.pendulum, n)).second) continue;
      people.poses.push_back(recording.bodies[n].front());
      people.masses.push_back(recording.pendulum.scene.people[n].body.mass);
    }
  }
  return people;
}

std::vector<Pose> PlacePeople(const FormationPeople& people, Scene* scene) {
  for (int n = 0; n < scene->num_people(); ++n) {
    scene->people[n].body.mass = people.masses[n % people.count()];
  }
  return TakePoses(people.poses, scene);
}

}  // namespace pushid
