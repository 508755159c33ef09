// ident: from the ground's frame to the laboratory's.
#include "ident/prediction/laboratory_frame.h"

#include <algorithm>

namespace pushid {
namespace {

// Where a person stood: the ground tilts about there.
Vector3<double> Origin(const Scene& scene, int person) {
  const ScenePerson& who = scene.people[person];
  return {who.start.q[0], who.start.q[1], who.body.cart_height};
}

const GroundPose& PoseAt(const Scene& scene, int frame) {
  const std::vector<GroundPose>& poses = scene.ground.poses;
  return poses[std::min(static_cast<size_t>(frame), poses.size() - 1)];
}

void Move(const Scene& scene, HipPaths* hips) {
  for (size_t n = 0; n < hips->size(); ++n) {
    for (size_t t = 0; t < (*hips)[n].size(); ++t) {
      Vector3<double>& hip = (*hips)[n][t];
      const int frame = static_cast<int>(t);
      hip = PointInLaboratory(PoseAt(scene, frame), Origin(scene, static_cast<int>(n)), hip);
    }
  }
}

}  // namespace

Prediction InLaboratory(const PendulumRecording& recording, Prediction prediction) {
  const Scene& scene = recording.scene;
  if (!scene.ground.moves()) return prediction;
  const int known = static_cast<int>(scene.ground.poses.size()) - 1;
  for (int t = 0; t < prediction.path.num_frames(); ++t) {
    for (int n = 0; n < prediction.path.num_people(); ++n) {
      PendulumState<double>& state = prediction.path.At(t, n);
      state = InLaboratory(scene.ground, std::min(t, known), state);
    }
  }
  Move(scene, &prediction.hip);
  prediction.parts.push_back(ForcePart::kInertia);
  return prediction;
}

PendulumRecording InLaboratory(PendulumRecording recording) {
  const Scene& scene = recording.scene;
  if (!scene.ground.moves()) return recording;
  for (auto& states : recording.states) {
    for (size_t t = 0; t < states.size(); ++t) {
      states[t] = InLaboratory(scene.ground, static_cast<int>(t), states[t]);
    }
  }
  Move(scene, &recording.hip);
  return recording;
}

void ToLaboratory(const Scene& scene, std::vector<BodyMotion>* bodies) {
  if (!scene.ground.moves()) return;
  for (size_t n = 0; n < bodies->size(); ++n) {
    const Vector3<double> origin = Origin(scene, static_cast<int>(n));
    for (size_t t = 0; t < (*bodies)[n].size(); ++t) {
      Pose& pose = (*bodies)[n][t];
      for (int joint = 0; joint < kBodyJoints; ++joint) {
        pose.col(joint) =
            PointInLaboratory(PoseAt(scene, static_cast<int>(t)), origin, pose.col(joint));
      }
    }
  }
}

void ToLaboratory(const Scene& scene, PredictiveBands* bands) {
  if (!scene.ground.moves()) return;
  for (size_t n = 0; n < bands->people.size(); ++n) {
    const Vector3<double> origin = Origin(scene, static_cast<int>(n));
    PathBand& band = bands->people[n];
    for (auto* line : {&band.lower90, &band.lower50, &band.median, &band.upper50, &band.upper90}) {
      for (size_t t = 0; t < line->size(); ++t) {
        const GroundPose& pose = PoseAt(scene, static_cast<int>(t));
        BandPoint& point = (*line)[t];
        point.head<3>() = PointInLaboratory(pose, origin, point.head<3>());
        point.tail<2>() += pose.tail<2>();
      }
    }
  }
}

}  // namespace pushid
