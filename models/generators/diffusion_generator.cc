// models: groups sampled and finished.
#include "models/generators/diffusion_generator.h"

#include <numeric>
#include <utility>

namespace pushid {
namespace {

// Who comes first, second, ... from the left to the right, and from the back to the front.
std::vector<int> ByPlace(const std::vector<ObservedMotion>& people) {
  std::vector<int> order(people.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&people](int a, int b) {
    const Eigen::Vector2f &p = people[a].place, &q = people[b].place;
    return std::pair(p.x(), p.y()) < std::pair(q.x(), q.y());
  });
  return order;
}

void Draw(const std::vector<int>& order, const NormalSource& normal, Eigen::MatrixXf* noise) {
  const Eigen::Index frames = noise->cols() / static_cast<Eigen::Index>(order.size());
  for (const int n : order) {
    for (float& value : noise->middleCols(n * frames, frames).reshaped()) {
      value = static_cast<float>(normal());
    }
  }
}

constexpr double kLastTime = 1.0;  // of the last estimate: hardly any noise is left

Pose PoseOf(const Trajectories& frames, Eigen::Index t) {
  return frames.col(t).cast<double>().reshaped(3, kBodyJoints);
}

// From frame `first` on, steps fade to 1/e in so many frames.
void Settle(int first, double frames, Trajectories* motion) {
  const Trajectories before = *motion;
  for (Eigen::Index t = first; t < motion->cols(); ++t) {
    const double fade = std::exp(-static_cast<double>(t - first) / frames);
    motion->col(t) =
        motion->col(t - 1) + static_cast<float>(fade) * (before.col(t) - before.col(t - 1));
  }
}

const GroupChange kMirror = {true};

std::vector<Trajectories> InMirror(const std::vector<Trajectories>& motions) {
  std::vector<ObservedMotion> people(motions.size());
  for (size_t n = 0; n < motions.size(); ++n) people[n].frames = motions[n];
  people = Changed(people, kMirror);
  std::vector<Trajectories> mirrored;
  for (ObservedMotion& person : people) mirrored.push_back(std::move(person.frames));
  return mirrored;
}

int ObservedFrames(const std::vector<ObservedMotion>& people) {
  return static_cast<int>(people.front().frames.cols());
}

}  // namespace

DiffusionGenerator::DiffusionGenerator(ParticleLayout layout, std::vector<DiffusionNetwork> members,
                                       double dt, const DiffusionGeneratorOptions& options,
                                       std::function<NormalSource()> noise)
    : layout_(std::move(layout)),
      members_(std::move(members)),
      dt_(dt),
      options_(options),
      noise_(std::move(noise)) {}

std::vector<Trajectories> DiffusionGenerator::SampleWhole(const std::vector<ObservedMotion>& people,
                                                          const DiffusionNetwork& network,
                                                          int frames,
                                                          const NormalSource& normal) const {
  const int count = static_cast<int>(people.size());
  const int seen = ObservedFrames(people);
  const GroupDenoiser denoise(network, FeaturesOf(people, network.scales, seen, frames, dt_));
  std::vector<Eigen::MatrixXf> past;
  for (const ObservedMotion& person : people) past.push_back(MotionRows(person, network.scales));
  const std::vector<int> order = ByPlace(people);
  Eigen::MatrixXf fresh(network.structure.NumMotion(), count * frames), estimate;
  Draw(order, normal, &fresh);
  Eigen::MatrixXf noisy = fresh;
  for (int k = 0; k < options_.steps; ++k) {
    const double step = (kDiffusionTime - kLastTime) / std::max(1, options_.steps - 1);
    const double t = kDiffusionTime - k * step;
    const double u = k + 1 == options_.steps ? 0.0 : t - step;
    estimate = denoise.Estimate(noisy, t);
    // The last estimate keeps what it makes of the frames seen: the seam is what it misses there.
    if (u <= 0.0) break;
    for (int n = 0; n < count; ++n) estimate.middleCols(n * frames, seen) = past[n];
    const BackwardStep back = StepBack(options_.sampler, t, u);
    noisy = static_cast<float>(back.estimate) * estimate + static_cast<float>(back.noisy) * noisy;
    if (back.noise <= 0.0) continue;
    Draw(order, normal, &fresh);
    noisy += static_cast<float>(back.noise) * fresh;
  }
  std::vector<Trajectories> motions;
  for (int n = 0; n < count; ++n) {
    motions.push_back(
        FromMotionRows(estimate.middleCols(n * frames, frames), people[n], network.scales));
  }
  for (Trajectories& motion : motions) {
    if (options_.settle == Settling::kNone) break;
    Settle(options_.learnt_frames, options_.settling / dt_, &motion);
  }
  return motions;
}

Trajectories DiffusionGenerator::Finished(const ObservedMotion& person, Trajectories motion) const {
  const Eigen::Index seen = person.frames.cols();
  if (person.pendulum.size() > 0 && options_.blend > 0.0) {
    const Eigen::MatrixXf way = static_cast<float>(options_.blend) *
                                (person.pendulum.leftCols(motion.cols()) - motion.topRows(3));
    motion += way.replicate<kBodyJoints, 1>();
  }
  RestorationInput body;
  body.first_pose = PoseOf(person.frames, 0);
  body.dt = dt_;
  for (Eigen::Index t = 0; t < seen && seen > 1; ++t) body.seen.push_back(PoseOf(person.frames, t));
  BodyMotion poses;
  for (Eigen::Index t = 0; t < motion.cols(); ++t) poses.push_back(PoseOf(motion, t));
  Finish(body, options_.postprocess, &poses);
  for (Eigen::Index t = 0; t < motion.cols(); ++t) {
    motion.col(t) = poses[static_cast<size_t>(t)].reshaped().cast<float>();
  }
  return motion.rightCols(motion.cols() - seen);
}

std::vector<Trajectories> DiffusionGenerator::SampledMean(const std::vector<ObservedMotion>& people,
                                                          int frames) const {
  const NormalSource normal = noise_();
  const std::vector<ObservedMotion> mirrored = Changed(people, kMirror);
  std::vector<Trajectories> mean(people.size(), Trajectories::Zero(kMotionRows, frames));
  for (int k = 0; k < options_.averaged; ++k) {
    const bool other = options_.mirrored && k % 2 == 1;
    const DiffusionNetwork& network = Member(options_.mirrored ? k / 2 : k);
    std::vector<Trajectories> sample =
        SampleWhole(other ? mirrored : people, network, frames, normal);
    if (other) sample = InMirror(sample);
    for (size_t n = 0; n < people.size(); ++n) mean[n] += sample[n];
  }
  for (Trajectories& motion : mean) motion /= static_cast<float>(options_.averaged);
  return mean;
}

std::vector<Trajectories> DiffusionGenerator::Forecast(const std::vector<ObservedMotion>& people,
                                                       int frames) const {
  if (people.empty()) return {};
  const int whole = ObservedFrames(people) + frames;
  std::vector<Trajectories> mean;
  if (options_.sampled && !options_.sampled->empty()) mean = *options_.sampled;
  if (mean.empty()) mean = SampledMean(people, whole);
  if (options_.sampled) *options_.sampled = mean;
  for (size_t n = 0; n < people.size(); ++n) mean[n] = Finished(people[n], std::move(mean[n]));
  return mean;
}

}  // namespace pushid
