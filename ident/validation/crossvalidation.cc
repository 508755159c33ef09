#include "ident/validation/crossvalidation.h"

#include <Eigen/Core>
#include <algorithm>
#include <iterator>
#include <set>

#include "ident/fit/fit.h"
#include "ident/fit/step_probability.h"
#include "ident/observed/first_frames.h"
#include "models/decompositions.h"

namespace pushid {
namespace {

// Failures of all test recordings of a fold whose fit failed.
FoldPrediction WithoutFit(const std::vector<PendulumRecording>& recordings,
                          const std::vector<int>& test, const std::string& why) {
  FoldPrediction prediction;
  for (int i : test) {
    RecordingScore& failed = prediction.scores.emplace_back();
    failed.id = recordings[i].id;
    failed.frames = recordings[i].num_frames();
    failed.failure = "no fit without it: " + why;
  }
  return prediction;
}

constexpr double kRidgeStrength = 1.0;  // on standardized features

FoldPrediction ScoreTemplate(const std::vector<PendulumRecording>& recordings,
                             const std::vector<int>& train, const std::vector<int>& test) {
  // Computes the mean over the training recordings that have frame t, of one condition or (null) of
  // all; false if there are none.
  const auto displacement = [&](const std::string* condition, int t, Eigen::Vector3d* mean) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int count = 0;
    for (int i : train) {
      const PendulumRecording& r = recordings[i];
      if (t >= r.num_frames() || (condition && r.labels.condition() != *condition)) continue;
      const auto& hip = r.hip[r.pushed_person];
      sum += PushAxes(r).transpose() * (hip[t] - hip[0]);
      ++count;
    }
    if (count > 0) *mean = sum / count;
    return count > 0;
  };
  FoldPrediction prediction;
  for (int i : test) {
    const PendulumRecording& r = recordings[i];
    const std::string condition = r.labels.condition();
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();  // later than any training recording: the last
    const std::string* const among = displacement(&condition, 0, &mean) ? &condition : nullptr;
    HipPaths paths = StaticBaseline(r);  // bystanders stay where they are
    for (int t = 1; t < r.num_frames(); ++t) {
      displacement(among, t, &mean);
      paths[r.pushed_person][t] += PushAxes(r) * mean;
    }
    prediction.scores.push_back(ScoreHip(r, paths));
  }
  return prediction;
}

FoldPrediction ScoreRidge(const std::vector<PendulumRecording>& recordings,
                          const std::vector<int>& train, const std::vector<int>& test) {
  int longest = 0;
  for (const PendulumRecording& r : recordings) longest = std::max(longest, r.num_frames());
  auto features = [](const PendulumRecording& r) {
    const Body& body = r.scene.people[r.pushed_person].body;
    double impulse = 0.0, frames = 0.0;
    for (const ScenePush& push : r.scene.pushes) {
      impulse += push.mean[0] * static_cast<double>(push.force.size()) * r.scene.dt;
      frames += static_cast<double>(push.force.size());
    }
    return Eigen::Vector4d(body.mass, body.rod_length, impulse / body.mass, frames);
  };
  const int n = static_cast<int>(train.size());
  Eigen::MatrixXd x(n, 4), targets(n, 3 * longest);
  for (int i = 0; i < n; ++i) {
    const PendulumRecording& r = recordings[train[i]];
    x.row(i) = features(r).transpose();
    const auto& hip = r.hip[r.pushed_person];
    for (int t = 0; t < longest; ++t) {
      const Vector3<double>& at = hip[std::min<size_t>(t, hip.size() - 1)];
      targets.block<1, 3>(i, 3 * t) = (at - hip[0]).transpose();
    }
  }
  const Eigen::RowVector4d center = x.colwise().mean();
  x.rowwise() -= center;
  const Eigen::RowVector4d spread =
      (x.colwise().squaredNorm() / std::max(1, n - 1)).cwiseSqrt().cwiseMax(1e-9);
  x.array().rowwise() /= spread.array();
  const Eigen::RowVectorXd level = targets.colwise().mean();
  targets.rowwise() -= level;
  const Eigen::MatrixXd gram = x.transpose() * x + kRidgeStrength * Eigen::Matrix4d::Identity();
  const Eigen::MatrixXd weights = SolveSymmetric(gram, Eigen::MatrixXd(x.transpose() * targets));

  FoldPrediction prediction;
  for (int i : test) {
    const PendulumRecording& r = recordings[i];
    const Eigen::RowVector4d f = (features(r).transpose() - center).array() / spread.array();
    const Eigen::RowVectorXd move = level + f * weights;
    HipPaths paths = StaticBaseline(r);  // bystanders stay where they are
    for (int t = 0; t < r.num_frames(); ++t) {
      paths[r.pushed_person][t] += move.segment<3>(3 * t).transpose();
    }
    prediction.scores.push_back(ScoreHip(r, paths));
  }
  return prediction;
}

// Sums of each recording's scores over the folds that held it out, and their number.
struct Sums {
  std::vector<RecordingScore> scores;
  std::vector<int> counts;
};

// Sets each person's step probabilities from the held-out margins of all other people: margins of
// fitted recordings have smaller errors, and the person's own steps are to be predicted.
void PredictStepsWithoutThePerson(std::vector<RecordingScore>* scores) {
  std::vector<StepOutcome> all;
  std::set<std::string> people;
  for (const RecordingScore& score : *scores) {
    for (const StepPrediction& step : score.steps) {
      all.push_back({step.margin, step.stepped, step.person});
      people.insert(step.person);
    }
  }
  for (const std::string& person : people) {
    std::vector<StepOutcome> others;
    std::copy_if(all.begin(), all.end(), std::back_inserter(others),
                 [&](const StepOutcome& outcome) { return outcome.person != person; });
    const std::optional<StepProbability> fitted = FitStepProbability(others);
    for (RecordingScore& score : *scores) {
      for (StepPrediction& step : score.steps) {
        if (step.person == person && fitted) step.probability = fitted->At(step.margin);
      }
    }
  }
}

// Adds a fold to the result, and its scores to the sums.
void AddFold(const Fold& fold, const FoldPrediction& prediction, Sums* sums,
             CrossValidation* result) {
  FoldScore& of_fold = result->folds.emplace_back();
  of_fold.name = fold.name;
  of_fold.held_out = static_cast<int>(fold.held_out.size());
  of_fold.behaviour = prediction.behaviour;
  for (size_t k = 0; k < prediction.scores.size(); ++k) {
    const RecordingScore& score = prediction.scores[k];
    RecordingScore& sum = sums->scores[fold.held_out[k]];
    sum.id = score.id;
    sum.frames = score.frames;
    sum.fell = sum.fell || score.fell;
    of_fold.falls += score.fell;
    if (!score.failure.empty()) {
      ++of_fold.failures;
      sum.failure = score.failure;
      continue;
    }
    ++sums->counts[fold.held_out[k]];
    sum.value += score.value;
    of_fold.value += score.value;
    sum.propagation.Add(score.propagation);
    if (sum.steps.empty()) {
      sum.steps = score.steps;
    } else {
      for (size_t n = 0; n < score.steps.size(); ++n) sum.steps[n].margin += score.steps[n].margin;
    }
  }
  of_fold.value /= std::max(1, of_fold.held_out - of_fold.failures);
  result->failures += of_fold.failures;
  result->falls += of_fold.falls;
  if (!of_fold.behaviour) return;
  ++result->fits;
  result->settling += of_fold.behaviour->settles;
  for (const SettlingSimulation& d : of_fold.behaviour->simulations) {
    result->slowest_to_settle = std::max(result->slowest_to_settle, d.speed);
  }
}

// The summary of held-out recordings, each averaged over its folds.
ScoreSummary SummaryOf(const std::vector<PendulumRecording>& recordings, const Predictor& predictor,
                       Sums sums, const LabelKeys& group_by) {
  std::vector<PendulumRecording> held;
  std::vector<RecordingScore> means;
  for (size_t i = 0; i < recordings.size(); ++i) {
    RecordingScore& mean = sums.scores[i];
    if (sums.counts[i] == 0 && mean.failure.empty()) continue;  // never held out
    if (sums.counts[i] > 0) {
      mean.value /= sums.counts[i];
      mean.propagation.Divide(sums.counts[i]);
      for (StepPrediction& step : mean.steps) step.margin /= sums.counts[i];
    }
    if (!mean.failure.empty()) {
      mean.value = ScoreHip(recordings[i], StaticBaseline(recordings[i]), predictor.observed).value;
    }
    held.push_back(recordings[i]);
    means.push_back(mean);
  }
  PredictStepsWithoutThePerson(&means);
  return Summarize(held, means, predictor.observed, predictor.bands, group_by);
}

}  // namespace

