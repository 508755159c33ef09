// models: several particle networks of different seeds, averaged, blended with the linear forecast,
// and brought back to the person's bones.
//
// Every member looks twice: at the motion as it is, and in the mirror, whose forecast is mirrored
// back. The mean of both is the same left and right, as what was learned from is; it brings one
// network to what three without it reach.
//
// A sampled future is a sampled path of one view (a member, mirrored or not), the views taking
// turns, with a draw of the pose's jitter, moved by what the blend differs from the views' mean: so
// futures spread around the forecast as noise, views and what is not known of the pose do.
#pragma once

#include <vector>

#include "models/generators/motion_generator.h"
#include "models/generators/particle_network.h"
#include "models/particles.h"

namespace pushid {

// The linear forecast: ridge regression from the last pose and the last displacements to
// all future poses at once. What any network has to beat, and a good partner in a blend.
//
//   features: last pose, then the last 9 displacements, newest first; m
//   targets:  future poses minus the last one
//   minimum over W of |Y - W X|^2 + penalty |W|^2, features and targets centred, intercept free

inline constexpr int kRidgeDisplacements = 9;

struct RidgeForecast {
  Eigen::MatrixXf weights;  // coordinates x frames, by features
  Eigen::VectorXf bias;

  // As many frames as it was fitted for; observed: at least ten frames.
  Trajectories Forecast(const Trajectories& observed) const;
};

// Sums over windows, so that no table of all of them stands in memory.
class RidgeFit {
 public:
  // Every start of a window of `observed` and `frames` frames in the motion.
  void Add(const Trajectories& motion, int observed, int frames);
  // penalty: m^2.
  RidgeForecast Solve(double penalty) const;

 private:
  Eigen::MatrixXd features_squared_, targets_by_features_;
  Eigen::VectorXd feature_sum_, target_sum_;
  double count_ = 0.0;
};

struct ParticleGeneratorOptions {
  double ridge_share = 0.3;   // of the linear forecast in the blend; 0 needs none
  bool project_bones = true;  // to the lengths of the last frame that was seen
  double jitter = 0.7;        // of the pose in sampled futures; as the members were trained
  // Of the noise of sampled futures: e_t = memory e_{t-1} + sqrt(1 - memory^2) N(0, 1), times
  // scale. Both were chosen on the validation split, where the noise that was learned, drawn anew
  // every frame, covers 80 ms but too little of 1000 ms: errors of a forecast last.
  double noise_memory = 0.32, noise_scale = 1.0;
  bool correlated_noise = true;               // off: coordinates are drawn independently
  bool mirror = true;                         // members also look in the mirror
  std::vector<float> mirrored_controls = {};  // the sign of each control there
};

class ParticleGenerator : public MotionGenerator {
 public:
  ParticleGenerator(ParticleLayout layout, std::vector<ParticleNetwork> members,
                    RidgeForecast ridge, const ParticleGeneratorOptions& options);

  const ParticleLayout& layout() const override { return layout_; }
  std::vector<Trajectories> Forecast(const std::vector<ObservedMotion>& people,
                                     int frames) const override;
  std::vector<std::vector<SampledFuture>> Sample(const std::vector<ObservedMotion>& people,
                                                 int frames, int count,
                                                 const NormalSource& normal) const override;
  // Of the first member, told the pose as it is and not in the mirror.
  std::vector<SampledFuture> Driven(const ObservedMotion& person, int frames,
                                    const Eigen::MatrixXf& noise) const override;

 private:
  struct View {
    const ParticleNetwork& member;
    bool mirrored;
  };
  std::vector<View> Views() const;  // the members, then the members in the mirror
  std::vector<ObservedMotion> Seen(const View& view,
                                   const std::vector<ObservedMotion>& people) const;
  Trajectories Back(const View& view, const Trajectories& motion) const;
  // What the views forecast in the mean, without bones.
  std::vector<Trajectories> MeanOfViews(const std::vector<ObservedMotion>& people,
                                        int frames) const;
  void Blend(const std::vector<ObservedMotion>& people, std::vector<Trajectories>* motions) const;
  void Finish(const ObservedMotion& person, Trajectories* motion) const;

  ParticleLayout layout_;
  std::vector<ParticleNetwork> members_;
  RidgeForecast ridge_;
  ParticleGeneratorOptions options_;
};

}  // namespace pushid
