// ident: the paper in eight steps, from recordings of pushed people to predicted bodies; and the
// one header that a user of the library needs (link pushid::ident).
//
//   pushid::StudyOptions options;
//   options.recordings = "M/manifest.json";
//   options.held_out = "other/manifest.json";
//   options.page = "report.html";
//   pushid::Result<pushid::Study> study = pushid::RunStudy(options);
//   if (!study.ok()) return Fail(study.error().ToString());
//   std::cout << pushid::ScreenOf(study.value().model).ToString();
//
// The paper is LDP: Yue et al., Human Motion Prediction under Unexpected Perturbation, CVPR 2024.
// pushid estimates its parameters with intervals and a verdict instead of training them.
//
// Every step is a call that may be made alone, with its own options: a preset is a start, and
//   options.model.friction = FrictionKind::kAnisotropic;  // a term of the model
//   options.table[kKpTheta].nominal = 1200;               // where the fit begins
//   FreeTerms(&options);                                  // after a change of terms
//   AddForceLaw(MakeForceLaw(...), &options.model, &options.table);  // a law of your own
// Errors are values (datasets/files/error.h); nothing here prints, exits or throws.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "datasets/files/atomic_file.h"
#include "datasets/loading/load_recordings.h"
#include "datasets/loading/pendulum_recording.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/bodies/restoration_files.h"
#include "ident/checks/model_checks.h"
#include "ident/fit/fit.h"
#include "ident/fit/fit_setup.h"
#include "ident/model/fitted_model.h"
#include "ident/model/identified_model.h"
#include "ident/model/model_json.h"
#include "ident/parameters/parameter_table.h"
#include "ident/parameters/presets.h"
#include "ident/prediction/evaluation.h"
#include "ident/prediction/prediction.h"
#include "ident/push/push_estimation.h"
#include "ident/report/advice.h"
#include "ident/report/page/build_report.h"
#include "ident/report/report_text.h"
#include "residuals/autodiff_force_law.h"

namespace pushid {

struct StudyOptions {
  std::string recordings, held_out;   // manifests: what is fitted, and what is predicted
  GivenOptions given = {};            // options of pushid-fit by name: {{"preset", "tail"}}
  std::string restoration = "rigid";  // or the folder of pushid-train-restoration
  std::string page = "";              // an HTML report; empty: none
};

struct Study {
  FittedModel model;                            // parameters, intervals, verdict, advice
  Evaluation evaluation;                        // errors on the held-out pushes, with baselines
  std::vector<std::vector<BodyMotion>> bodies;  // predicted [recording][person]
};

// Step 3: recordings without a push get the net force of inverse dynamics while the hip speeds up.
inline MaybeError EstimateMissingPushes(std::vector<Recording>* recordings,
                                        std::vector<PendulumRecording>* pendulums) {
  for (size_t i = 0; i < recordings->size(); ++i) {
    Recording& recording = (*recordings)[i];
    if (!recording.pushes.empty() || !recording.ground.empty()) continue;
    PushEstimationOptions options;
    options.person = recording.pushed_person;
    options.smoothing_frames = 9;  // without it, 2 mm of marker noise make 600 N
    const Result<PushWindow> window = DetectPushWindow((*pendulums)[i], options);
    if (!window.ok()) return window.error();
    const Result<EstimatedPush> push = EstimatePush((*pendulums)[i], window.value(), options);
    if (!push.ok()) return push.error();
    recording.pushes = {push.value().push};
    recording.push_kind = push.value().kind;
    (*pendulums)[i] = MakePendulumRecording(recording);
  }
  return std::nullopt;
}

inline Result<Study> RunStudy(const StudyOptions& study) {
  Study done;

  // 1. Read recordings: joints in metres, gaps filled, masses and pushes from the manifest.
  LoadOptions with_joints;
  with_joints.keep_all_joints = true;  // for the bodies of step 8
  auto recordings = LoadRecordings(study.recordings, with_joints);
  if (!recordings.ok()) return recordings.error();

  // 2. Map skeletons to pendulums: q = [x, y, theta, phi] from hip and ankles
  //    (models/skeleton_mapping.h), which obey M(q) qdd + C(q, qd) + G(q) = F_net (LDP's
  //    supplement; models/ipm.h).
  std::vector<PendulumRecording> pendulums = MakePendulumRecordings(recordings.value());

  // 3. Take the recorded push, or estimate it: F = M (qd' - qd) / dt + C + G.
  if (auto error = EstimateMissingPushes(&recordings.value(), &pendulums)) return *error;

  // 4. Choose the model: F_net = push + friction + balance (models/self_terms.h) + interaction
  // (LDP,
  //    Eq. 10 and 11; models/interaction.h) + learned terms (LDP, Eq. 6 and 7;
  //    models/learned_terms.h), and which parameters are free.
  Result<FitOptions> options = MakeFitOptions(study.given, &pendulums);
  if (!options.ok()) return options.error();
  if (auto error = PrepareFit(pendulums, &options.value())) return *error;

  // 5. Fit with Ceres: residuals (predicted - recorded) / sigma of whole rollouts, exact
  //    derivatives, priors as residuals (residuals/rollout_residual.h).
  done.model.fit = Fit(pendulums, options.value());
  if (!done.model.fit.ok()) return Error{"the fit failed: " + done.model.fit.message};

  // 6. Judge: Fit has computed the covariance clustered by person (uncertainty/covariance.h), and
  //    the verdict from score tests of all that was taken as known (uncertainty/model_verdict.h).
  done.model.advice = Advise(done.model);

  // 7. Predict unseen pushes from the first frame and the push alone: hipADE and hipFDE beside
  //    baselines (prediction/evaluation.h).
  auto held_out = LoadRecordings(study.held_out, with_joints);
  if (!held_out.ok()) return held_out.error();
  const IdentifiedModel model = ModelOf(done.model.fit);
  done.evaluation = Evaluate(model, MakePendulumRecordings(held_out.value()));

  // 8. Restore whole bodies from predicted pendulums (models/restoration/restoration.h), and
  // report.
  const auto restoration = LoadRestoration(study.restoration);
  if (!restoration.ok()) return restoration.error();
  const auto bodies = MakeBodyRecordings(held_out.value());
  if (!bodies.ok()) return bodies.error();
  for (const BodyRecording& seen : bodies.value()) {
    const Prediction predicted = Predict(model, seen.pendulum);
    if (!predicted.status.ok) return Error{seen.pendulum.id + ": " + OutsideText(predicted.status)};
    done.bodies.push_back(
        RestoreBodies(*restoration.value(), {}, PredictedPeople(seen, predicted)));
  }
  if (study.page.empty()) return done;
  const Report report = BuildReport(done.model, held_out.value());
  if (auto error = WriteFileAtomically(study.page, ToPage(report))) return *error;
  return done;
}

}  // namespace pushid
