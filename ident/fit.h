// ident: the door. Everything that a fit needs, from a manifest to a report:
//
//   auto recordings = pushid::LoadRecordings("manifest.json", {});
//   auto pendulums = pushid::MakePendulumRecordings(recordings.value(), {});
//   pushid::FitOptions options =
//       pushid::MakePreset(pushid::PresetFor("auto", pendulums)).value();  // or "tail", ...
//   options.model.friction = pushid::FrictionKind::kAnisotropic;   // any field, or a parameter:
//   options.table[pushid::kKpTheta].nominal = 1200;                // where the fit starts
//   pushid::FreeTerms(&options);                                   // after a change of the terms
//   options.table[pushid::kMuY].free = true;                       // what no term frees
//   if (auto error = pushid::PrepareFit(pendulums, &options)) ...  // what is wrong, in words
//   pushid::FittedModel model{pushid::Fit(pendulums, options)};
//   std::cout << pushid::ReportText(model);
//   pushid::Prediction next = pushid::Predict(pushid::ModelOf(model.fit), pendulums[0]);
//
// Errors are values (datasets/files/error.h); nothing here prints, exits or throws.
#pragma once

#include "datasets/loading/load_recordings.h"
#include "datasets/loading/pendulum_recording.h"
#include "datasets/synthetic/synthetic_recordings.h"
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
#include "ident/report/report_text.h"
#include "residuals/autodiff_force_law.h"
