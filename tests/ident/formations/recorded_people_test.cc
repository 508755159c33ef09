// Recorded people in a formation, on two recordings worked by hand.

#include <gtest/gtest.h>

#include "ident/formations/formation_run.h"
#include "models/formation.h"

namespace pushid {
namespace {

// Somebody with this mass and rod, upright but for so much lean to the front, facing +y.
void AddSomebody(const std::string& name, double mass, double rod, double lean,
                 BodyRecording* recording) {
  recording->pendulum.subject_ids.push_back(name);
  ScenePerson person;
  person.body.mass = mass;
  recording->pendulum.scene.people.push_back(person);
  recording->pendulum.hip.emplace_back();
  Pose pose = SyntheticPose(rod);
  for (int j = 0; j < kBodyJoints; ++j) {
    if (j != kLeftAnkle && j != kRightAnkle) pose(0, j) += std::tan(lean) * rod;
  }
  recording->bodies.push_back({TurnAboutZ(M_PI / 2.0) * pose});
}

// Anna twice, once a little heavier, Ben, and Carl.
std::vector<BodyRecording> Recordings() {
  std::vector<BodyRecording> recordings(2);
  AddSomebody("anna", 60.0, 0.9, 0.0, &recordings[0]);
  AddSomebody("ben", 90.0, 1.0, 0.1, &recordings[0]);
  AddSomebody("anna", 60.4, 0.8, 0.2, &recordings[1]);
  AddSomebody("carl", 70.0, 0.95, 0.0, &recordings[1]);
  return recordings;
}

// Everybody once by name, and Anna as in her first recording.
TEST(FormationPeople, StandInTheirPlacesFromTheFirstAgain) {
  const auto places = FormationPositions(FormationShape::kDiamond, 13, 0.5);
  Scene scene = FormationScene(places, {80.0, 0.95, 0.0}, 1.0 / 60.0);
  const std::vector<Pose> poses = PlacePeople(Recordings(), &scene);
  ASSERT_EQ(poses.size(), 13u);
  const double mass[] = {60.0, 90.0, 70.0}, height[] = {0.9, 1.0, 0.95}, lean[] = {0.0, 0.1, 0.0};
  for (int n = 0; n < 13; ++n) {
    const ScenePerson& person = scene.people[n];
    EXPECT_EQ(person.body.mass, mass[n % 3]) << n;
    EXPECT_NEAR(person.body.rod_length * std::cos(person.start.q[2]), height[n % 3], 1e-9) << n;
    EXPECT_NEAR(person.start.q[0], places[n].x(), 1e-9) << n;
    EXPECT_NEAR(person.start.q[1], places[n].y(), 1e-9) << n;
    EXPECT_NEAR(person.start.q[2], lean[n % 3], 1e-9) << "to the front, which is +x now";
    EXPECT_NEAR(person.start.q[3], 0.0, 1e-9) << n;
  }
}

}  // namespace
}  // namespace pushid
