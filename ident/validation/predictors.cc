// ident: the model, the baselines and the ridge baseline.
#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "ident/fit/fit.h"
#include "ident/observed/recording_filter.h"
#include "ident/validation/crossvalidation.h"
#include "models/decompositions.h"

namespace pushid {

namespace {

constexpr double kRidgeStrength = 1.0;  // on standardized features

FoldPrediction ScoreTemplate(const std::vector<PendulumRecording>& recordings,
                             const std::vector<int>& train, const std::vector<int>& test) {
  // The mean over training recordings that last so long, of one condition or of all; whether any
  // do.
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
    for (auto& path : paths) path.resize(r.num_frames());
    prediction.scores.push_back(ScoreHip(r, paths));
  }
  return prediction;
}

}  // namespace

Predictor ModelPredictor(const std::string& name, FitOptions options, int observed, FramesUse use,
                         ForecastUse forecast) {
  const bool bands = observed > 0 && use == FramesUse::kForecast;
  options.num_threads = 1;  // the folds run in parallel
  const auto fit_and_score = [=](const std::vector<PendulumRecording>& recordings,
                                 const std::vector<int>& train, const std::vector<int>& test) {
    Result<IdentifiedModel> solved = SolveModel(Picked(recordings, train), options, bands);
    if (solved.ok() && bands && !solved.value().forecasts) {
      solved = Error{"no recording stays in the model's domain"};
    }
    FoldPrediction prediction;
    if (solved.ok()) prediction.behaviour = solved.value().behaviour;
    for (int i : test) {
      if (!solved.ok()) {
        RecordingScore failed;
        failed.id = recordings[i].id;
        failed.frames = recordings[i].num_frames();
        failed.failure = "no fit without it: " + solved.error().message;
        prediction.scores.push_back(failed);
        continue;
      }
      const IdentifiedModel& model = solved.value();
      prediction.scores.push_back(use == FramesUse::kReanchored
                                      ? ScoreReanchored(model, recordings[i], observed)
                                      : ScoreModel(model, recordings[i], observed, forecast));
      prediction.scores.back().fell_harder = FallsWhenPushedHarder(model, recordings[i]);
    }
    return prediction;
  };
  return {name, fit_and_score, observed, bands};
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

}  // namespace pushid
