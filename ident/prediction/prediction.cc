// ident: rollouts of an identified model.
#include "ident/prediction/prediction.h"

#include <cmath>
#include <cstdio>

#include "datasets/files/atomic_file.h"
#include "ident/prediction/median_prediction.h"
#include "ident/results/model_rollout.h"
#include "models/learned_terms.h"

namespace pushid {
namespace {

Prediction PredictOne(const ModelOptions& options,
                      const std::vector<ParameterSet<double>>& parameters,
                      const PendulumRecording& recording, int frames) {
  Prediction prediction;
  prediction.parts = ReportedParts(options);
  prediction.rod_moves = RodMoves(options);
  prediction.feet_step = options.stance == Stance::kThreshold;
  for (const ParameterSet<double>& own : parameters) prediction.rod_lift.push_back(own[kRodLift]);
  prediction.status =
      Rollout(recording.scene, options, parameters, InitialVelocities(recording.scene), frames,
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
  return prediction;
}

void AddSteps(const IdentifiedModel& model, const PendulumRecording& recording,
              Prediction* prediction) {
  if (!model.step_probability) return;
  const std::vector<ParameterSet<double>> parameters = PeoplesParameters(model, recording);
  for (int n = 0; n < recording.scene.num_people(); ++n) {
    const double margin =
        StepMargin(model.options, parameters[n], recording.scene.people[n], prediction->path, n);
    prediction->steps.push_back(
        {margin, model.step_probability->At(margin), model.step_probability->ErrorAt(margin)});
  }
}

}  // namespace

Prediction Predict(const IdentifiedModel& model, const PendulumRecording& recording, int num_frames,
                   double effect) {
  const int frames = num_frames > 0 ? num_frames : recording.num_frames();
  std::vector<Prediction> stayed, left;  // in the model's domain, or not
  const auto add = [&](Prediction prediction) {
    (prediction.status.ok ? stayed : left).push_back(std::move(prediction));
  };
  add(PredictOne(model.options, PeoplesParameters(model, recording, effect), recording, frames));
  for (const EnsembleMember& member : model.others) {
    ModelOptions options = model.options;
    options.learned = member.network;
    ParameterSet<double> parameters = member.parameters;
    parameters[kTailGain] *= std::exp(effect);
    add(PredictOne(options, {parameters}, recording, frames));
  }
  if (left.size() >= stayed.size()) return left.front();
  Prediction prediction = stayed.size() == 1 ? stayed.front() : MedianPrediction(recording, stayed);
  AddSteps(model, recording, &prediction);
  return prediction;
}

MaybeError WriteTrajectoryCsv(const std::string& path, const PendulumRecording& recording,
                              const Prediction& prediction) {
  std::string text =
      "frame,time_s,person,subject,x_m,y_m,theta_rad,phi_rad,xd_m_s,yd_m_s,thetad_rad_s,phid_rad_s,"
      "hip_x_m,hip_y_m,hip_z_m";
  for (ForcePart part : prediction.parts) {
    for (const char* row : {"x_N", "y_N", "theta_Nm", "phi_Nm"}) {
      text += "," + std::string(NameOf(part)) + "_" + row;
    }
  }
  if (prediction.rod_moves) text += ",rod_length_m,cart_height_m";
  if (prediction.feet_step) text += ",step_state";
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
          prediction.observed > 0 ? prediction.hip[n][t] : HipPosition(body, state.q);
      for (int i = 0; i < 3; ++i) add(hip[i]);
      const NetForce<double>& force = prediction.forces.At(t, n);
      for (ForcePart part : prediction.parts) {
        for (int i = 0; i < 4; ++i) add(force[part][i]);
      }
      if (prediction.rod_moves) add(body.rod_length), add(body.cart_height);
      if (prediction.feet_step) add(state.step);
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

}  // namespace pushid
