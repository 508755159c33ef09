#include "ident/prediction/propagation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "datasets/files/number_text.h"

namespace pushid {
namespace {

constexpr double kQuiet = 10.0;    // N
constexpr double kShortest = 0.1;  // s
constexpr double kStill = 0.05;    // m/s

// The forces along the push that are causes, N.
enum Series : int { kPushed, kOthers, kAnswer };
using CauseForces = std::array<double, 3>;

Cause CauseOf(const CauseForces& forces) {
  int largest = kPushed;
  for (int i : {kOthers, kAnswer}) {
    if (std::abs(forces[i]) > std::abs(forces[largest])) largest = i;
  }
  if (std::abs(forces[largest]) < kQuiet) return Cause::kNothing;
  if (largest == kPushed) return Cause::kPush;
  if (largest == kAnswer) return Cause::kOwn;
  return forces[kOthers] > 0.0 ? Cause::kFromBehind : Cause::kFromInFront;
}

// The series that shows a cause.
Series SeriesOf(Cause cause) {
  return cause == Cause::kPush ? kPushed : cause == Cause::kOwn ? kAnswer : kOthers;
}

// The cause of each frame. Runs of a cause that are shorter than kShortest take the cause before
// them; a series of such runs that lasts longer takes its own largest cause. A push counts however
// short it is.
std::vector<Cause> CausesOf(const std::vector<CauseForces>& forces, double dt) {
  std::vector<Cause> causes;
  for (const auto& frame : forces) causes.push_back(CauseOf(frame));
  const int frames = static_cast<int>(causes.size());
  const auto end_of_run = [&](int from) {
    int end = from;
    while (end < frames && causes[end] == causes[from]) ++end;
    return end;
  };
  for (int from = 0, to = 0; from < frames; from = to) {
    for (to = from; to < frames;) {
      const int end = end_of_run(to);
      if (causes[to] == Cause::kPush || (end - to) * dt >= kShortest) break;
      to = end;
    }
    if (to == from) {
      to = end_of_run(from);
      continue;
    }
    std::map<Cause, double> sums;
    for (int t = from; t < to; ++t) sums[causes[t]] += std::abs(forces[t][SeriesOf(causes[t])]);
    const auto most = std::max_element(
        sums.begin(), sums.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    const bool lasts = (to - from) * dt >= kShortest;
    const Cause cause = lasts || from == 0 ? most->first : causes[from - 1];
    std::fill(causes.begin() + from, causes.begin() + to, cause);
  }
  return causes;
}

// The nearest person behind (side -1) or in front (side 1) at a frame; empty where nobody stands.
std::string Neighbour(const PendulumRecording& recording, const Prediction& prediction, int person,
                      int frame, const Eigen::Vector2d& u, double side) {
  std::string name;
  double nearest = 0.0;
  const auto place = [&](int n) {
    return Eigen::Vector2d(prediction.path.At(frame, n).q.head<2>());
  };
  for (int n = 0; n < recording.scene.num_people(); ++n) {
    const Eigen::Vector2d way = place(n) - place(person);
    if (n == person || side * way.dot(u) <= 0.0) continue;
    if (!name.empty() && way.norm() >= nearest) continue;
    name = recording.subject_ids[n];
    nearest = way.norm();
  }
  return name;
}

std::string Words(const PendulumRecording& recording, const Prediction& prediction, int person,
                  const StoryMoment& moment, const Eigen::Vector2d& u) {
  const auto by = [&](double side) {
    const std::string name = Neighbour(recording, prediction, person, moment.from, u, side);
    return name.empty() ? "" : " by " + name;
  };
  const Eigen::Vector2d velocity = prediction.path.At(moment.from, person).qd.head<2>();
  const std::string forces =
      ", up to " + Rounded(moment.peak, 2) + " N (" + Rounded(moment.impulse, 2) + " N s)";
  switch (moment.cause) {
    case Cause::kNothing:
      return velocity.norm() < kStill ? "still" : "moves on without force";
    case Cause::kPush:
      return "pushed" + forces;
    case Cause::kFromBehind:
      return "pushed from behind" + by(-1.0) + forces;
    case Cause::kFromInFront:
      return "held up from in front" + by(1.0) + forces;
    case Cause::kOwn:
      return (moment.impulse * velocity.dot(u) < 0.0 ? "brakes" : "steps on") + forces;
  }
  return "";
}

using Vector2d = Eigen::Vector2d;

constexpr int kMinMovers = 3;     // for a speed
constexpr int kHalfVelocity = 3;  // frames on either side of a velocity: 2 mm of noise are 0.03 m/s

// People with their ranks and distances, still without onsets and momenta.
std::vector<PersonPropagation> RankedPeople(const PendulumRecording& recording) {
  const int people = recording.num_people();
  const Vector2d from = recording.scene.people[recording.pushed_person].start.q.head<2>();
  std::vector<PersonPropagation> ranked(people);
  for (int n = 0; n < people; ++n) {
    ranked[n].distance = (recording.scene.people[n].start.q.head<2>() - from).norm();
  }
  std::vector<int> order(people);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return ranked[a].distance < ranked[b].distance; });
  for (int rank = 0; rank < people; ++rank) ranked[order[rank]].rank = rank;
  return ranked;
}

// Persons by rank.
std::vector<int> ByRank(const std::vector<PersonPropagation>& people) {
  std::vector<int> order(people.size());
  for (size_t n = 0; n < people.size(); ++n) order[people[n].rank] = static_cast<int>(n);
  return order;
}

double PeakMomentum(const HipPath& hip, double mass, const Vector2d& along, double dt) {
  double peak = 0.0;
  const int frames = static_cast<int>(hip.size());
  for (int t = 0; t + 2 * kHalfVelocity < frames; ++t) {
    const Vector2d step = (hip[t + 2 * kHalfVelocity] - hip[t]).head<2>();
    peak = std::max(peak, mass * step.dot(along) / (2 * kHalfVelocity * dt));
  }
  return peak;
}

void AddOnset(const PersonPropagation& person, PropagationScore* score) {
  auto& f = score->figures;
  const int measured = person.onset_measured, predicted = person.onset_predicted;
  auto add = [&f](PropagationFigure figure, double value) {
    f[figure].sum += value;
    f[figure].weight += 1.0;
  };
  if (measured < 0) return add(kFalseMovers, predicted >= 0 ? 1.0 : 0.0);
  add(kMissedMovers, predicted < 0 ? 1.0 : 0.0);
  if (predicted < 0) return;
  add(kOnsetError, std::abs(predicted - measured));
  add(kOnsetBias, predicted - measured);
  if (person.rank > 0) add(kOnsetErrorReached, std::abs(predicted - measured));
}

void AddSpeed(double dt, PropagationScore* score) {
  const auto slowness = [&](int PersonPropagation::*onset) {
    std::vector<double> distance, time;
    for (const PersonPropagation& person : score->people) {
      if (person.*onset < 0) continue;
      distance.push_back(person.distance);
      time.push_back(person.*onset * dt);
    }
    return Slowness(distance, time);
  };
  const auto measured = slowness(&PersonPropagation::onset_measured);
  const auto predicted = slowness(&PersonPropagation::onset_predicted);
  auto& f = score->figures;
  if (measured) f[kSlownessMeasured] = {*measured, 1.0};
  if (predicted) f[kSlownessPredicted] = {*predicted, 1.0};
}

// v = sum s_r / sum w_r; its variance by linearization, n/(n-1) sum (s_r - v w_r)^2 / (sum w_r)^2.
PropagationMean RatioMean(const std::vector<const PropagationScore*>& scores, int figure) {
  PropagationMean mean;
  double sum = 0.0, recordings = 0.0;
  for (const PropagationScore* score : scores) {
    const Ratio& ratio = score->figures[figure];
    sum += ratio.sum;
    mean.weight += ratio.weight;
    recordings += ratio.weight > 0.0 ? 1.0 : 0.0;
  }
  if (!mean.known()) return mean;
  mean.value = sum / mean.weight;
  if (recordings < 2.0) return mean;
  double squares = 0.0;
  for (const PropagationScore* score : scores) {
    const Ratio& ratio = score->figures[figure];
    squares += std::pow(ratio.sum - mean.value * ratio.weight, 2);
  }
  mean.error = std::sqrt(recordings / (recordings - 1.0) * squares) / mean.weight;
  return mean;
}

}  // namespace

