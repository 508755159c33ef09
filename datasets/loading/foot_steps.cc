// datasets: steps of the feet, and how far their support reaches.
#include "datasets/loading/foot_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "datasets/files/number_text.h"

namespace pushid {
namespace {

using Track = std::vector<Eigen::Vector3d>;

constexpr double kSlopeWindow = 0.05;  // s on either side
constexpr double kPlace = 0.1;         // s at either end of a recording
constexpr double kFlatFoot = 0.01;     // m above the ankle's lowest place in a stance

struct Span {
  int begin, end;  // frames; `end` is the first behind it
};

// Straight lines through what was not seen, the nearest position at the ends; empty when nothing
// was ever seen.
Track WithoutGaps(Track track, const std::vector<double>& weight) {
  const int frames = static_cast<int>(track.size());
  const auto seen = [&](int t) {
    return track[t].allFinite() && (weight.empty() || weight[t] > 0.0);
  };
  int last = -1;
  for (int t = 0; t < frames; ++t) {
    if (!seen(t)) continue;
    for (int gap = last + 1; gap < t; ++gap) {
      const double share = last < 0 ? 1.0 : static_cast<double>(gap - last) / (t - last);
      track[gap] = last < 0 ? track[t] : (1.0 - share) * track[last] + share * track[t];
    }
    last = t;
  }
  if (last < 0) return {};
  std::fill(track.begin() + last + 1, track.end(), track[last]);
  return track;
}

Eigen::Vector3d MeanOf(const Track& track, int begin, int end) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int t = begin; t < end; ++t) sum += track[t];
  return sum / (end - begin);
}

// Horizontal speed, m/s: the slope of a line by least squares.
double SpeedAt(const Track& track, int frame, double fps) {
  const int frames = static_cast<int>(track.size());
  const int wing = std::max(1, static_cast<int>(std::lround(kSlopeWindow * fps)));
  const int begin = std::max(0, frame - wing), end = std::min(frames, frame + wing + 1);
  const double middle = 0.5 * (begin + end - 1);
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  double square = 0.0;
  for (int t = begin; t < end; ++t) {
    moment += (t - middle) * track[t].head<2>();
    square += (t - middle) * (t - middle);
  }
  return square > 0.0 ? moment.norm() / square * fps : 0.0;
}

class StepFinder {
 public:
  StepFinder(const RecordedPerson& person, Foot foot, double fps) : fps_(fps), foot_(foot) {
    const bool left = foot == Foot::kLeft;
    for (const Track* track : {left ? &person.left_ankle : &person.right_ankle,
                               left ? &person.left_toe : &person.right_toe,
                               left ? &person.left_heel : &person.right_heel}) {
      Track whole = WithoutGaps(*track, person.weight);
      if (!whole.empty()) points_.push_back(std::move(whole));
    }
    thresholds_ = points_.size() > 1 ? kToeOrHeelToo : kAnkleAlone;
    frames_ = points_.empty() ? 0 : static_cast<int>(points_[0].size());
  }

  std::vector<FootStep> Find() const {
    std::vector<Span> spans;
    for (const Span& span : Joined(Moving())) {
      if (IsStep(span)) spans.push_back(span);
    }
    std::vector<FootStep> steps;
    for (std::size_t i = 0; i < spans.size(); ++i) {
      const int before = i > 0 ? spans[i - 1].end : 0;
      const int after = i + 1 < spans.size() ? spans[i + 1].begin : frames_;
      FootStep step{foot_, spans[i].begin, spans[i].end, spans[i].end < frames_};
      step.travel = Place({step.landing, after}, frames_ - 1) - Place({before, step.lift_off}, 0);
      steps.push_back(step);
    }
    return steps;
  }

  double Travel() const {
    const int wing = std::min(frames_, std::max(1, static_cast<int>(std::lround(kPlace * fps_))));
    double least = points_.empty() ? 0.0 : std::numeric_limits<double>::infinity();
    for (const Track& point : points_) {
      const Eigen::Vector3d way = MeanOf(point, frames_ - wing, frames_) - MeanOf(point, 0, wing);
      least = std::min(least, way.head<2>().norm());
    }
    return least;
  }

