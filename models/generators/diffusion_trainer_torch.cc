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

// x_t, whose signal has the share a of [row, 1].
torch::Tensor Noised(const torch::Tensor& truth, const torch::Tensor& a,
                     const torch::Tensor& noise) {
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
    Eigen::MatrixXf of_rows = Eigen::MatrixXf::Zero(kMotionRows, kMotionRows);
    Eigen::MatrixXf sums = Eigen::MatrixXf::Zero(kBodyJoints, kMotionRows);
    for (int row = 0; row < kMotionRows; ++row) {
      of_rows(row, row % 3) = scales.joints[0];
      of_rows(row, row) = scales.joints[row / 3];
      sums(row / 3, row) = 1.0f;
    }
    joints_of_rows = ToTensor(of_rows), sums_of_joints = ToTensor(sums);
  }

  DiffusionTrainingOptions options;
  MotionScales scales;
  torch::Tensor joints_of_rows, sums_of_joints;  // [row, row], m; [row, joint]
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

  // times: of the groups, whose people are at the same stage of the way back.
  torch::Tensor Estimate(DiffusionModule* of, const torch::Tensor& noisy,
                         const std::vector<double>& times, const DiffusionBatch& batch) const {
    std::vector<torch::Tensor> features;
    for (size_t g = 0; g < times.size(); ++g) {
      features.insert(features.end(), batch.sizes[g], ToTensor(TimeFeatures(times[g])));
    }
    return of->Estimate(noisy, torch::stack(features), batch);
  }

  static torch::Tensor Shares(const std::vector<double>& times, const DiffusionBatch& batch) {
    std::vector<torch::Tensor> shares;
    for (size_t g = 0; g < times.size(); ++g) {
      shares.push_back(torch::full({batch.levels[0].group_rows[g], 1}, SignalShare(times[g])));
    }
    return torch::cat(shares);
  }

  // Distances of joints in m: a hip that is off takes all joints along.
  torch::Tensor JointError(const torch::Tensor& miss) const {
    constexpr double kSmooth = 1e-12;  // m^2; a root has no derivative at 0
    const torch::Tensor squares = torch::mm(miss, joints_of_rows).square();
    return (torch::mm(squares, sums_of_joints) + kSmooth).sqrt().mean(1, true);
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
      const int64_t later = miss.size(0) - 1;
      const torch::Tensor steps = miss.narrow(0, 1, later) - miss.narrow(0, 0, later);
      loss = loss + options.difference_weight *
                        weighted(steps.abs().mean(1, true), batch.step_weights.narrow(0, 1, later));
    }
    return loss;
  }

  double Step() override {
    const DiffusionBatch batch = batches.Draw(step);
    std::vector<double> times(batch.sizes.size());
    for (double& time : times) time = kDiffusionTime * torch::rand({1}).item<double>();
    const torch::Tensor noisy =
        Noised(batch.truth, Shares(times, batch), torch::randn_like(batch.truth));
    module->train();
    const torch::Tensor loss = Loss(Estimate(module.get(), noisy, times, batch), batch);
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
    const std::vector<double> times(batch.sizes.size(), kHeldTime);
    mean->eval();
    const torch::Tensor noisy = Noised(batch.truth, Shares(times, batch), noise);
    return Loss(Estimate(mean.get(), noisy, times, batch), batch).item<double>();
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
  t.optimizer = MakeOptimizer(t.module->parameters(), options.learning_rate, options.weight_decay);
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
  training.mean->eval();
  return ToMatrix(training.Estimate(training.mean.get(), ToTensor(noisy), {t}, batch)).transpose();
}

}  // namespace pushid
