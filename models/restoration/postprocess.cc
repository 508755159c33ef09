// models: post-processing of restored motions.
#include "models/restoration/postprocess.h"

#include <algorithm>
#include <cmath>

#include "models/restoration/body.h"

namespace pushid {
namespace {

// Where one ankle is held, frame by frame.
class FootLock {
 public:
  // floor: the ankle's own height at frame 0; place, before: where it is now, and was.
  FootLock(double floor, const Eigen::Vector3d& place, const Eigen::Vector3d& before, double dt,
           const PostprocessOptions& options)
      : options_(options),
        floor_(floor),
        dt_(dt),
        place_(place),
        before_(place),
        locked_(Rests(place, before, floor, dt, options)) {}

  // The horizontal correction of an ankle that the restoration puts at `ankle`.
  Eigen::Vector3d Correction(const Eigen::Vector3d& ankle) {
    const bool standing = Rests(ankle, before_, floor_, dt_, options_);
    before_ = ankle;
    if (locked_ && (!standing || Drift(ankle) > options_.release_drift)) Release(ankle);
    if (!locked_ && standing && fading_ == 0) Lock(ankle);
    if (locked_) return Flat(place_ - ankle);
    if (fading_ == 0) return Eigen::Vector3d::Zero();
    --fading_;
    return left_over_ * fading_ / options_.release_frames;
  }

  // The leg cannot reach: what it pulled so far fades.
  void LetGo(const Eigen::Vector3d& correction) {
    locked_ = false;
    left_over_ = correction;
    fading_ = options_.release_frames;
  }
  bool locked() const { return locked_; }

 private:
  static Eigen::Vector3d Flat(const Eigen::Vector3d& v) { return {v.x(), v.y(), 0.0}; }
  double Drift(const Eigen::Vector3d& ankle) const { return Flat(place_ - ankle).norm(); }
  void Release(const Eigen::Vector3d& ankle) { LetGo(Flat(place_ - ankle)); }
  void Lock(const Eigen::Vector3d& ankle) {
    locked_ = true;
    place_ = ankle;
  }

  const PostprocessOptions& options_;
  const double floor_, dt_;
  Eigen::Vector3d place_, before_;
  Eigen::Vector3d left_over_ = Eigen::Vector3d::Zero();
  bool locked_;
  int fading_ = 0;
};

}  // namespace

bool Rests(const Eigen::Vector3d& ankle, const Eigen::Vector3d& before, double floor, double dt,
           const PostprocessOptions& options) {
  const double speed = (ankle - before).head<2>().norm() / dt;
  return ankle.z() < floor + options.contact_height && speed < options.contact_speed;
}

void FadeResidual(const Pose& pose, int frames, BodyMotion* motion, int now) {
  const int size = static_cast<int>(motion->size());
  if (now >= size) return;
  const Pose residual = (*motion)[now] - pose;
  for (int t = now; t < std::min(now + frames, size); ++t) {
    (*motion)[t] -= residual * (1.0 - static_cast<double>(t - now) / frames);
  }
}

void KeepBones(const Pose& first_pose, BodyMotion* motion, int now) {
  for (size_t t = now; t < motion->size(); ++t) {
    (*motion)[t] = FitSkeleton(first_pose, (*motion)[t]).positions;
  }
}

void LockFeet(const Pose& first_pose, double dt, const PostprocessOptions& options,
              BodyMotion* motion, int now) {
  for (const bool left : {false, true}) {
    const int ankle = left ? kLeftAnkle : kRightAnkle;
    const Eigen::Vector3d first = first_pose.col(ankle);
    const Eigen::Vector3d place = now > 0 ? Eigen::Vector3d((*motion)[now].col(ankle)) : first;
    const Eigen::Vector3d before = now > 0 ? Eigen::Vector3d((*motion)[now - 1].col(ankle)) : first;
    FootLock lock(first.z(), place, before, dt, options);
    for (size_t t = now + 1; t < motion->size(); ++t) {
      Pose& pose = (*motion)[t];
      const Eigen::Vector3d at = pose.col(ankle);
      const Eigen::Vector3d correction = lock.Correction(at);
      if (correction.isZero(0.0)) continue;
      const double missed = ReachWithLeg(left, at + correction, &pose);
      if (missed > options.out_of_reach && lock.locked()) {
        Eigen::Vector3d reached = pose.col(ankle) - at;
        reached.z() = 0.0;
        lock.LetGo(reached);
      }
    }
  }
}

void Finish(const RestorationInput& person, const PostprocessOptions& options, BodyMotion* motion) {
  if (motion->empty()) return;
  const int now = std::min(person.Now(), static_cast<int>(motion->size()) - 1);
  const Pose& pose = now > 0 ? person.seen[now] : person.first_pose;
  if (options.fade_residual) FadeResidual(pose, options.fade_frames, motion, now);
  if (options.keep_bones) KeepBones(person.first_pose, motion, now);
  if (now > 0) std::copy(person.seen.begin(), person.seen.begin() + now + 1, motion->begin());
  if (!options.lock_feet) return;
  if (person.stands.empty() || now > 0) {
    LockFeet(person.first_pose, person.dt, options, motion, now);
  } else {
    PlantFeet(person, options, motion);
  }
}

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