ForceStory StoryOf(const PendulumRecording& recording, const Prediction& prediction, int person) {
  const Eigen::Vector2d u = PushDirection(recording);
  ForceStory story{person, {}};
  std::vector<CauseForces> forces;
  for (int t = 0; t < prediction.path.num_frames(); ++t) {
    const NetForce<double>& force = prediction.forces.At(t, person);
    const auto along = [&](ForcePart part) { return force[part].head<2>().dot(u); };
    const double push = along(ForcePart::kPush) + along(ForcePart::kTail);
    const double others = along(ForcePart::kInteraction), net = force.Total().head<2>().dot(u);
    forces.push_back({push, others, net - push - others});
  }
  const double dt = recording.scene.dt;
  const std::vector<Cause> causes = CausesOf(forces, dt);
  for (int t = 0; t < static_cast<int>(causes.size()); ++t) {
    if (t == 0 || causes[t] != causes[t - 1]) story.moments.push_back({t, t, causes[t], 0, 0, ""});
    StoryMoment& moment = story.moments.back();
    const double force = forces[t][SeriesOf(causes[t])];
    moment.to = t + 1;
    moment.peak = std::max(moment.peak, std::abs(force));
    moment.impulse += dt * force;
  }
  for (StoryMoment& moment : story.moments) {
    moment.text = Words(recording, prediction, person, moment, u);
  }
  return story;
}

