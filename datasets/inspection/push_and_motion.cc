// datasets: pushes beside motions.
#include "datasets/inspection/push_and_motion.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace pushid {
namespace {

using Vectors = std::vector<Eigen::Vector2d>;

constexpr double kLookBefore = 1.5, kLookAfter = 0.5;  // s around the push
constexpr double kHalfSmoothing = 0.05;                // s
constexpr double kLeastMotion = 0.01;                  // m
constexpr double kNoise = 4.0;                         // standard errors
constexpr double kShareOfSpeed = 0.25;                 // of the largest, at the onset
constexpr double kSwayTime = 0.25;                     // s: what sway before the push goes on for
// Before a push people sway; who is faster than this, and half as fast as ever after, is moved.
constexpr double kSway = 0.05, kFast = 0.08;         // m/s
constexpr double kMostGain = 2.0, kUsualGain = 0.9;  // of those who are quickest to move
constexpr double kSlowToMove = 0.5, kLeastGain = 0.3, kSlideGain = 1.0;  // of who is looked at
constexpr double kSurelyLate = 0.08, kSurelyEarly = 0.15;                // s
constexpr int kSustained = 3, kFewestRows = 5;                           // frames
constexpr double kImpulseEnds = 0.01;  // of the impulse, at both ends

// Standard deviation of white noise: of second differences, by their median.
double NoiseOf(const Vectors& path, int axis) {
  std::vector<double> size = {0.0};
  for (size_t t = 2; t < path.size(); ++t) {
    size.push_back(std::fabs(path[t][axis] - 2.0 * path[t - 1][axis] + path[t - 2][axis]));
  }
  const auto middle = size.begin() + static_cast<std::ptrdiff_t>(size.size() / 2);
  std::nth_element(size.begin(), middle, size.end());
  return *middle / 0.6745 / std::sqrt(6.0);
}

struct Force {
  Vectors rows;  // by frame of the recording
  PushKind kind = PushKind::kExternal;
  bool turns = false;  // whether any row has a torque about the ankles
  int next = 0;        // the frame where a later push begins, or the recording ends
};

// The first push on a person and all that overlap it.
Force FirstPush(const PendulumRecording& recording, int person) {
  std::vector<const ScenePush*> pushes;
  for (const ScenePush& push : recording.scene.pushes) {
    if (push.person == person && !push.force.empty()) pushes.push_back(&push);
  }
  std::sort(pushes.begin(), pushes.end(),
            [](auto* a, auto* b) { return a->start_frame < b->start_frame; });
  Force force;
  force.next = recording.num_frames();
  if (pushes.empty()) return force;
  force.kind = pushes[0]->kind;
  force.rows.assign(recording.num_frames(), Eigen::Vector2d::Zero());
  int end = pushes[0]->EndFrame();
  for (const ScenePush* push : pushes) {
    force.next = push->start_frame < end ? recording.num_frames() : push->start_frame;
    if (push->start_frame >= end) break;
    end = std::max(end, push->EndFrame());
    const int rows = std::min(push->EndFrame(), recording.num_frames());
    for (int t = push->start_frame; t < rows; ++t) {
      const Vector4<double>& row = push->force[t - push->start_frame];
      force.rows[t] += row.head<2>();
      force.turns = force.turns || !row.tail<2>().isZero(0.0);
    }
  }
  return force;
}

class Comparison {
 public:
  Comparison(const PendulumRecording& recording, int person, Force force)
      : recording_(recording), person_(person), force_(std::move(force)), dt_(recording.scene.dt) {}

  std::optional<PushAndMotion> Compare() {
    // On ground that moves, who sets off when is not the push's to say.
    if (recording_.scene.ground.moves() || !FindPush() || !FindPath()) return std::nullopt;
    PushAndMotion found;
    found.speed = impulse_.norm() / Mass();
    Gain(&found);
    const int onset = Onset();
    if (onset < 0) return found;
    const Eigen::Vector2d way = smooth_[std::min(onset + 1, last_ - 1)] - rest_;
    found.angle = std::acos(std::clamp(way.normalized().dot(along_), -1.0, 1.0));
    Lag(onset, &found);
    return found;
  }

 private:
  double Mass() const { return recording_.scene.people[person_].body.mass; }

  bool FindPush() {
    impulse_.setZero();
    double all = 0.0, sum = 0.0;
    for (const Eigen::Vector2d& row : force_.rows) {
      impulse_ += dt_ * row;
      all += row.norm();
    }
    if (!(impulse_.norm() > 0.0)) return false;
    along_ = impulse_.normalized();
    start_ = end_ = -1;
    for (int t = 0; t < static_cast<int>(force_.rows.size()); ++t) {
      sum += force_.rows[t].norm();
      if (start_ < 0 && sum >= kImpulseEnds * all) start_ = t;
      if (end_ < 0 && sum >= (1.0 - kImpulseEnds) * all) end_ = t + 1;
    }
    return true;
  }

