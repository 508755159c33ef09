// ident: what an animation shows, collected.
#include <algorithm>
#include <utility>

#include "ident/bodies/animation.h"

namespace pushid {

int Animation::num_frames() const {
  size_t frames = 0;
  for (const AnimatedPerson& person : people) {
    frames = std::max({frames, person.body.size(), person.tip.size()});
  }
  return static_cast<int>(frames);
}

std::vector<std::string> WhatsOf(const Animation& animation) {
  std::vector<std::string> whats;
  for (const AnimatedPerson& person : animation.people) {
    const bool known = std::find(whats.begin(), whats.end(), person.what) != whats.end();
    if (!person.recorded && !known) whats.push_back(person.what);
  }
  return whats;
}

void AddPrediction(const PendulumRecording& recording, const Prediction& prediction,
                   const std::vector<BodyMotion>& bodies, Animation* animation,
                   const std::string& what) {
  const FootprintsOfPeople prints = PredictedFootprints(recording, prediction);
  for (int n = 0; n < recording.scene.num_people(); ++n) {
    AnimatedPerson person;
    person.name = recording.subject_ids[n];
    person.what = what;
    if (n < static_cast<int>(bodies.size())) person.body = bodies[n];
    person.tip = prediction.hip[n];
    if (n < static_cast<int>(prints.size())) person.footprints = prints[n];
    person.facing = recording.facing;
    for (int t = 0; t < prediction.path.num_frames(); ++t) {
      const Vector4<double>& q = prediction.path.At(t, n).q;
      person.cart.emplace_back(q[0], q[1], prediction.BodyAt(recording.scene, t, n).cart_height);
      person.force.push_back(prediction.forces.At(t, n).Total());
    }
    animation->people.push_back(std::move(person));
  }
}

void AddPushes(const PendulumRecording& recording, Animation* animation) {
  for (const ScenePush& push : recording.scene.pushes) {
    animation->pushes.push_back({recording.subject_ids[push.person], push.start_frame, push.force});
  }
}

void AddRecorded(const PendulumRecording& recording, const std::vector<BodyMotion>& bodies,
                 Animation* animation) {
  const FootprintsOfPeople prints = RecordedFootprints(recording);
  for (size_t n = 0; n < recording.subject_ids.size(); ++n) {
    AnimatedPerson person;
    person.name = recording.subject_ids[n];
    person.recorded = true;
    person.facing = recording.facing;
    if (n < bodies.size()) person.body = bodies[n];
    if (n < prints.size()) person.footprints = prints[n];
    const double cart_height = recording.scene.people[n].body.cart_height;
    for (const PendulumState<double>& state : recording.states[n]) {
      person.cart.emplace_back(state.q[0], state.q[1], cart_height);
    }
    person.tip = recording.hip[n];
    animation->people.push_back(std::move(person));
  }
}

void AddForecast(const std::vector<std::string>& names, const std::vector<BodyMotion>& bodies,
                 Animation* animation) {
  for (size_t n = 0; n < bodies.size(); ++n) {
    AnimatedPerson person;
    person.name = names[n];
    person.body = bodies[n];
    animation->people.push_back(std::move(person));
  }
}

}  // namespace pushid