ForceStory RichestStory(const PendulumRecording& recording, const Prediction& prediction) {
  ForceStory richest;
  std::pair<size_t, double> most{0, 0.0};  // kinds of cause, then what others did
  for (int n = 0; n < recording.scene.num_people(); ++n) {
    const auto& pushes = recording.scene.pushes;
    const bool pushed = std::any_of(pushes.begin(), pushes.end(),
                                    [n](const ScenePush& push) { return push.person == n; });
    if (pushed) continue;
    ForceStory story = StoryOf(recording, prediction, n);
    std::set<Cause> causes;
    double by_others = 0.0;
    for (const StoryMoment& moment : story.moments) {
      causes.insert(moment.cause);
      const bool others = moment.cause == Cause::kFromBehind || moment.cause == Cause::kFromInFront;
      if (others) by_others += std::abs(moment.impulse);
    }
    const std::pair<size_t, double> has{causes.size(), by_others};
    if (richest.person >= 0 && has <= most) continue;
    most = has;
    richest = std::move(story);
  }
  return richest;
}

std::string StoryText(const PendulumRecording& recording, const ForceStory& story) {
  if (story.person < 0) return "";
  std::string text = recording.subject_ids[story.person] + ":";
  for (size_t i = 0; i < story.moments.size(); ++i) {
    text += (i > 0 ? "; " : " ") + Rounded(story.moments[i].from * recording.scene.dt, 3) + " s " +
            story.moments[i].text;
  }
  return text;
}

ContactEnergyBalance BalanceContactEnergy(const RolloutPath<double>& path,
                                          const ForceTrace& forces) {
  ContactEnergyBalance balance;
  for (int t = 0; t + 1 < path.num_frames(); ++t) {
    double total = 0.0;
    for (int n = 0; n < path.num_people(); ++n) {
      const Vector4<double> step = path.At(t + 1, n).q - path.At(t, n).q;
      const Vector4<double>& now = forces.At(t, n)[ForcePart::kInteraction];
      total += 0.5 * (now + forces.At(t + 1, n)[ForcePart::kInteraction]).dot(step);
    }
    (total < 0.0 ? balance.absorbed : balance.returned) += std::abs(total);
  }
  return balance;
}

int OnsetFrame(const HipPath& hip) {
  for (size_t t = 0; t < hip.size(); ++t) {
    if ((hip[t] - hip[0]).head<2>().norm() >= kOnsetDistance) return static_cast<int>(t);
  }
  return -1;
}