  // The point that carries the mass, smoothed, and its velocity, around the push; of a cart that is
  // pushed by itself the cart, behind which a pole lags.
  bool FindPath() {
    const double hip = force_.turns ? 1.0 - kCartShare : 0.0;
    const int frames = recording_.num_frames();
    half_ = std::max(1, static_cast<int>(std::lround(kHalfSmoothing / dt_)));
    first_ = std::max(0, start_ - static_cast<int>(kLookBefore / dt_));
    last_ = std::min(force_.next, end_ + static_cast<int>(kLookAfter / dt_));
    if (last_ - first_ < 2 * half_ + kSustained) return false;
    for (int t = 0; t < frames; ++t) {
      if (t >= first_ && t < last_ && !(recording_.Weight(person_, t) > 0.0)) return false;
      path_.push_back(hip * recording_.hip[person_][t].head<2>() +
                      (1.0 - hip) * recording_.states[person_][t].q.head<2>());
    }
    noise_ = std::max(NoiseOf(path_, 0), NoiseOf(path_, 1));
    smooth_.resize(frames);
    velocity_.assign(frames, Eigen::Vector2d::Zero());
    for (int t = first_; t < last_; ++t) {
      smooth_[t] = Mean(t, std::min({half_, t, frames - 1 - t}));
      velocity_[t] = Slope(std::max(0, t - 2 * half_), std::min(frames, t + 2 * half_ + 1));
    }
    double sum = 0.0;
    for (int k = -2 * half_; k <= 2 * half_; ++k) sum += k * dt_ * k * dt_;
    speed_error_ = noise_ / std::sqrt(sum);
    return true;
  }

  Eigen::Vector2d Mean(int t, int half) const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int k = t - half; k <= t + half; ++k) sum += path_[k];
    return sum / (2 * half + 1);
  }

  // Of a line fitted to the frames [from, to).
  Eigen::Vector2d Slope(int from, int to) const {
    const double middle = 0.5 * (from + to - 1);
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double squares = 0.0;
    for (int t = from; t < to; ++t) {
      sum += (t - middle) * dt_ * path_[t];
      squares += (t - middle) * (t - middle) * dt_ * dt_;
    }
    return squares > 0.0 ? Eigen::Vector2d(sum / squares) : Eigen::Vector2d::Zero();
  }

  void Gain(PushAndMotion* found) const {
    double gain = 0.0, error = 0.0;
    if (force_.kind != PushKind::kExternal) {
      // Its rows are all that moves the person: the way it goes over theirs.
      double speed = 0.0, way = 0.0, squares = 0.0, product = 0.0;
      for (int t = start_; t <= std::min(end_, last_ - 1); ++t) {
        product += way * (path_[t] - path_[start_]).dot(along_);
        squares += way * way;
        way += dt_ * speed + 0.5 * dt_ * dt_ * force_.rows[t].dot(along_) / Mass();
        speed += dt_ * force_.rows[t].dot(along_) / Mass();
      }
      gain = squares > 0.0 ? product / squares : 1.0;
      error = squares > 0.0 ? noise_ * std::sqrt(2.0 / squares) : 0.0;
    } else {
      for (int t = first_; t < last_; ++t) gain = std::max(gain, velocity_[t].dot(along_));
      gain /= found->speed;
      error = speed_error_ / found->speed;
    }
    found->gain = gain;
    found->least_gain = gain - 3.0 * error;
    found->largest_gain = gain + 3.0 * error;
  }

  double Fastest(int from, int to) const {
    return std::accumulate(velocity_.begin() + from, velocity_.begin() + to, 0.0,
                           [](double most, const auto& v) { return std::max(most, v.norm()); });
  }

  // The frame where the person sets off, -1: nowhere. Sets rest_, distance_ and before_.
  int Onset() {
    const double fastest = Fastest(first_, last_);
    // Slopes up to here see nothing after the push's start.
    const int until = std::max(first_, start_ - 2 * half_);
    const double sway = until > first_ + 2 * half_ ? Fastest(first_, until) : 0.0;
    before_ = sway > std::max(kSway, 5.0 * speed_error_) && (sway > kFast || sway > 0.5 * fastest);
    const int from = before_ ? first_ : std::max(first_, start_ - 1);
    const int behind = before_ ? std::min(first_ + 2 * half_, std::max(start_, first_ + 1)) : from;
    const int rests = before_ ? first_ : std::max(first_, from - 2 * half_);
    const int count = std::max(1, behind - rests);
    rest_.setZero();
    for (int t = rests; t < rests + count; ++t) rest_ += path_[t] / count;
    const double error = noise_ * std::sqrt(1.0 / (2 * half_ + 1) + 1.0 / count);
    distance_ = std::max({kLeastMotion, kNoise * error, before_ ? 0.0 : kSwayTime * sway});
    for (int t = from, moved = 0; t < last_; ++t) {
      const bool moves =
          (smooth_[t] - rest_).norm() > distance_ && velocity_[t].norm() > kShareOfSpeed * fastest;
      moved = moves ? moved + 1 : 0;
      if (moved == kSustained) return t - kSustained + 1;
    }
    return -1;
  }

  // The frame by which `gain` times the force alone has brought the mass as far as the onset.
  double FrameOfWay(double gain) const {
    double speed = 0.0, way = 0.0;
    const int frames = static_cast<int>(force_.rows.size());
    for (int t = 0; t < frames; ++t) {
      if (way > distance_) return t;
      const double force = gain * force_.rows[t].dot(along_) / Mass();
      way += dt_ * speed + 0.5 * dt_ * dt_ * force;
      speed += dt_ * force;
    }
    if (!(speed > 0.0)) return HUGE_VAL;
    return frames + std::max(0.0, (distance_ - way) / (dt_ * speed));
  }

  void Lag(int onset, PushAndMotion* found) const {
    if (before_) {
      const double late = (start_ - onset) * dt_;
      if (late > kSurelyLate) found->push_late = late;
    }
    if (force_.kind != PushKind::kExternal || found->push_late > 0.0) return;
    const double soonest = FrameOfWay(kMostGain * std::max(found->gain, kUsualGain));
    const double latest = FrameOfWay(kSlowToMove * std::clamp(found->gain, kLeastGain, kSlideGain));
    const double shift = dt_ * (onset - FrameOfWay(std::max(found->gain, kLeastGain)));
    if (dt_ * (soonest - onset) > kSurelyLate) found->push_late = std::fabs(shift);
    if (dt_ * (onset - latest) > kSurelyEarly) found->push_early = shift;
  }

  const PendulumRecording& recording_;
  const int person_;
  const Force force_;
  const double dt_;
  Eigen::Vector2d impulse_, along_, rest_;
  int start_ = 0, end_ = 0, first_ = 0, last_ = 0, half_ = 1;  // frames; of the impulse, looked at
  Vectors path_, smooth_, velocity_;
  double noise_ = 0.0, speed_error_ = 0.0, distance_ = 0.0;
  bool before_ = false;  // moved before the push began
};

