// ident: steps of a path, and how well they are predicted.
#include "ident/prediction/predicted_steps.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "datasets/files/number_text.h"
#include "ident/fit/step_probability.h"
#include "ident/problem/statistics.h"
#include "models/rollout.h"

namespace pushid {

Eigen::Vector2d PlaceOf(Foot foot, const PendulumState<double>& state) {
  return state.q.head<2>() + (foot == Foot::kLeft ? 0.5 : -0.5) * state.feet.apart;
}

std::vector<FootStep> PredictedSteps(const RolloutPath<double>& path, int person) {
  std::vector<FootStep> steps;
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  for (int t = 0; t < path.num_frames(); ++t) {
    const PendulumState<double>& state = path.At(t, person);
    const bool flies = state.feet.swings != 0, flew = !steps.empty() && !steps.back().finished;
    if (flies && !flew) {
      const Foot foot = state.feet.swings > 0 ? Foot::kLeft : Foot::kRight;
      steps.push_back({foot, t, t, false, Eigen::Vector2d::Zero()});
      from = PlaceOf(foot, path.At(std::max(t - 1, 0), person));
    }
    if (!flies && !flew) continue;
    FootStep& step = steps.back();
    step.finished = !flies;
    step.landing = flies ? path.num_frames() : t;
    step.travel = PlaceOf(step.foot, state) - from;
  }
  return steps;
}

std::vector<Footprint> Footprints(const PendulumState<double>& start,
                                  const std::vector<FootStep>& steps, int num_frames) {
  std::vector<Footprint> prints;
  for (Foot foot : kFeet) {
    Footprint print{foot, 0, num_frames, PlaceOf(foot, start)};
    for (const FootStep& step : steps) {
      if (step.foot != foot) continue;
      print.lift_off = step.lift_off;
      if (print.landing < print.lift_off) prints.push_back(print);
      print = {foot, step.finished ? step.landing : num_frames, num_frames,
               print.place + step.travel};
    }
    if (print.landing < num_frames) prints.push_back(print);
  }
  std::stable_sort(prints.begin(), prints.end(),
                   [](const Footprint& a, const Footprint& b) { return a.landing < b.landing; });
  return prints;
}

FootprintsOfPeople RecordedFootprints(const PendulumRecording& recording) {
  FootprintsOfPeople people;
  for (size_t n = 0; n < recording.steps.size() && !recording.scene.ground.moves(); ++n) {
    people.push_back(Footprints(recording.scene.people[n].start, recording.steps[n].steps,
                                recording.num_frames()));
  }
  return people;
}

FootprintsOfPeople PredictedFootprints(const PendulumRecording& recording,
                                       const Prediction& prediction) {
  FootprintsOfPeople people;
  const bool from_frame_0 = prediction.observed <= 1;
  if (!prediction.feet_step || !from_frame_0 || recording.scene.ground.moves()) return people;
  for (int n = 0; n < prediction.path.num_people(); ++n) {
    people.push_back(Footprints(prediction.path.At(0, n), PredictedSteps(prediction.path, n),
                                prediction.path.num_frames()));
  }
  return people;
}

std::vector<Eigen::Vector2d> CapturePath(const std::vector<Vector3<double>>& hip, double rod_length,
                                         double dt) {
  const int last = static_cast<int>(hip.size()) - 1;
  const int wing = std::max(1, static_cast<int>(std::lround(0.05 / dt)));
  const double omega = std::sqrt(kGravity / rod_length);
  std::vector<Eigen::Vector2d> path;
  for (int t = 0; t <= last; ++t) {
    const int from = std::max(0, t - wing), to = std::min(last, t + wing);
    const Vector3<double> way = hip[to] - hip[from];
    path.emplace_back((hip[t] + way / (omega * std::max(1, to - from) * dt)).head<2>());
  }
  return path;
}

std::string PredictedStepsText(const PendulumRecording& recording, const Prediction& prediction) {
  std::string text;
  for (int n = 0; n < prediction.path.num_people(); ++n) {
    std::vector<std::string> parts;
    if (!prediction.steps.empty()) {
      parts.push_back("P(step) " + Rounded(prediction.steps[n].probability, 2));
    }
    if (prediction.feet_step) {
      PersonSteps steps;
      steps.steps = PredictedSteps(prediction.path, n);
      parts.push_back(steps.Stepped() ? "steps " + StepsText(steps, 1.0 / recording.scene.dt)
                                      : "stands");
    }
    if (parts.empty()) continue;
    text += recording.subject_ids[n] + ": ";
    for (size_t i = 0; i < parts.size(); ++i) text += (i > 0 ? ", " : "") + parts[i];
    text += "\n";
  }
  if (prediction.feet_step && prediction.path.num_people() > kMostPeopleWithMargins) {
    text += "P(step) is left out: it is computed for at most " +
            std::to_string(kMostPeopleWithMargins) + " people\n";
  }
  return text;
}

namespace {

constexpr int kFifths = 5;

double Brier(const std::vector<StepPrediction>& predictions) {
  double sum = 0.0;
  for (const StepPrediction& p : predictions) {
    const double error = p.probability - (p.stepped ? 1.0 : 0.0);
    sum += error * error;
  }
  return predictions.empty() ? 0.0 : sum / static_cast<double>(predictions.size());
}

// Mann and Whitney's count, ties by half.
double AreaUnderCurve(const std::vector<StepPrediction>& predictions) {
  double wins = 0.0, pairs = 0.0;
  for (const StepPrediction& a : predictions) {
    if (!a.stepped) continue;
    for (const StepPrediction& b : predictions) {
      if (b.stepped) continue;
      pairs += 1.0;
      wins += a.probability > b.probability ? 1.0 : a.probability == b.probability ? 0.5 : 0.0;
    }
  }
  return pairs > 0.0 ? wins / pairs : 0.5;
}

double JackknifeError(const std::vector<StepPrediction>& predictions,
                      const std::set<std::string>& people,
                      const std::function<double(const std::vector<StepPrediction>&)>& score) {
  std::vector<double> left_out;
  for (const std::string& person : people) {
    std::vector<StepPrediction> others;
    for (const StepPrediction& p : predictions) {
      if (p.person != person) others.push_back(p);
    }
    left_out.push_back(score(others));
  }
  const double n = static_cast<double>(left_out.size());
  if (n < 2.0) return 0.0;
  double mean = 0.0, sum = 0.0;
  for (double value : left_out) mean += value / n;
  for (double value : left_out) sum += (value - mean) * (value - mean);
  return std::sqrt((n - 1.0) / n * sum);
}

std::vector<StepFifth> Fifths(std::vector<StepPrediction> predictions) {
  std::stable_sort(predictions.begin(), predictions.end(),
                   [](const auto& a, const auto& b) { return a.probability < b.probability; });
  const size_t total = predictions.size();
  const size_t groups = std::clamp<size_t>(total / 2, 1, kFifths);
  std::vector<StepFifth> fifths(groups);
  for (size_t i = 0; i < total; ++i) {
    StepFifth& fifth = fifths[i * groups / total];
    ++fifth.tracks;
    fifth.predicted += predictions[i].probability;
    fifth.observed += predictions[i].stepped ? 1.0 : 0.0;
  }
  for (StepFifth& fifth : fifths) {
    if (fifth.tracks == 0) continue;
    fifth.predicted /= fifth.tracks;
    fifth.observed /= fifth.tracks;
  }
  return fifths;
}

LiftOffError LiftOffErrorOf(const std::vector<StepPrediction>& predictions) {
  std::vector<double> errors;
  LiftOffError result;
  for (const StepPrediction& p : predictions) {
    if (!p.timing || !p.timing->lift_off || !p.timing->recorded_lift_off) continue;
    errors.push_back(*p.timing->lift_off - *p.timing->recorded_lift_off);
    result.mean_absolute += std::abs(errors.back());
  }
  if (errors.empty()) return result;
  result.people = static_cast<int>(errors.size());
  result.mean_absolute /= result.people;
  result.median = Median(errors);
  for (const StepPrediction& p : predictions) {
    if (!p.timing || !p.timing->landing || !p.timing->recorded_travel) continue;
    ++result.landed;
    result.place += (p.timing->travel - *p.timing->recorded_travel).norm();
  }
  if (result.landed > 0) result.place /= result.landed;
  return result;
}

}  // namespace

StepScore ScoreSteps(const std::vector<StepPrediction>& predictions) {
  StepScore score;
  score.tracks = static_cast<int>(predictions.size());
  if (predictions.empty()) return score;
  std::set<std::string> people;
  for (const StepPrediction& p : predictions) {
    score.stepped += p.stepped ? 1 : 0;
    people.insert(p.person);
  }
  score.people = static_cast<int>(people.size());
  score.brier = Brier(predictions);
  score.auc = AreaUnderCurve(predictions);
  score.brier_error = JackknifeError(predictions, people, Brier);
  score.auc_error = JackknifeError(predictions, people, AreaUnderCurve);
  score.fifths = Fifths(predictions);
  score.lift_off = LiftOffErrorOf(predictions);
  return score;
}

}  // namespace pushid