std::optional<double> Slowness(const std::vector<double>& distance_m,
                               const std::vector<double>& onset_s) {
  const double n = static_cast<double>(distance_m.size());
  if (distance_m.size() < kMinMovers) return std::nullopt;
  const double s_mean = std::accumulate(distance_m.begin(), distance_m.end(), 0.0) / n;
  const double t_mean = std::accumulate(onset_s.begin(), onset_s.end(), 0.0) / n;
  double ss = 0.0, st = 0.0;
  for (size_t i = 0; i < distance_m.size(); ++i) {
    ss += (distance_m[i] - s_mean) * (distance_m[i] - s_mean);
    st += (distance_m[i] - s_mean) * (onset_s[i] - t_mean);
  }
  if (ss < 1e-6 * n) return std::nullopt;  // within a millimetre: no line
  return st / ss;
}

void PropagationScore::Add(const PropagationScore& other) {
  for (int i = 0; i < kNumPropagationFigures; ++i) {
    figures[i].sum += other.figures[i].sum;
    figures[i].weight += other.figures[i].weight;
  }
}

void PropagationScore::Divide(double by) {
  for (Ratio& ratio : figures) ratio = {ratio.sum / by, ratio.weight / by};
}

PropagationScore ScorePropagation(const PendulumRecording& recording, const HipPaths& predicted) {
  PropagationScore score;
  if (recording.scene.num_people() < 2) return score;
  const Vector2d along = PushDirection(recording);
  const double dt = recording.scene.dt;
  score.people = RankedPeople(recording);
  for (int n = 0; n < recording.num_people(); ++n) {
    PersonPropagation& person = score.people[n];
    const double mass = recording.scene.people[n].body.mass;
    person.onset_measured = OnsetFrame(recording.hip[n]);
    person.onset_predicted = OnsetFrame(predicted[n]);
    person.peak_momentum_measured = PeakMomentum(recording.hip[n], mass, along, dt);
    person.peak_momentum_predicted = PeakMomentum(predicted[n], mass, along, dt);
    AddOnset(person, &score);
  }
  AddSpeed(dt, &score);
  const std::vector<int> order = ByRank(score.people);
  for (size_t k = 1; k < order.size(); ++k) {
    const PersonPropagation &before = score.people[order[k - 1]], &now = score.people[order[k]];
    score.figures[kMomentumMeasured].sum += now.peak_momentum_measured;
    score.figures[kMomentumMeasured].weight += before.peak_momentum_measured;
    score.figures[kMomentumPredicted].sum += now.peak_momentum_predicted;
    score.figures[kMomentumPredicted].weight += before.peak_momentum_predicted;
  }
  return score;
}

void AddContactFigures(const IdentifiedModel& model, const Prediction& prediction,
                       PropagationScore* score) {
  if (score->people.empty() || !model.options.interaction.Any()) return;
  const ContactEnergyBalance balance = BalanceContactEnergy(prediction.path, prediction.forces);
  auto& f = score->figures;
  f[kContactWork] = {balance.TotalWork(), 1.0};
  // Restitution is of mutual contact alone: LDP's terms and networks push without taking anything
  // first.
  if (model.options.interaction.Mutual()) f[kRestitution] = {balance.returned, balance.absorbed};
}

PropagationSummary SummarizePropagation(const std::vector<const PropagationScore*>& scores) {
  PropagationSummary summary;
  for (const PropagationScore* score : scores) {
    const Ratio &missed = score->figures[kMissedMovers], &moved = score->figures[kFalseMovers];
    if (missed.weight + moved.weight <= 0.0) continue;  // a single person
    ++summary.recordings;
    summary.movers += missed.weight;
    summary.missed_movers += missed.sum;
    summary.bystanders += moved.weight;
    summary.false_movers += moved.sum;
  }
  for (int i = 0; i < kNumPropagationFigures; ++i) summary.figures[i] = RatioMean(scores, i);
  return summary;
}

std::optional<PropagationMean> Speed(const PropagationMean& slowness) {
  if (!slowness.known() || !(slowness.value > 0.0)) return std::nullopt;
  PropagationMean speed = slowness;
  speed.value = 1.0 / slowness.value;
  speed.error = slowness.error / (slowness.value * slowness.value);
  return speed;
}

}  // namespace pushid