constexpr double kRestTime = 0.2;                       // s
constexpr double kLeastShare = 0.01, kRestShare = 0.3;  // of the peak, of what is a rest
constexpr double kSteady = 0.3;                         // of it: by how much its halves may differ
// Of the peak: a force still on; who starts more slowly does not stop so at once.
constexpr double kStillOn = 0.5, kSlowStart = 0.25;

double Length(const Vector4<double>& row) { return row.head<2>().norm(); }

double Peak(const ScenePush& push) {
  return std::accumulate(push.force.begin(), push.force.end(), 0.0,
                         [](double peak, const auto& row) { return std::max(peak, Length(row)); });
}

Eigen::Vector2d MeanForce(const ScenePush& push, size_t from, size_t to) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (size_t t = from; t < to; ++t) sum += push.force[t].head<2>();
  return sum / static_cast<double>(to - from);
}

}  // namespace

std::optional<PushAndMotion> ComparePush(const PendulumRecording& recording, int person) {
  return Comparison(recording, person, FirstPush(recording, person)).Compare();
}

double RestingForce(const ScenePush& push, double dt) {
  const size_t rows = push.force.size();
  const auto at_rest = static_cast<size_t>(std::ceil(kRestTime / dt));
  if (push.kind != PushKind::kExternal || at_rest < 4 || rows < 2 * at_rest) return 0.0;
  const size_t from = rows - at_rest, middle = rows - at_rest / 2;
  const Eigen::Vector2d mean = MeanForce(push, from, rows);
  const double peak = Peak(push);
  double largest = 0.0, squares = 0.0;
  for (size_t t = from; t < rows; ++t) {
    largest = std::max(largest, Length(push.force[t]));
    squares += (push.force[t].head<2>() - mean).squaredNorm();
  }
  const double error = std::sqrt(squares) / static_cast<double>(at_rest);
  const double drift = (MeanForce(push, from, middle) - MeanForce(push, middle, rows)).norm(),
               rest = mean.norm();
  const bool some = rest > kLeastShare * peak && rest > kNoise * error;
  return some && drift <= kSteady * rest && largest < kRestShare * peak ? rest : 0.0;
}

bool HasNoEnd(const ScenePush& push, int num_frames) {
  if (push.kind != PushKind::kExternal || push.force.size() < kFewestRows) return false;
  const double peak = Peak(push);
  if (!(Length(push.force.back()) > kStillOn * peak)) return false;
  return push.EndFrame() >= num_frames - 1 || Length(push.force.front()) < kSlowStart * peak;
}

}  // namespace pushid
