#include "ident/prediction/prediction.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "datasets/files/atomic_file.h"
#include "datasets/files/number_text.h"
#include "ident/fit/step_probability.h"
#include "ident/prediction/futures.h"
#include "ident/prediction/predicted_steps.h"
#include "ident/problem/own_axes.h"
#include "models/learned_terms.h"

namespace pushid {
namespace {

int FirstPushStart(const Scene& scene) {
  int start = scene.pushes.front().start_frame;
  for (const ScenePush& push : scene.pushes) start = std::min(start, push.start_frame);
  return start;
}

// The place of a person at frame 0, about which the ground tilts.
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

Prediction Predict(const IdentifiedModel& model, const PendulumRecording& recording,
                   int num_frames) {
  const int frames = num_frames > 0 ? num_frames : recording.num_frames();
  const std::vector<ParameterSet<double>> parameters = PeoplesParameters(model, recording);
  Prediction prediction;
  prediction.parts = ReportedParts(model.options);
  prediction.rod_moves = RodMoves(model.options);
  prediction.feet_step = model.options.stance == Stance::kSteps;
  prediction.status = RolloutInOwnAxes(recording, model.options, parameters, frames,
                                       &prediction.path, &prediction.forces);
  if (!prediction.status.ok) return prediction;
  for (int n = 0; n < recording.scene.num_people(); ++n) {
    std::vector<Vector3<double>> hip;
    for (int t = 0; t < frames; ++t) {
      hip.push_back(
          HipPosition(prediction.BodyAt(recording.scene, t, n), prediction.path.At(t, n).q));
    }
    prediction.hip.push_back(std::move(hip));
  }
  if (!model.step_probability) return prediction;
  for (double margin : StepMargins(model.options, PeoplesParameters(model, recording), recording,
                                   prediction.path)) {
    prediction.steps.push_back(
        {margin, model.step_probability->At(margin), model.step_probability->ErrorAt(margin)});
  }
  return prediction;
}

MaybeError WriteTrajectoryCsv(const std::string& path, const PendulumRecording& recording,
                              const Prediction& on_ground) {
  const bool moves = recording.scene.ground.moves();
  const Prediction in_laboratory = moves ? InLaboratory(recording, on_ground) : Prediction{};
  const Prediction& prediction = moves ? in_laboratory : on_ground;
  std::string text =
      "frame,time_s,person,subject,x_m,y_m,theta_rad,phi_rad,xd_m_s,yd_m_s,thetad_rad_s,phid_rad_s,"
      "hip_x_m,hip_y_m,hip_z_m";
  for (ForcePart part : prediction.parts) {
    for (const char* row : {"x_N", "y_N", "theta_Nm", "phi_Nm"}) {
      text += "," + std::string(NameOf(part)) + "_" + row;
    }
  }
  if (prediction.rod_moves) text += ",rod_length_m,cart_height_m";
  if (prediction.feet_step) text += ",left_foot_x_m,left_foot_y_m,right_foot_x_m,right_foot_y_m";
  if (!prediction.steps.empty()) text += ",step_probability";
  if (!prediction.bands.empty()) {
    for (const char* axis : {"x", "y", "z"}) {
      text += std::string(",hip_") + axis + "_lower90_m,hip_" + axis + "_upper90_m";
    }
  }
  text += "\n";
  char number[32];
  auto add = [&text, &number](double value) {
    std::snprintf(number, sizeof number, ",%.9g", value + 0.0);  // no -0
    text += number;
  };
  const int frames = prediction.status.ok ? prediction.path.num_frames() : prediction.status.frame;
  for (int t = 0; t < frames; ++t) {
    for (int n = 0; n < recording.scene.num_people(); ++n) {
      const PendulumState<double>& state = prediction.path.At(t, n);
      text += std::to_string(t);
      add(t * recording.scene.dt);
      text += "," + std::to_string(n) + "," + recording.subject_ids[n];
      for (int i = 0; i < 4; ++i) add(state.q[i]);
      for (int i = 0; i < 4; ++i) add(state.qd[i]);
      const Body body = prediction.BodyAt(recording.scene, t, n);
      const Vector3<double> hip =
          prediction.observed > 0 || moves ? prediction.hip[n][t] : HipPosition(body, state.q);
      for (int i = 0; i < 3; ++i) add(hip[i]);
      const NetForce<double>& force = prediction.forces.At(t, n);
      for (ForcePart part : prediction.parts) {
        for (int i = 0; i < 4; ++i) add(force[part][i]);
      }
      if (prediction.rod_moves) add(body.rod_length), add(body.cart_height);
      for (Foot foot : kFeet) {
        const Eigen::Vector2d place = PlaceOf(foot, state);
        if (prediction.feet_step) add(place[0]), add(place[1]);
      }
      if (!prediction.steps.empty()) add(prediction.steps[n].probability);
      for (int i = 0; i < 3 && !prediction.bands.empty(); ++i) {
        // A frame that was seen is known.
        const HipBand& band = prediction.bands[n];
        const int ahead = t - prediction.observed;
        add(ahead < 0 ? hip[i] : band.lower90[ahead][i]);
        add(ahead < 0 ? hip[i] : band.upper90[ahead][i]);
      }
      text += "\n";
    }
  }
  return WriteFileAtomically(path, text);
}

Warnings InputWarnings(const IdentifiedModel& model,
                       const std::vector<PendulumRecording>& recordings) {
  Warnings warnings = FindingWarnings(FindingsOf(recordings));
  const bool together =
      std::any_of(recordings.begin(), recordings.end(),
                  [](const PendulumRecording& r) { return r.scene.num_people() > 1; });
  if (together && !model.options.interaction.Any()) {
    warnings.emplace_back(
        (model.source.empty() ? "the model" : model.source) +
        " was fitted without interaction: people will not affect each other; fit recordings of "
        "groups with an interaction (pushid-fit --setting=groups --interaction=contact)");
  }
  for (const std::string& warning : ExtrapolationWarnings(model, recordings)) {
    warnings.emplace_back(warning);
  }
  return warnings;
}

MaybeError CheckChangedPushes(const ChangedPushes& changed, const PendulumRecording& recording,
                              int frames) {
  if (!(changed.scale > 0.0) || !std::isfinite(changed.scale)) {
    return Error{"--push_scale is " + Rounded(changed.scale, 3) +
                 "; it must be a positive number, as in 1.37"};
  }
  if (changed.Any() && recording.scene.pushes.empty()) {
    return Error{"recording " + recording.id +
                 " has no push: leave out --push_scale and --push_again"};
  }
  if (changed.again.empty()) return std::nullopt;
  const Scene& scene = recording.scene;
  const int length = scene.LastPushEnd() - FirstPushStart(scene);
  int end = scene.LastPushEnd();
  for (const auto& [frame, times] : changed.again) {
    const std::string start = "--push_again: frame " + std::to_string(frame);
    if (!(times > 0.0) || !std::isfinite(times)) {
      return Error{start + " has the strength " + Rounded(times, 3) +
                   "; it must be a positive number, as in 40:1.5"};
    }
    if (frame < 0) return Error{start + " is negative; frames count from 0"};
    if (frame < end) {
      return Error{start +
                   " comes before the push before it has ended; pushes must not overlap, and stand "
                   "in ascending order: " +
                   "give frame " + std::to_string(end) + " or a later one"};
    }
    // Row t drives the step from frame t to t + 1.
    if (frame > frames - 2) {
      return Error{start + " is too late for the " + std::to_string(frames) +
                   " frames that are predicted; give an earlier one, or more --frames"};
    }
    end = frame + length;
  }
  return std::nullopt;
}

PendulumRecording WithPushes(PendulumRecording recording, const ChangedPushes& changed) {
  if (changed.scale != 1.0) recording.scene = ScalePushes(recording.scene, changed.scale);
  const Scene once = recording.scene;
  for (const auto& [frame, times] : changed.again) {
    Scene later = ScalePushes(once, times);
    for (ScenePush& push : later.pushes) {
      push.start_frame += frame - FirstPushStart(once);
      recording.scene.pushes.push_back(std::move(push));
    }
  }
  return recording;
}

std::string ChangedPushesText(const ChangedPushes& changed, const PendulumRecording& recording) {
  std::string text = changed.scale == 1.0 ? "" : Rounded(changed.scale, 4) + " times ";
  text += "the recorded push";
  if (changed.again.empty()) return text;
  text += ", at frames " + std::to_string(FirstPushStart(recording.scene));
  for (const auto& [frame, times] : changed.again) {
    text += (frame == changed.again.back().frame ? " and " : ", ") + std::to_string(frame);
    if (times != 1.0) text += " (" + Rounded(times, 4) + " times)";
  }
  return text;
}

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
