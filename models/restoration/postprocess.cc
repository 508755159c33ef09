// models: post-processing of restored motions.
#include "models/restoration/postprocess.h"

#include <algorithm>
#include <cmath>

#include "models/restoration/body.h"

namespace pushid {
namespace {

using Eigen::Vector3d;

// Whether an ankle is low and slow; floor: its height at frame 0.
bool Rests(const Vector3d& ankle, const Vector3d& before, double floor, double dt,
           const PostprocessOptions& options) {
  const double speed = (ankle - before).head<2>().norm() / dt;
  return ankle.z() < floor + options.contact_height && speed < options.contact_speed;
}

Vector3d Flat(const Vector3d& v) { return {v.x(), v.y(), 0.0}; }

// The place where one ankle is held, frame by frame.
class FootLock {
 public:
  // floor: the ankle's height at frame 0; place, before: its place now and a frame before.
  FootLock(double floor, const Vector3d& place, const Vector3d& before, double dt,
           const PostprocessOptions& options)
      : options_(options),
        floor_(floor),
        dt_(dt),
        place_(place),
        before_(place),
        locked_(Rests(place, before, floor, dt, options)) {}

  // The horizontal correction of an ankle that the restoration puts at `ankle`.
  Vector3d Correction(const Vector3d& ankle) {
    const bool standing = Rests(ankle, before_, floor_, dt_, options_);
    before_ = ankle;
    const Vector3d pull = Flat(place_ - ankle);
    if (locked_ && (!standing || pull.norm() > options_.release_drift)) LetGo(pull);
    if (!locked_ && standing && fading_ == 0) locked_ = true, place_ = ankle;
    if (locked_) return Flat(place_ - ankle);
    if (fading_ == 0) return Vector3d::Zero();
    --fading_;
    return left_over_ * fading_ / options_.release_frames;
  }

  // Unlocks the foot, whose correction fades.
  void LetGo(const Vector3d& correction) {
    locked_ = false;
    left_over_ = correction;
    fading_ = options_.release_frames;
  }
  bool locked() const { return locked_; }

 private:
  const PostprocessOptions& options_;
  const double floor_, dt_;
  Vector3d place_, before_, left_over_ = Vector3d::Zero();
  bool locked_;
  int fading_ = 0;
};

constexpr double kClearance = 0.05;  // m, of an ankle in the middle of its swing, at least

// The lift of a foot: from 0 to 1 and back to 0 in the air, 0 while it stands.
std::vector<double> LiftsOf(const std::vector<FootPath>& feet, bool left) {
  std::vector<double> lifts(feet.size(), 0.0);
  for (size_t t = 0; t < feet.size(); ++t) {
    if (!feet[t].flies[left]) continue;
    size_t end = t;
    while (end < feet.size() && feet[end].flies[left]) ++end;
    for (size_t k = t; k < end; ++k) {
      lifts[k] = std::sin(M_PI * static_cast<double>(k - t + 1) / static_cast<double>(end - t + 1));
    }
    t = end - 1;
  }
  return lifts;
}

}  // namespace

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
    const Vector3d first = first_pose.col(ankle);
    const Vector3d place = now > 0 ? Vector3d((*motion)[now].col(ankle)) : first;
    const Vector3d before = now > 0 ? Vector3d((*motion)[now - 1].col(ankle)) : first;
    FootLock lock(first.z(), place, before, dt, options);
    for (size_t t = now + 1; t < motion->size(); ++t) {
      Pose& pose = (*motion)[t];
      const Vector3d at = pose.col(ankle);
      const Vector3d correction = lock.Correction(at);
      if (correction.isZero(0.0)) continue;
      const double missed = ReachWithLeg(left, at + correction, &pose);
      if (missed > options.out_of_reach && lock.locked()) {
        Vector3d reached = pose.col(ankle) - at;
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
  if (person.feet.empty() || now > 0) {
    LockFeet(person.first_pose, person.dt, options, motion, now);
  } else {
    PlantFeet(person, motion);
  }
}

void PlantFeet(const RestorationInput& person, BodyMotion* motion) {
  const Pose& first = person.first_pose;
  for (const bool left : {false, true}) {
    const int ankle = left ? kLeftAnkle : kRightAnkle, toe = left ? kLeftToe : kRightToe;
    const Vector3d stood = first.col(ankle), flat = first.col(toe) - stood;
    const std::vector<double> lifts = LiftsOf(person.feet, left);
    for (size_t t = 1; t < motion->size(); ++t) {
      Pose& pose = (*motion)[t];
      const Vector3d restored = pose.col(toe) - pose.col(ankle);
      Vector3d target = stood;
      target.head<2>() += person.feet[t].moved[left];
      target.z() += lifts[t] * std::max(kClearance, pose(2, ankle) - stood.z());
      const Vector3d foot = flat + lifts[t] * (restored - flat);
      ReachWithLeg(left, target, &pose);
      if (foot.norm() > 0.0) {
        pose.col(toe) = pose.col(ankle) + restored.norm() * foot.normalized();
      }
    }
  }
}

}  // namespace pushid
