// models: windows, and what is known of all of them.
#include <algorithm>

#include "models/generators/particle_module_torch.h"

namespace pushid {
namespace {

constexpr float kLeastSpread = 1e-4f;  // m; of a coordinate that hardly moves

torch::Tensor ControlsOf(const LearntParticles& motion, int count) {
  if (count == 0) return torch::zeros({motion.motion.cols(), 0});
  return ToTensor(motion.controls);
}

}  // namespace

ParticleWindows::ParticleWindows(const ParticleLayout& layout,
                                 const std::vector<LearntParticles>& motions,
                                 const ParticleTrainingOptions& options)
    : options_(options) {
  const int window = options.observed + options.predicted;
  std::vector<torch::Tensor> frames, controls;
  int64_t row = 0;
  for (const bool mirror : {false, true}) {
    for (const LearntParticles& motion : motions) {
      const int64_t count = motion.motion.cols();
      frames.push_back(ToTensor(mirror ? Mirrored(motion.motion, layout) : motion.motion));
      LearntParticles turned = motion;
      if (mirror) turned.controls = MirroredControls(motion.controls, options.mirrored_controls);
      controls.push_back(ControlsOf(turned, options.structure.controls));
      const int64_t starts = options.from_start ? (count > options.observed ? 1 : 0)
                                                : std::max<int64_t>(0, count - window + 1);
      for (int64_t start = 0; !mirror && start < starts; ++start) {
        const size_t group = static_cast<size_t>(motion.group);
        if (by_group_.size() <= group) by_group_.resize(group + 1);
        all_.push_back({row + start, row + count - 1});
        by_group_[group].push_back(all_.back());
      }
      row += count;
    }
    if (!mirror) mirrored_rows_ = row;
  }
  if (motions.empty()) return;
  frames_ = torch::cat(frames), controls_ = torch::cat(controls);
  double sum = 0.0;
  for (const auto& places : by_group_) {
    sum += std::sqrt(static_cast<double>(places.size()));
    group_share_.push_back(sum);
  }
  for (double& share : group_share_) share /= sum;
}

ParticleBatch ParticleWindows::Draw() const {
  const torch::Tensor random = torch::rand({options_.batch, 3}, torch::kFloat64);
  const auto drawn = random.accessor<double, 2>();
  std::vector<Place> places;
  for (int i = 0; i < options_.batch; ++i) {
    const size_t group =
        std::upper_bound(group_share_.begin(), group_share_.end() - 1, drawn[i][0]) -
        group_share_.begin();
    const auto& among = by_group_[group];
    Place place = among[static_cast<size_t>(drawn[i][1] * static_cast<double>(among.size()))];
    if (drawn[i][2] < options_.mirrored) {
      place.row += mirrored_rows_, place.last_row += mirrored_rows_;
    }
    places.push_back(place);
  }
  return Gather(places);
}

ParticleBatch ParticleWindows::Some(int most) const {
  const size_t step = std::max<size_t>(1, all_.size() / static_cast<size_t>(most));
  std::vector<Place> places;
  for (size_t i = 0; i < all_.size(); i += step) places.push_back(all_[i]);
  return Gather(places);
}

ParticleBatch ParticleWindows::Gather(const std::vector<Place>& places) const {
  const int64_t count = static_cast<int64_t>(places.size());
  const int64_t window = options_.observed + options_.predicted;
  torch::Tensor rows = torch::empty({count, window}, torch::kInt64);
  torch::Tensor present = torch::empty({count, window});
  auto row = rows.accessor<int64_t, 2>();
  auto is = present.accessor<float, 2>();
  for (int64_t i = 0; i < count; ++i) {
    for (int64_t t = 0; t < window; ++t) {
      row[i][t] = std::min(places[i].row + t, places[i].last_row);
      is[i][t] = places[i].row + t <= places[i].last_row ? 1.0f : 0.0f;
    }
  }
  const auto gathered = [&](const torch::Tensor& of) {
    return of.index_select(0, rows.flatten()).reshape({count, window, of.size(1)});
  };
  return {gathered(frames_), gathered(controls_), present};
}

ParticleNetwork ParticleStatistics(const ParticleLayout& layout,
                                   const std::vector<LearntParticles>& motions,
                                   const ParticleTrainingOptions& options) {
  const int size = layout.num_coordinates(), controls = options.structure.controls;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(size), squares = sum, steps = sum;
  Eigen::VectorXd control_squares = Eigen::VectorXd::Zero(controls);
  double frames = 0.0;
  for (const LearntParticles& motion : motions) {
    if (motion.motion.cols() < 2) continue;
    for (const Trajectories& side : {motion.motion, Mirrored(motion.motion, layout)}) {
      const Eigen::MatrixXd all = side.cast<double>();
      const Eigen::Index last = all.cols() - 1;
      sum += all.rowwise().sum();
      squares += all.array().square().matrix().rowwise().sum();
      steps += (all.rightCols(last) - all.leftCols(last)).array().square().matrix().rowwise().sum();
      frames += static_cast<double>(all.cols());
    }
    if (controls == 0) continue;
    control_squares +=
        2.0 * motion.controls.cast<double>().array().square().matrix().rowwise().sum();
  }
  frames = std::max(frames, 1.0);
  const Eigen::VectorXd mean = sum / frames;
  const auto spread = [](const Eigen::VectorXd& square) -> Eigen::VectorXf {
    return square.cwiseMax(0.0).cwiseSqrt().cast<float>().cwiseMax(kLeastSpread);
  };
  ParticleNetwork network;
  network.structure = options.structure;
  network.pose_mean = mean.cast<float>();
  network.pose_spread = spread(squares / frames - mean.cwiseProduct(mean));
  network.step_spread = spread(steps / frames);
  network.control_spread = spread(control_squares / frames);
  return network;
}

}  // namespace pushid
