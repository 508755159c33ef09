// ident: from the ground's frame to the laboratory's.
#include "ident/prediction/laboratory_frame.h"

namespace pushid {
namespace {

// Where a person stood: the ground tilts about there.
Vector3<double> Origin(const Scene& scene, int person) {
  const ScenePerson& who = scene.people[person];
  return {who.start.q[0], who.start.q[1], who.body.cart_height};
}

void Move(const Scene& scene, HipPaths* hips) {
  for (size_t n = 0; n < hips->size(); ++n) {
    for (size_t t = 0; t < (*hips)[n].size(); ++t) {
      Vector3<double>& hip = (*hips)[n][t];
      const int frame = static_cast<int>(t);
      hip = PointInLaboratory(scene.ground.PoseAt(frame), Origin(scene, static_cast<int>(n)), hip);
    }
  }
}

// moved(pose of the ground, origin, point).
template <typename Moved>
void MoveJoints(const Scene& scene, const Moved& moved, std::vector<BodyMotion>* bodies) {
  if (!scene.ground.moves()) return;
  for (size_t n = 0; n < bodies->size(); ++n) {
    const Vector3<double> origin = Origin(scene, static_cast<int>(n));
    for (size_t t = 0; t < (*bodies)[n].size(); ++t) {
      const GroundPose& ground = scene.ground.PoseAt(static_cast<int>(t));
      Pose& pose = (*bodies)[n][t];
      for (int joint = 0; joint < kBodyJoints; ++joint) {
        pose.col(joint) = moved(ground, origin, pose.col(joint));
      }
    }
  }
}

}  // namespace

Prediction InLaboratory(const PendulumRecording& recording, Prediction prediction) {
  const Scene& scene = recording.scene;
  if (!scene.ground.moves()) return prediction;
  for (int t = 0; t < prediction.path.num_frames(); ++t) {
    for (int n = 0; n < prediction.path.num_people(); ++n) {
      PendulumState<double>& state = prediction.path.At(t, n);
      state = InLaboratory(scene.ground, t, Origin(scene, n), state);
    }
  }
  Move(scene, &prediction.hip);
  prediction.parts.push_back(ForcePart::kInertia);
  return prediction;
}

PendulumRecording InLaboratory(PendulumRecording recording) {
  const Scene& scene = recording.scene;
  if (!scene.ground.moves()) return recording;
  for (int n = 0; n < recording.num_people(); ++n) {
    for (int t = 0; t < recording.num_frames(); ++t) {
      PendulumState<double>& state = recording.states[n][t];
      state = InLaboratory(scene.ground, t, Origin(scene, n), state);
    }
  }
  Move(scene, &recording.hip);
  return recording;
}

void ToLaboratory(const Scene& scene, std::vector<BodyMotion>* bodies) {
  MoveJoints(scene, PointInLaboratory, bodies);
}

void ToGround(const Scene& scene, std::vector<BodyMotion>* bodies) {
  MoveJoints(scene, OnGround, bodies);
}

void ToLaboratory(const Scene& scene, PredictiveBands* bands) {
  if (!scene.ground.moves()) return;
  for (size_t n = 0; n < bands->people.size(); ++n) {
    const Vector3<double> origin = Origin(scene, static_cast<int>(n));
    PathBand& band = bands->people[n];
    for (auto* line : {&band.lower90, &band.lower50, &band.middle, &band.upper50, &band.upper90}) {
      for (size_t t = 0; t < line->size(); ++t) {
        const GroundPose& pose = scene.ground.PoseAt(static_cast<int>(t));
        BandPoint& point = (*line)[t];
        point.head<3>() = PointInLaboratory(pose, origin, point.head<3>());
        point.tail<2>() += pose.tail<2>();
      }
    }
  }
}

}  // namespace pushid
