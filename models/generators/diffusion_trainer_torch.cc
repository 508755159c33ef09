// models: the trainer of the diffusion network, in LibTorch.
#include <algorithm>

#include "models/generators/diffusion_generator.h"
#include "models/generators/diffusion_module_torch.h"
#include "models/generators/generator_trainers.h"

namespace pushid {
namespace {

constexpr double kRateFloor = 0.02;  // share of the largest
constexpr int kHeldGroups = 32;
constexpr double kHeldTime = 0.9 * kDiffusionTime;  // nearly all of it noise
constexpr uint64_t kHeldSeed = 1;

double RateShareToFloor(int step, int steps, int warm_up) {
  const int up = std::min(warm_up, std::max(1, steps / 2));
  if (step < up) return (step + 1.0) / up;
  const double down = static_cast<double>(step - up) / std::max(1, steps - up);
  return kRateFloor + (1.0 - kRateFloor) * 0.5 * (1.0 + std::cos(M_PI * down));
}

MotionScales ScalesOf(const std::vector<ObservedGroup>& learnt, MotionFrame frame) {
  MotionScales scales =
      frame == MotionFrame::kOwn ? OwnFrameScalesOf(learnt) : MotionScales(JointScalesOf(learnt));
  scales.first_pose = FirstPoseScalingOf(learnt);
  return scales;
}

// x_t, whose signal has the share a of [person].
torch::Tensor Noised(const torch::Tensor& truth, const torch::Tensor& share,
                     const torch::Tensor& noise) {
  const torch::Tensor a = share.view({-1, 1, 1});
  return a.sqrt() * truth + (1.0 - a).sqrt() * noise;
}

}  // namespace

struct DiffusionTrainer::Torch : StepsRun<Run, Torch> {
  Torch(const std::vector<ObservedGroup>& learnt, const std::vector<ObservedGroup>& held,
        const DiffusionTrainingOptions& given)
      : options(given),
        scales(ScalesOf(learnt, given.structure.frame)),
        batches(learnt, scales, options),
        held_batches(held, scales, options) {
    joint_scales = torch::zeros({kBodyJoints});
    for (int j = 0; j < kBodyJoints; ++j) joint_scales[j] = scales.joints[j];
  }

  DiffusionTrainingOptions options;
  MotionScales scales;
  torch::Tensor joint_scales;
  DiffusionBatches batches, held_batches;
  std::shared_ptr<DiffusionModule> module, mean;  // mean: of the weights
  std::unique_ptr<torch::optim::AdamW> optimizer;

  template <typename Fields>
  void Keep(Fields* fields) {
    fields->Part("module", module.get());
    fields->Part("mean", mean.get());
    fields->Part("optimizer", optimizer.get());
    fields->Numbers("step", &step);
  }

  // time: [person].
  torch::Tensor Estimate(DiffusionModule* of, const torch::Tensor& noisy, const torch::Tensor& time,
                         const DiffusionBatch& batch) const {
    std::vector<torch::Tensor> features;
    for (int64_t n = 0; n < time.size(0); ++n) {
      features.push_back(ToTensor(TimeFeatures(time[n].item<double>())));
    }
    return of->Estimate(noisy, torch::stack(features), batch);
  }

  // Distances of joints in m: a hip that is off takes all joints along.
  torch::Tensor JointError(const torch::Tensor& miss) const {
    const torch::Tensor joints = miss.view({miss.size(0), kBodyJoints, 3, miss.size(2)}) *
                                 joint_scales.view({1, kBodyJoints, 1, 1});
    const torch::Tensor hip = joints.narrow(1, 0, 1);
    const torch::Tensor others = joints.narrow(1, 1, kBodyJoints - 1) + hip;
    constexpr double kSmooth = 1e-12;  // m^2; a root has no derivative at 0
    return (torch::cat({hip, others}, 1).square().sum(2) + kSmooth).sqrt().mean(1, true);
  }

  torch::Tensor Loss(const torch::Tensor& estimate, const DiffusionBatch& batch) const {
    const torch::Tensor miss = estimate - batch.truth;
    const auto weighted = [](const torch::Tensor& by_frame, const torch::Tensor& weights) {
      return (by_frame * weights).sum() / weights.sum();
    };
    torch::Tensor loss = weighted(miss.abs().mean(1, true), batch.weights);
    if (options.joint_weight > 0.0) {
      loss = loss + options.joint_weight * weighted(JointError(miss), batch.weights);
    }
    if (options.difference_weight > 0.0) {
      const int64_t frames = miss.size(2);
      const torch::Tensor steps = miss.narrow(2, 1, frames - 1) - miss.narrow(2, 0, frames - 1);
      loss = loss + options.difference_weight *
                        weighted(steps.abs().mean(1, true), batch.weights.narrow(2, 1, frames - 1));
    }
    return loss;
  }

