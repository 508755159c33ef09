// ident: recordings as bodies.
#include "ident/bodies/body_recording.h"

#include <algorithm>

#include "datasets/files/names.h"
#include "ident/prediction/predicted_steps.h"

namespace pushid {
namespace {

MaybeError CheckSkeleton(const Recording& recording, const RecordedPerson& person) {
  const std::vector<int> unfilled = UnfilledRoles(person.roles);
  if (unfilled.empty()) return std::nullopt;
  return Error{"recording " + recording.id +
                   ": a body needs joints that were not recognised: " + RoleList(unfilled) +
                   "; name them in the manifest: \"joints\": {\"" + RoleName(unfilled.front()) +
                   "\": ...}; the file has " + ListOfNames(person.joint_names),
               person.file};
}

// The file's own names, where a role is one of its joints.
std::vector<std::string> RoleJointNames(const RecordedPerson& person) {
  std::vector<std::string> names = DefaultJointNames();
  for (int role = 0; role < kBodyJoints; ++role) {
    const int joint = person.roles.Single(role);
    if (joint >= 0 && person.skeleton) names[role] = person.joint_names[joint];
  }
  return names;
}

std::vector<RestorationInput> People(const BodyRecording& recording) {
  std::vector<Pose> first_poses;
  for (const BodyMotion& body : recording.bodies) first_poses.push_back(body.front());
  return PeopleOf(recording.pendulum.scene, first_poses);
}

// One pose is the first one, which everybody has.
void AddSeen(const BodyRecording& recording, int observed, std::vector<RestorationInput>* people) {
  if (observed < 2) return;
  for (int n = 0; n < recording.num_people(); ++n) {
    const BodyMotion& body = recording.bodies[n];
    (*people)[n].seen.assign(body.begin(), body.begin() + std::min<size_t>(observed, body.size()));
  }
}

}  // namespace

Result<BodyRecording> MakeBodyRecording(const Recording& recording, SkeletonMapping mapping) {
  BodyRecording result;
  result.pendulum = MakePendulumRecording(recording, mapping);
  for (const RecordedPerson& person : recording.people) {
    if (MaybeError error = CheckSkeleton(recording, person)) return *error;
    BodyMotion motion(person.joints.size());
    for (size_t t = 0; t < motion.size(); ++t) {
      motion[t] = PoseOf(person.roles, person.joints[t]);
    }
    result.bodies.push_back(std::move(motion));
    result.skeletons.push_back(SkeletonOf(person));
  }
  result.joint_names = RoleJointNames(recording.people.front());
  return result;
}

Result<std::vector<BodyRecording>> MakeBodyRecordings(const std::vector<Recording>& recordings,
                                                      SkeletonMapping mapping) {
  std::vector<BodyRecording> bodies;
  for (const Recording& recording : recordings) {
    Result<BodyRecording> body = MakeBodyRecording(recording, mapping);
    if (!body.ok()) return body.error();
    bodies.push_back(std::move(body.value()));
  }
  return bodies;
}

RecordedBodies BodiesOfGroups(const std::vector<Recording>& recordings) {
  const bool groups = std::any_of(recordings.begin(), recordings.end(),
                                  [](const Recording& r) { return r.people.size() > 1; });
  if (!groups) return {};
  const auto made = MakeBodyRecordings(recordings, SkeletonMapping::kExact);
  if (!made.ok()) return {};
  RecordedBodies bodies;
  for (const BodyRecording& recording : made.value()) bodies.push_back(recording.bodies);
  return bodies;
}

std::vector<PendulumRecording> PendulumsOf(const std::vector<BodyRecording>& recordings) {
  std::vector<PendulumRecording> pendulums;
  for (const BodyRecording& recording : recordings) pendulums.push_back(recording.pendulum);
  return pendulums;
}

std::vector<RestorationInput> PredictedPeople(const BodyRecording& recording,
                                              const RolloutPath<double>& path) {
  std::vector<RestorationInput> people = People(recording);
  for (int n = 0; n < recording.num_people(); ++n) {
    for (int t = 0; t < path.num_frames(); ++t) people[n].q.push_back(path.At(t, n).q);
  }
  return people;
}

std::vector<RestorationInput> PredictedPeople(const BodyRecording& recording,
                                              const Prediction& prediction) {
  std::vector<RestorationInput> people = PredictedPeople(recording, prediction.path);
  for (int n = 0; n < recording.num_people(); ++n) {
    people[n].stands = StandingFrames(prediction, n);
  }
  AddSeen(recording, prediction.observed, &people);
  return people;
}

std::vector<RestorationInput> RecordedPeople(const BodyRecording& recording, int observed) {
  std::vector<RestorationInput> people = People(recording);
  AddSeen(recording, observed, &people);
  for (int n = 0; n < recording.num_people(); ++n) {
    for (const auto& state : recording.pendulum.states[n]) people[n].q.push_back(state.q);
  }
  return people;
}

}  // namespace pushid
