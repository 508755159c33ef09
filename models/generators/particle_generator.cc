// models: particles averaged and blended.
#include "models/generators/particle_generator.h"

#include <utility>

namespace pushid {
namespace {

std::vector<Trajectories> Empty(const std::vector<ObservedMotion>& people, int count, int frames) {
  return std::vector<Trajectories>(people.size() * static_cast<size_t>(count),
                                   Trajectories::Zero(people.front().frames.rows(), frames));
}

}  // namespace

ParticleGenerator::ParticleGenerator(ParticleLayout layout, std::vector<ParticleNetwork> members,
                                     RidgeForecast ridge, const ParticleGeneratorOptions& options)
    : layout_(std::move(layout)),
      members_(std::move(members)),
      ridge_(std::move(ridge)),
      options_(options) {}

std::vector<Trajectories> ParticleGenerator::MeanOfMembers(
    const std::vector<ObservedMotion>& people, int frames) const {
  std::vector<Trajectories> motions = Empty(people, 1, frames);
  const float share = 1.0f / static_cast<float>(members_.size());
  for (const ParticleNetwork& member : members_) {
    ParticleRollout rollout(member, people);
    for (int t = 0; t < frames; ++t) {
      const Eigen::MatrixXf& poses = rollout.Step();
      for (size_t n = 0; n < people.size(); ++n) {
        motions[n].col(t) += share * poses.col(static_cast<Eigen::Index>(n));
      }
    }
  }
  return motions;
}

void ParticleGenerator::Blend(const std::vector<ObservedMotion>& people,
                              std::vector<Trajectories>* motions) const {
  const float share = static_cast<float>(options_.ridge_share);
  if (share <= 0.0f) return;
  for (size_t n = 0; n < people.size(); ++n) {
    Trajectories& motion = (*motions)[n];
    motion =
        (1.0f - share) * motion + share * ridge_.Forecast(people[n].frames).leftCols(motion.cols());
  }
}

void ParticleGenerator::Finish(const ObservedMotion& person, Trajectories* motion) const {
  if (!options_.project_bones) return;
  ProjectBones(person.frames.rightCols(1), layout_, motion);
}

std::vector<Trajectories> ParticleGenerator::Forecast(const std::vector<ObservedMotion>& people,
                                                      int frames) const {
  if (people.empty()) return {};
  std::vector<Trajectories> motions = MeanOfMembers(people, frames);
  Blend(people, &motions);
  for (size_t n = 0; n < people.size(); ++n) Finish(people[n], &motions[n]);
  return motions;
}

std::vector<std::vector<SampledFuture>> ParticleGenerator::Sample(
    const std::vector<ObservedMotion>& people, int frames, int count,
    const NormalSource& normal) const {
  std::vector<std::vector<SampledFuture>> futures(people.size());
  if (people.empty() || count <= 0) return futures;
  const std::vector<Trajectories> mean = MeanOfMembers(people, frames);
  std::vector<Trajectories> blend = mean;
  Blend(people, &blend);
  const int members = static_cast<int>(members_.size());
  for (int m = 0; m < members; ++m) {
    const int share = count / members + (m < count % members ? 1 : 0);
    if (share == 0) continue;
    ParticleRollout rollout(members_[m], people);
    rollout.Repeat(share);
    std::vector<Trajectories> motions = Empty(people, share, frames);
    Eigen::VectorXf log_likelihood = Eigen::VectorXf::Zero(static_cast<int>(motions.size()));
    Eigen::MatrixXf noise(layout_.num_coordinates(), log_likelihood.size());
    for (int t = 0; t < frames; ++t) {
      for (float& value : noise.reshaped()) value = static_cast<float>(normal());
      const Eigen::MatrixXf& poses = rollout.Step(&noise);
      log_likelihood += rollout.log_likelihood();
      for (size_t i = 0; i < motions.size(); ++i) {
        motions[i].col(t) = poses.col(static_cast<Eigen::Index>(i));
      }
    }
    for (size_t i = 0; i < motions.size(); ++i) {
      const size_t n = i / static_cast<size_t>(share);
      motions[i] += blend[n] - mean[n];
      Finish(people[n], &motions[i]);
      futures[n].push_back(
          {std::move(motions[i]), static_cast<double>(log_likelihood(static_cast<int>(i)))});
    }
  }
  return futures;
}

}  // namespace pushid
