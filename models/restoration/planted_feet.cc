// models: feet that stand and land as the pendulum's model says.
#include "models/restoration/planted_feet.h"

#include <algorithm>

#include "models/restoration/skeleton_fit.h"

namespace pushid {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

int AnkleOf(bool left) { return left ? kLeftAnkle : kRightAnkle; }
int ToeOf(bool left) { return left ? kLeftToe : kRightToe; }
Vector3d FootOf(bool left, const Pose& pose) {
  return pose.col(ToeOf(left)) - pose.col(AnkleOf(left));
}

Vector2d Midpoint(const Pose& pose) {
  return 0.5 * (pose.col(kLeftAnkle) + pose.col(kRightAnkle)).head<2>();
}

// Where a foot stands from frame `begin` on: ankle, and toe seen from it.
struct Footing {
  int begin = 0;
  Vector3d ankle, foot;
};

// A restored foot as flat as the one at frame 0.
Vector3d FlatFoot(const Vector3d& restored, const Vector3d& first) {
  const Vector2d level = restored.head<2>();
  if (!(level.norm() > 0.1 * first.norm())) return first;
  const Vector2d flat = first.head<2>().norm() * level.normalized();
  return {flat.x(), flat.y(), first.z()};
}

// One for each stretch of frames that the person stands in.
std::vector<Footing> Footings(const RestorationInput& person, const BodyMotion& restored,
                              bool left) {
  const Pose& first = person.first_pose;
  const Vector3d foot = FootOf(left, first);
  std::vector<Footing> footings = {{0, first.col(AnkleOf(left)), foot}};
  const Vector2d from_cart = Midpoint(first) - person.q[0].head<2>();
  for (int t = 1; t < static_cast<int>(restored.size()); ++t) {
    if (!person.stands[t] || person.stands[t - 1]) continue;
    const Vector2d move = person.q[t].head<2>() + from_cart - Midpoint(restored[t]);
    Vector3d ankle = restored[t].col(AnkleOf(left)) + Vector3d(move.x(), move.y(), 0.0);
    ankle.z() = first(2, AnkleOf(left));
    footings.push_back({t, ankle, FlatFoot(FootOf(left, restored[t]), foot)});
  }
  return footings;
}

class PlantedFoot {
 public:
  PlantedFoot(bool left, std::vector<Footing> footings, double dt,
              const PostprocessOptions& options)
      : left_(left),
        options_(options),
        dt_(dt),
        footings_(std::move(footings)),
        at_(footings_[0]),
        before_(at_.ankle) {}

  void Move(int t, bool stands, Pose* pose) {
    const Vector3d ankle = pose->col(AnkleOf(left_)), foot = FootOf(left_, *pose);
    Hold(t, stands, ankle, foot);
    before_ = ankle;
    flat_ = stands && holds_ ? 1.0 : std::max(0.0, flat_ - 1.0 / options_.release_frames);
    Vector3d target = holds_ ? at_.ankle : Vector3d(ankle + Fade() * left_over_);
    target.z() = ankle.z() + flat_ * (at_.ankle.z() - ankle.z());
    Vector3d toe = foot + flat_ * (at_.foot - foot);
    if (!stands && next_ < footings_.size()) {
      const double landing = Landing(t);
      target += landing * (footings_[next_].ankle - target);
      toe += landing * (footings_[next_].foot - toe);
    }
    const double missed = ReachWithLeg(left_, target, pose);
    if (toe.norm() > 0.0) {
      pose->col(ToeOf(left_)) = pose->col(AnkleOf(left_)) + foot.norm() * toe.normalized();
    }
    if (holds_ && missed > options_.out_of_reach) LetGo(pose->col(AnkleOf(left_)) - ankle);
  }

 private:
  // Whether it holds at this frame, and where.
  void Hold(int t, bool stands, const Vector3d& ankle, const Vector3d& foot) {
    if (next_ < footings_.size() && footings_[next_].begin == t) {
      at_ = footings_[next_++];
      holds_ = true;
      return;
    }
    const bool rests = stands || Rests(ankle, before_, footings_[0].ankle.z(), dt_, options_);
    const double drift = (at_.ankle - ankle).head<2>().norm();
    if (holds_ && (!rests || (!stands && drift > options_.release_drift))) LetGo(at_.ankle - ankle);
    if (holds_ || !rests || fading_ > 0) return;
    at_ = {t, ankle, foot};
    holds_ = true;
  }

  void LetGo(const Vector3d& left_over) {
    holds_ = false;
    left_over_ = left_over;
    fading_ = options_.release_frames;
  }

  double Fade() {
    fading_ = std::max(0, fading_ - 1);
    return static_cast<double>(fading_) / options_.release_frames;
  }

  // From 0, fade_frames before the landing, to 1.
  double Landing(int t) const {
    const int left = footings_[next_].begin - t;
    return std::max(0.0, 1.0 - static_cast<double>(left) / options_.fade_frames);
  }

  const bool left_;
  const PostprocessOptions& options_;
  const double dt_;
  const std::vector<Footing> footings_;
  Footing at_;                             // where it stands, or stood last
  Vector3d before_;                        // the restored ankle of the last frame
  size_t next_ = 1;                        // of footings_
  Vector3d left_over_ = Vector3d::Zero();  // of what held it, horizontally
  bool holds_ = true;                      // people stand at frame 0
  int fading_ = 0;
  double flat_ = 1.0;  // how much height and toe are those of standing; a resting heel may rise
};

}  // namespace

void PlantFeet(const RestorationInput& person, const PostprocessOptions& options,
               BodyMotion* motion) {
  if (motion->empty()) return;
  const BodyMotion restored = *motion;
  for (const bool left : {false, true}) {
    PlantedFoot foot(left, Footings(person, restored, left), person.dt, options);
    for (int t = 1; t < static_cast<int>(motion->size()); ++t) {
      foot.Move(t, person.stands[t], &(*motion)[t]);
    }
  }
}

}  // namespace pushid