 private:
  // Hysteresis: from where the foot is no longer slow to where it is again, if it was fast between.
  std::vector<Span> Moving() const {
    std::vector<Span> spans;
    double fastest = 0.0;
    int begin = -1;
    for (int t = 0; t <= frames_; ++t) {
      const double speed = t < frames_ ? Speed(t) : 0.0;
      if (speed > thresholds_.moving) {
        if (begin < 0) begin = t, fastest = 0.0;
        fastest = std::max(fastest, speed);
      } else if (begin >= 0) {
        if (fastest >= thresholds_.stepping) spans.push_back({begin, t});
        begin = -1;
      }
    }
    return spans;
  }

  // Speed of the point that moves least: where one rests, the foot rolls or turns on it.
  double Speed(int frame) const {
    double slowest = std::numeric_limits<double>::infinity();
    for (const Track& point : points_) slowest = std::min(slowest, SpeedAt(point, frame, fps_));
    return slowest;
  }

  std::vector<Span> Joined(const std::vector<Span>& spans) const {
    std::vector<Span> joined;
    for (const Span& span : spans) {
      if (!joined.empty() && span.begin - joined.back().end < thresholds_.pause_s * fps_) {
        joined.back().end = span.end;
      } else {
        joined.push_back(span);
      }
    }
    return joined;
  }

  // A step cut by either end of the recording may be short.
  bool IsStep(const Span& span) const {
    const bool whole = span.begin > 0 && span.end < frames_;
    if (whole && span.end - span.begin < thresholds_.duration_s * fps_) return false;
    return std::all_of(points_.begin(), points_.end(), [&](const Track& point) {
      double farthest = 0.0;
      for (int t = span.begin; t < std::min(span.end + 1, frames_); ++t) {
        farthest = std::max(farthest, (point[t] - point[span.begin]).head<2>().norm());
      }
      return farthest >= thresholds_.distance;
    });
  }

  // The ankle's place in a stance: its mean while the heel is down; without a stance at `frame`.
  Eigen::Vector2d Place(const Span& stance, int frame) const {
    const Track& ankle = points_[0];
    if (stance.begin >= stance.end) return ankle[frame].head<2>();
    double lowest = std::numeric_limits<double>::infinity();
    for (int t = stance.begin; t < stance.end; ++t) lowest = std::min(lowest, ankle[t].z());
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    int count = 0;
    for (int t = stance.begin; t < stance.end; ++t) {
      if (ankle[t].z() > lowest + kFlatFoot) continue;
      sum += ankle[t].head<2>();
      ++count;
    }
    return sum / count;
  }

  const double fps_;
  const Foot foot_;
  StepThresholds thresholds_ = kAnkleAlone;
  std::vector<Track> points_;  // the ankle first
  int frames_ = 0;
};

}  // namespace

std::string TravelText(const Eigen::Vector2d& travel) {
  const char* const ways[] = {"forwards", "to the left", "backwards", "to the right"};
  const double direction = std::atan2(travel.y(), travel.x());
  const int quarter = static_cast<int>(std::lround(direction / (0.5 * M_PI)));
  return Rounded(travel.norm(), 2) + " m " + ways[(quarter + 4) % 4];
}

std::string StepsText(const PersonSteps& steps, double fps) {
  if (!steps.Stepped()) return "none";
  std::string text;
  for (const FootStep& step : steps.steps) {
    const std::string from = Rounded(step.lift_off / fps, 3);
    text += (text.empty() ? "" : "; ") + NameOf(step.foot) +
            (step.finished ? " " + from + "-" + Rounded(step.landing / fps, 3) : " from " + from) +
            " s " + TravelText(step.travel) + (step.finished ? "" : ", cut off");
  }
  return text;
}

double FootStep::Direction() const { return std::atan2(travel.y(), travel.x()); }

bool PersonSteps::Stands(Foot foot, int frame) const {
  return std::none_of(steps.begin(), steps.end(), [&](const FootStep& step) {
    return step.foot == foot && frame >= step.lift_off && frame < step.landing;
  });
}

PersonSteps FindSteps(const RecordedPerson& person, double fps) {
  PersonSteps found;
  for (Foot foot : kFeet) {
    const StepFinder finder(person, foot, fps);
    const std::vector<FootStep> steps = finder.Find();
    found.travel = std::max(found.travel, finder.Travel());
    found.steps.insert(found.steps.end(), steps.begin(), steps.end());
  }
  std::stable_sort(found.steps.begin(), found.steps.end(),
                   [](const FootStep& a, const FootStep& b) { return a.lift_off < b.lift_off; });
  return found;
}

}  // namespace pushid
