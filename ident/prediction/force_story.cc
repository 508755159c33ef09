// ident: frames to causes, causes to moments, moments to words.
#include "ident/prediction/force_story.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "datasets/files/number_text.h"

namespace pushid {
namespace {

constexpr double kQuiet = 10.0;    // N
constexpr double kShortest = 0.1;  // s
constexpr double kStill = 0.05;    // m/s

enum Series : int { kPushed, kOthers, kAnswer, kNet };

std::array<double, 4> ForcesAlong(const NetForce<double>& force, const Eigen::Vector2d& u) {
  const auto along = [&](ForcePart part) { return force[part].head<2>().dot(u); };
  const double push = along(ForcePart::kPush) + along(ForcePart::kTail);
  const double others = along(ForcePart::kInteraction), net = force.Total().head<2>().dot(u);
  return {push, others, net - push - others, net};
}

Cause CauseOf(const std::array<double, 4>& forces) {
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

// Frames of one cause, one after the other.
std::vector<StoryMoment> Runs(const ForceStory& story) {
  std::vector<StoryMoment> runs;
  for (int t = 0; t < static_cast<int>(story.forces.size()); ++t) {
    const Cause cause = CauseOf(story.forces[t]);
    if (runs.empty() || runs.back().cause != cause) runs.push_back({t, t, cause, 0, 0, ""});
    runs.back().to = t + 1;
  }
  return runs;
}

// The cause of which a series of short runs has most.
Cause DominantCause(const ForceStory& story, const std::vector<StoryMoment>& runs) {
  std::map<Cause, double> sums;
  for (const StoryMoment& run : runs) {
    for (int t = run.from; t < run.to; ++t) {
      sums[run.cause] += std::abs(story.forces[t][SeriesOf(run.cause)]);
    }
  }
  return std::max_element(
             sums.begin(), sums.end(),
             [](const auto& one, const auto& other) { return one.second < other.second; })
      ->first;
}

void Append(const StoryMoment& moment, std::vector<StoryMoment>* moments) {
  if (!moments->empty() && moments->back().cause == moment.cause) {
    moments->back().to = moment.to;
  } else {
    moments->push_back(moment);
  }
}

// Runs of a cause; short ones belong to what was before unless a series of them lasts. A push is
// told however short it is.
std::vector<StoryMoment> Moments(const ForceStory& story, double dt) {
  std::vector<StoryMoment> moments, shorts;
  const auto take_shorts = [&] {
    if (shorts.empty()) return;
    StoryMoment all = shorts.front();
    all.to = shorts.back().to;
    const bool lasts = (all.to - all.from) * dt >= kShortest;
    if (lasts || moments.empty()) {
      all.cause = DominantCause(story, shorts);
      Append(all, &moments);
    } else {
      moments.back().to = all.to;
    }
    shorts.clear();
  };
  for (const StoryMoment& run : Runs(story)) {
    const bool told = run.cause == Cause::kPush || (run.to - run.from) * dt >= kShortest;
    if (!told) {
      shorts.push_back(run);
      continue;
    }
    take_shorts();
    Append(run, &moments);
  }
  take_shorts();
  return moments;
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

std::string Forces(const StoryMoment& moment) {
  return ", up to " + Rounded(moment.peak, 2) + " N (" + Rounded(moment.impulse, 2) + " N s)";
}

std::string Words(const PendulumRecording& recording, const Prediction& prediction, int person,
                  const StoryMoment& moment, const Eigen::Vector2d& u) {
  const auto by = [&](double side) {
    const std::string name = Neighbour(recording, prediction, person, moment.from, u, side);
    return name.empty() ? "" : " by " + name;
  };
  const Eigen::Vector2d velocity = prediction.path.At(moment.from, person).qd.head<2>();
  switch (moment.cause) {
    case Cause::kNothing:
      return velocity.norm() < kStill ? "still" : "moves on without force";
    case Cause::kPush:
      return "pushed" + Forces(moment);
    case Cause::kFromBehind:
      return "pushed from behind" + by(-1.0) + Forces(moment);
    case Cause::kFromInFront:
      return "held up from in front" + by(1.0) + Forces(moment);
    case Cause::kOwn:
      return (moment.impulse * velocity.dot(u) < 0.0 ? "brakes" : "steps on") + Forces(moment);
  }
  return "";
}

void Measure(const ForceStory& story, double dt, StoryMoment* moment) {
  const Series series = SeriesOf(moment->cause);
  for (int t = moment->from; t < moment->to; ++t) {
    moment->peak = std::max(moment->peak, std::abs(story.forces[t][series]));
    moment->impulse += dt * story.forces[t][series];
  }
}

}  // namespace

ForceStory StoryOf(const PendulumRecording& recording, const Prediction& prediction, int person) {
  const Eigen::Vector2d u = PushDirection(recording);
  ForceStory story{person, {}, {}};
  for (int t = 0; t < prediction.path.num_frames(); ++t) {
    story.forces.push_back(ForcesAlong(prediction.forces.At(t, person), u));
  }
  const double dt = recording.scene.dt;
  story.moments = Moments(story, dt);
  for (StoryMoment& moment : story.moments) {
    Measure(story, dt, &moment);
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

ContactEnergyBalance BalanceContactEnergy(const RolloutPath<double>& path, const ForceTrace& forces,
                                          double dt) {
  const int people = path.num_people();
  ContactEnergyBalance balance;
  balance.work.assign(people, 0.0);
  balance.impulse.assign(people, Vector4<double>::Zero());
  for (int t = 0; t + 1 < path.num_frames(); ++t) {
    double total = 0.0;
    for (int n = 0; n < people; ++n) {
      const Vector4<double> step = path.At(t + 1, n).q - path.At(t, n).q;
      const Vector4<double>& now = forces.At(t, n)[ForcePart::kInteraction];
      const double work = 0.5 * (now + forces.At(t + 1, n)[ForcePart::kInteraction]).dot(step);
      balance.work[n] += work;
      balance.impulse[n] += dt * now;
      total += work;
    }
    (total < 0.0 ? balance.absorbed : balance.returned) += std::abs(total);
  }
  return balance;
}

Vector4<double> PushImpulse(const ForceTrace& forces, int person, double dt) {
  Vector4<double> impulse = Vector4<double>::Zero();
  for (int t = 0; t + 1 < forces.num_frames(); ++t) {
    const NetForce<double>& force = forces.At(t, person);
    impulse += dt * (force[ForcePart::kPush] + force[ForcePart::kTail]);
  }
  return impulse;
}

}  // namespace pushid