Predictor ModelPredictor(const std::string& name, FitOptions options, int observed,
                         ForecastUse use) {
  const bool learns = observed > 0;
  options.num_threads = 1;  // the folds run in parallel
  const auto fit_and_score = [=](const std::vector<PendulumRecording>& recordings,
                                 const std::vector<int>& train, const std::vector<int>& test) {
    Result<IdentifiedModel> solved = SolveModel(Picked(recordings, train), options, learns);
    if (solved.ok() && learns && !solved.value().forecasts) {
      solved = Error{"no recording stays in the model's domain"};
    }
    if (!solved.ok()) return WithoutFit(recordings, test, solved.error().message);
    const IdentifiedModel& model = solved.value();
    FoldPrediction prediction;
    prediction.behaviour = model.behaviour;
    for (int i : test) {
      prediction.scores.push_back(ScoreModel(model, recordings[i], observed, use));
    }
    return prediction;
  };
  return {name, fit_and_score, observed, learns};
}

Predictor BandPredictor(const std::string& name, FitOptions options, const BandOptions& bands) {
  options.num_threads = 1;
  const auto fit_and_score = [=](const std::vector<PendulumRecording>& recordings,
                                 const std::vector<int>& train, const std::vector<int>& test) {
    const std::vector<PendulumRecording> training = Picked(recordings, train);
    FitOptions own = options;
    if (MaybeError error = PrepareFit(training, &own)) {
      return WithoutFit(recordings, test, error->message);
    }
    const FitResult result = Fit(training, own);
    if (!result.ok()) return WithoutFit(recordings, test, "it fails");
    const auto samples = SampleParameters(result, bands);
    const std::vector<ErrorPath> errors = ErrorPaths(result, training);
    const IdentifiedModel model = ModelOf(result);
    FoldPrediction prediction;
    prediction.behaviour = model.behaviour;
    for (int i : test) {
      prediction.scores.push_back(ScoreModel(model, recordings[i]));
      RecordingScore& score = prediction.scores.back();
      if (!score.failure.empty()) continue;
      ScoreDraws(recordings[i], PathsAround(result, samples, errors, recordings[i], bands.seed),
                 &score);
    }
    return prediction;
  };
  return {name, fit_and_score, 0, true};
}

