#include "ident/checks/model_checks.h"

#include <algorithm>

#include "datasets/files/names.h"
#include "ident/fit/fit.h"
#include "ident/problem/behaviour.h"
#include "ident/problem/fit_problem.h"
#include "ident/report/advice.h"
#include "ident/report/report_text.h"
#include "ident/solver/solver.h"
#include "ident/validation/experiment_design.h"

namespace pushid {
namespace {

Error NotAsFitted(const std::string& id, const std::string& what) {
  return Error{"recording " + id + " " + what};
}

void ClassifyByDataAlone(const FitProblem& with, const FitPoint& estimate,
                         const std::vector<std::string>& names, int num_threads,
                         const JobProgress& progress, std::vector<Profile>* profiles) {
  FitOptions options = with.options();  // without what was put in beside the recordings
  for (ParameterSpec& spec : options.table.specs) spec.prior.reset();
  options.settling_weight = 0.0;
  const FitProblem alone(with.recordings(), options);
  const double put_in = CostAt(with.WithoutRecordings(), estimate);
  if (CostAt(alone.WithoutRecordings(), estimate) == put_in) return;
  const SolveStart refit = Refit(alone, estimate);
  if (!refit.usable) return;
  const auto found = ComputeProfiles(alone, refit.to, ComputeUncertainty(alone, refit.to), names,
                                     num_threads, progress, true);
  if (!found.ok()) return;
  for (size_t i = 0; i < profiles->size(); ++i) {
    (*profiles)[i].by_data_alone = found.value()[i].classification;
  }
}

}  // namespace

MaybeError CheckNumbers(const ModelChecks& checks) {
  if (checks.bootstrap.replicas < 0 || checks.bootstrap.replicas == 1) {
    return Error{"--bootstrap must be 0 (none) or at least 2 replicas"};
  }
  return std::nullopt;
}

MaybeError CheckAgainst(const ModelChecks& checks, const FitOptions& options,
                        const std::vector<PendulumRecording>& recordings) {
  const bool bootstrap = checks.bootstrap.replicas > 0;
  if (bootstrap && recordings.size() < 2) {
    return Error{"--bootstrap draws people or recordings with replacement; it needs at least two"};
  }
  // A model that was trained by its gradient, or will be: its file holds the network.
  const bool large = IsLarge(options);
  if (checks.horizon_check && (large || options.likelihood != Likelihood::kTrajectory)) {
    return Error{
        "--horizon_check compares rollouts of many lengths: leave --likelihood out, and choose a "
        "network that is small enough to be refitted (not trained by its gradient)"};
  }
  if (checks.design.empty() || checks.design == "all") return std::nullopt;
  std::string known = "all";
  for (Parameter id : options.table.Free()) {
    known += ", " + options.table[id].name;
    if (options.table[id].name == checks.design) return std::nullopt;
  }
  return Error{"--design: '" + checks.design + "' has no standard error to reduce; choose from " +
               known};
}

Result<std::vector<PendulumRecording>> AsFitted(const std::vector<PendulumRecording>& given,
                                                const FitResult& fit) {
  const auto same_id = [](const std::string& id) {
    return [&id](const auto& recording) { return recording.id == id; };
  };
  for (const PendulumRecording& recording : given) {
    const auto fitted =
        std::find_if(fit.recordings.begin(), fit.recordings.end(), same_id(recording.id));
    if (fitted != fit.recordings.end()) continue;
    return NotAsFitted(recording.id,
                       "is none of those that the model was fitted to; leave --setting and --ids "
                       "out, so that the model's own are taken, or fit again with it");
  }
  std::vector<PendulumRecording> recordings;
  for (const FittedRecording& fitted : fit.recordings) {
    const auto found = std::find_if(given.begin(), given.end(), same_id(fitted.id));
    if (found == given.end()) {
      return NotAsFitted(fitted.id,
                         "is missing, and the model was fitted to it; leave --setting, --ids and "
                         "--leave_out out, so that all of the model's are taken");
    }
    if (found->content_hash != fitted.content_hash || found->num_frames() != fitted.frames) {
      return NotAsFitted(fitted.id,
                         "is not what the model was fitted to: its files, its entry in the "
                         "manifest or the way it is loaded have changed since; give the fit's "
                         "recordings, or fit them again");
    }
    recordings.push_back(*found);
  }
  return recordings;
}

MaybeError ResumeFit(const std::vector<PendulumRecording>& recordings, FitResult* fit) {
  // The reader holds what is learned; a fit holds only what was trained by its gradient.
  fit->options.hold_network = IsLarge(fit->options);
  SolveStart& best = fit->Best();
  const FitProblem problem(recordings, fit->options);
  std::optional<FitPoint> point = problem.PointAt(best.to.Flat());
  if (!point) {
    return Error{
        "the model has other units or initial velocities than its recordings ask for; fit again"};
  }
  best.to = std::move(*point);
  return std::nullopt;
}

MaybeError AddChecks(const std::vector<PendulumRecording>& recordings, const ModelChecks& checks,
                     const std::function<JobProgress(const std::string&)>& progress,
                     FittedModel* model) {
  if (!checks.profile.empty()) {
    std::vector<std::string> names;  // none: all
    if (checks.profile != "all") names = SplitList(checks.profile);
    if (MaybeError error =
            AddProfiles(recordings, names, checks.num_threads, progress("profile"), model)) {
      return Error{"--profile: " + error->ToString()};
    }
  }
  if (checks.bootstrap.replicas > 0) {
    if (MaybeError error =
            AddBootstrap(recordings, checks.bootstrap, progress("bootstrap draw"), model)) {
      return *error;
    }
  }
  if (checks.horizon_check) {
    AddHorizonCheck(recordings, checks.num_threads, progress("horizon"), model);
  }
  if (checks.learn_forecasts) {
    if (MaybeError error = AddForecasts(recordings, checks.num_threads, model)) {
      return Error{"--learn_forecasts: " + error->ToString()};
    }
  }
  model->advice = Advise(*model);
  return std::nullopt;
}

Result<Screen> CheckScreen(const std::vector<PendulumRecording>& recordings,
                           const ModelChecks& checks, const FittedModel& model) {
  Screen screen = ScreenOf(model);
  screen.verdict.clear(), screen.tables.clear(), screen.paragraphs.clear();
  if (checks.bootstrap.replicas > 0 && model.bootstrap) {
    screen.verdict = Capitalized(ResamplingText(*model.bootstrap)) + ".";
  }
  if (!checks.profile.empty() || checks.bootstrap.replicas > 0) {
    screen.tables = {IntervalTable(model)};
  }
  if (checks.horizon_check && model.horizon_check) {
    screen.paragraphs.push_back(DriftText(*model.horizon_check));
  }
  if (checks.learn_forecasts && model.fit.forecasts) {
    screen.paragraphs.push_back(ForecastText(*model.fit.forecasts));
  }
  if (checks.design.empty()) return screen;
  Result<ExperimentDesign> design = DesignExperiments(recordings, model.fit);
  const Result<std::string> text = DesignText(checks.design, &design);
  if (!text.ok()) return Error{"--design: " + text.error().message};
  screen.paragraphs.push_back(text.value());
  return screen;
}

MaybeError AddProfiles(const std::vector<PendulumRecording>& recordings,
                       const std::vector<std::string>& names, int num_threads,
                       const JobProgress& progress, FittedModel* model) {
  const FitProblem problem(recordings, model->fit.options);
  Result<std::vector<Profile>> profiles = ComputeProfiles(
      problem, model->fit.Best().to, model->fit.uncertainty, names, num_threads, progress);
  if (!profiles.ok()) return profiles.error();
  ClassifyByDataAlone(problem, model->fit.Best().to, names, num_threads, progress,
                      &profiles.value());
  model->profiles = std::move(profiles.value());
  return std::nullopt;
}

MaybeError AddBootstrap(const std::vector<PendulumRecording>& recordings,
                        const BootstrapOptions& options, const JobProgress& progress,
                        FittedModel* model) {
  const FitProblem problem(recordings, model->fit.options);
  Result<Bootstrap> bootstrap = ComputeBootstrap(problem, model->fit.Best().to, options, progress);
  if (!bootstrap.ok()) return bootstrap.error();
  model->bootstrap = std::move(bootstrap.value());
  return std::nullopt;
}

MaybeError AddForecasts(const std::vector<PendulumRecording>& recordings, int num_threads,
                        FittedModel* model) {
  FitResult& fit = model->fit;
  const FitProblem problem(recordings, fit.options);
  const FitPoint& optimum = fit.Best().to;
  const IdentifiedModel fitted = ModelOf(fit);
  fit.forecasts = LearnForecasts(fitted, recordings,
                                 CrossFit(problem, optimum, fitted, num_threads), num_threads);
  if (fit.forecasts) return std::nullopt;
  return Error{"no recording stays in the model's domain"};
}

void AddHorizonCheck(const std::vector<PendulumRecording>& recordings, int num_threads,
                     const JobProgress& progress, FittedModel* model) {
  const FitProblem problem(recordings, model->fit.options);
  model->horizon_check =
      CheckHorizons(problem, model->fit.Best().to, model->fit.uncertainty, num_threads, progress);
}

}  // namespace pushid
