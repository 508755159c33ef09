#include "ident/prediction/predicted_steps.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/fit/step_probability.h"
#include "ident/problem/statistics.h"

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
    text += recording.subject_ids[n] + ": " + Joined(parts) + "\n";
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
  return (static_cast<double>(left_out.size()) - 1.0) * MeanOf(left_out).error;
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
    fifth.predicted /= fifth.tracks;
    fifth.observed /= fifth.tracks;
  }
  return fifths;
}

LiftOffError LiftOffErrorOf(const std::vector<StepPrediction>& predictions) {
  std::vector<double> errors;
  LiftOffError result;
  for (const StepPrediction& p : predictions) {
    if (!p.timing) continue;
    if (p.timing->lift_off && p.timing->recorded_lift_off) {
      errors.push_back(*p.timing->lift_off - *p.timing->recorded_lift_off);
      result.mean_absolute += std::abs(errors.back());
    }
    if (p.timing->landing && p.timing->recorded_travel) {
      ++result.landed;
      result.place += (p.timing->travel - *p.timing->recorded_travel).norm();
    }
  }
  if (errors.empty()) return {};
  result.people = static_cast<int>(errors.size());
  result.mean_absolute /= result.people;
  result.median = Median(errors);
  if (result.landed > 0) result.place /= result.landed;
  return result;
}

constexpr int kFewForAuc = 3;

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

std::string StepProbabilityText(const StepProbability& p) {
  const double a = p.coefficients[0], b = p.coefficients[1];
  std::string text = "P(step) = 1 / (1 + exp(-(" + Rounded(a, 3) + " + " + Rounded(b, 3) +
                     " margin))), margin in m: how much larger the feet's support in front might "
                     "be, and the person "
                     "would just step (negative: smaller); errors +- " +
                     Rounded(std::sqrt(p.covariance(0, 0)), 2) + " and +- " +
                     Rounded(std::sqrt(p.covariance(1, 1)), 2) + " clustered by " +
                     std::to_string(p.clusters) + " people, of " + std::to_string(p.tracks) +
                     " tracks with " + std::to_string(p.stepped) + " who step";
  if (b > 0.0) text += "; half of all people step at a margin of " + Rounded(-a / b, 2) + " m";
  return text + ".";
}

std::string StepScoresText(NamedValues<StepScore> scores) {
  scores.erase(std::remove_if(scores.begin(), scores.end(),
                              [](const auto& score) { return !score.second->known(); }),
               scores.end());
  if (scores.empty()) return "";
  size_t fifths = 0;
  int people = 0;
  bool feet_step = false;
  for (const auto& [name, score] : scores) {
    fifths = std::max(fifths, score->fifths.size());
    people = std::max(people, score->people);
    feet_step = feet_step || score->lift_off.people > 0;
  }
  ColumnTable<StepScore> table("who steps", std::move(scores));
  table.Add("tracks with a step / tracks", [](const StepScore& s) {
    return std::to_string(s.stepped) + " / " + std::to_string(s.tracks);
  });
  // The AUC of very few people who step, or who do not, depends on who stands where.
  table.Add("AUC", [](const StepScore& s) {
    return std::min(s.stepped, s.tracks - s.stepped) < kFewForAuc ? std::string("- (too few)")
                                                                  : WithError(s.auc, s.auc_error);
  });
  table.Add("Brier score", [](const StepScore& s) { return WithError(s.brier, s.brier_error); });
  for (size_t i = 0; i < fifths; ++i) {
    const std::string title = "fifth " + std::to_string(i + 1) + " of P(step): mean -> share";
    table.Add(title, [i](const StepScore& s) {
      return i >= s.fifths.size()
                 ? std::string()
                 : Rounded(s.fifths[i].predicted, 2) + " -> " + Rounded(s.fifths[i].observed, 2);
    });
  }
  if (feet_step) {
    // "+0.05 s, mean |.| 0.11 s, 23 people; place off by 0.14 m"
    table.Add("first lift-off, predicted - recorded: median", [](const StepScore& s) {
      const LiftOffError& error = s.lift_off;
      if (error.people == 0) return std::string();
      return (error.median > 0.0 ? "+" : "") + Rounded(error.median, 2) + " s, mean |.| " +
             Rounded(error.mean_absolute, 2) + " s, " + std::to_string(error.people) + " people" +
             (error.landed > 0 ? "; place off by " + Rounded(error.place, 2) + " m" : "");
    });
  }
  return table.ToString() + "+-: standard errors by leaving out each of " + std::to_string(people) +
         " people\n";
}

}  // namespace pushid