  double Step() override {
    const DiffusionBatch batch = batches.Draw(step);
    // One time for a group: its people are at the same stage of the way back.
    const torch::Tensor by_group =
        kDiffusionTime * torch::rand({static_cast<int64_t>(batch.sizes.size())});
    const torch::Tensor time = by_group.repeat_interleave(torch::tensor(batch.sizes));
    torch::Tensor share = torch::empty_like(time);
    for (int64_t n = 0; n < time.size(0); ++n) share[n] = SignalShare(time[n].item<double>());
    const torch::Tensor noisy = Noised(batch.truth, share, torch::randn_like(batch.truth));
    module->train();
    const torch::Tensor loss = Loss(Estimate(module.get(), noisy, time, batch), batch);
    SetLearningRate(optimizer.get(),
                    options.learning_rate * RateShareToFloor(step, options.steps, options.warm_up));
    Improve(optimizer.get(), loss, module->parameters(), options.clip);
    Average();
    return loss.item<double>();
  }

  // Early means forget faster: they would keep the random start.
  void Average() {
    torch::NoGradGuard no_grad;
    const double keep = std::min(options.averaging, (1.0 + step) / (10.0 + step));
    const auto now = module->parameters();
    const auto means = mean->parameters();
    for (size_t i = 0; i < now.size(); ++i) means[i].mul_(keep).add_(now[i], 1.0 - keep);
  }

  // From nothing but noise, the first frame and the push.
  double HeldLoss(int) override {
    if (held_batches.empty()) return std::nan("");
    torch::NoGradGuard no_grad;
    const DiffusionBatch batch = held_batches.AsTheyAre(kHeldGroups);
    auto generator = at::detail::createCPUGenerator(kHeldSeed);
    const torch::Tensor noise = torch::randn(batch.truth.sizes(), generator);
    const torch::Tensor time = torch::full({batch.truth.size(0)}, kHeldTime);
    const torch::Tensor share = torch::full_like(time, SignalShare(kHeldTime));
    mean->eval();
    return Loss(Estimate(mean.get(), Noised(batch.truth, share, noise), time, batch), batch)
        .item<double>();
  }

  int AllSteps() const override { return options.steps; }
  const char* Stage(int) const override { return "diffusion"; }
};

DiffusionTrainer::DiffusionTrainer(const std::vector<ObservedGroup>& learnt,
                                   const std::vector<ObservedGroup>& held,
                                   const DiffusionTrainingOptions& options)
    : Trainer(std::make_unique<Torch>(learnt, held, options)) {
  StartTraining(options);
  Torch& t = As<Torch>();
  t.module = std::make_shared<DiffusionModule>(options.structure, options.dropout);
  t.mean = std::make_shared<DiffusionModule>(options.structure, options.dropout);
  CopyWeights(*t.module, t.mean.get());
  t.mean->eval();
  t.optimizer = std::make_unique<torch::optim::AdamW>(
      t.module->parameters(),
      torch::optim::AdamWOptions(options.learning_rate).weight_decay(options.weight_decay));
}

DiffusionNetwork DiffusionTrainer::Network() const {
  const Torch& t = As<Torch>();
  return t.mean->Network(t.scales);
}

Eigen::MatrixXf DiffusionTrainer::Estimate(const GroupFeatures& features,
                                           const Eigen::MatrixXf& noisy, double t) {
  torch::NoGradGuard no_grad;
  const Torch& training = As<Torch>();
  const DiffusionBatch batch = BatchOf(features, training.options.structure);
  const int64_t frames = features.frames;
  const torch::Tensor all =
      ToTensor(noisy).view({features.people, frames, noisy.rows()}).transpose(1, 2);
  const torch::Tensor padded = torch::constant_pad_nd(all, {0, batch.given.size(2) - frames});
  const torch::Tensor time = torch::full({features.people}, t);
  training.mean->eval();
  const torch::Tensor estimate = training.Estimate(training.mean.get(), padded, time, batch);
  return ToMatrix(estimate.narrow(2, 0, frames).transpose(1, 2).flatten(0, 1)).transpose();
}

}  // namespace pushid