Predictor BaselinePredictor(const Baseline& baseline, int observed) {
  const auto score = [predict = baseline.predict, observed](
                         const std::vector<PendulumRecording>& recordings, const std::vector<int>&,
                         const std::vector<int>& test) {
    FoldPrediction prediction;
    for (int i : test) {
      prediction.scores.push_back(
          ScoreHip(recordings[i], predict(recordings[i], observed), observed));
    }
    return prediction;
  };
  return {baseline.name, score, observed};
}

Predictor TemplatePredictor() { return {"template", ScoreTemplate}; }

Predictor RidgePredictor() { return {"ridge", ScoreRidge}; }

CrossValidation CrossValidate(const std::vector<PendulumRecording>& recordings,
                              const std::vector<Fold>& folds, const Predictor& predictor,
                              int num_threads, const JobProgress& progress,
                              const LabelKeys& group_by) {
  const int total = static_cast<int>(recordings.size());
  std::vector<FoldPrediction> predictions(folds.size());
  ParallelFor(
      static_cast<int>(folds.size()), num_threads,
      [&](int f) {
        predictions[f] = predictor.fit_and_score(recordings, Others(folds[f].held_out, total),
                                                 folds[f].held_out);
      },
      progress);
  CrossValidation result;
  result.predictor = predictor.name;
  Sums sums{std::vector<RecordingScore>(recordings.size()), std::vector<int>(recordings.size(), 0)};
  for (size_t f = 0; f < folds.size(); ++f) {
    AddFold(folds[f], predictions[f], &sums, &result);
  }
  result.summary = SummaryOf(recordings, predictor, std::move(sums), group_by);
  return result;
}

PairedDifference Compare(const CrossValidation& a, const CrossValidation& b) {
  PairedDifference difference;
  difference.observed = std::min(a.summary.observed, b.summary.observed);
  difference.a = a.predictor;
  difference.b = b.predictor;
  std::map<std::string, const RecordingScore*> of_a;
  for (const RecordingScore& score : a.summary.recordings) of_a[score.id] = &score;
  std::vector<Score> pairs;
  for (const RecordingScore& score : b.summary.recordings) {
    const auto found = of_a.find(score.id);
    if (found == of_a.end() || !score.failure.empty() || !found->second->failure.empty()) continue;
    pairs.push_back(score);
    pairs.back().value -= found->second->value;
  }
  ScoreList all;
  for (const Score& pair : pairs) all.push_back(&pair);
  static_cast<MeanScore&>(difference) = MeanOfScores(all);
  return difference;
}

}  // namespace pushid
