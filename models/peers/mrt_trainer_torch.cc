// models: the trainer of MRT, in LibTorch.
#include <algorithm>
#include <map>

#include "models/peers/mrt_module_torch.h"
#include "models/peers/mrt_trainer.h"
#include "models/restoration/support_torch.h"

namespace pushid {
namespace {

constexpr int kScalingStride = 4;  // frames between the windows that scalings are taken from

int NumFrames(const MrtGroup& group) { return static_cast<int>(group.people.front().size()); }

struct Window {
  int group, last;  // the last given frame
  int said = 0;     // how many times the network has gone on by itself before
};

// Everybody of some windows is asked for.
struct AskedBatch {
  MrtBatch inputs;
  torch::Tensor ways, weights;  // [person, frame, pose row] in m; [person]
};

MrtBatch BatchOf(const std::vector<MrtView>& views) {
  std::vector<torch::Tensor> own, all, places, query;
  for (const MrtView& view : views) {
    all.push_back(ToTensor(view.tokens));
    own.push_back(all.back().slice(0, kMrtTokens * view.person, kMrtTokens * (view.person + 1)));
    places.push_back(ToTensor(view.places));
    query.push_back(ToTensor(view.query));
  }
  return {torch::stack(own), torch::stack(all), torch::stack(places), torch::stack(query)};
}

// What is given in a window, as the network has it after going on by itself, and the true frames to
// come.
std::vector<BodyMotion> PeopleIn(const MrtGroup& group, const Window& window, const Peer& peer) {
  const int begin = window.last + 1 - kMrtGiven - window.said * kMrtFrames;
  const int given = window.last + 1 - begin;
  std::vector<BodyMotion> people;
  for (const BodyMotion& motion : group.people) {
    people.emplace_back(motion.begin() + begin, motion.begin() + window.last + 1 + kMrtFrames);
  }
  if (window.said == 0) return people;
  const std::vector<BodyMotion> said = peer.Continue(people, given);
  for (size_t n = 0; n < people.size(); ++n) {
    std::copy(said[n].begin(), said[n].end(), people[n].begin());
  }
  return people;
}

AskedBatch Asked(const std::vector<MrtGroup>& groups, const std::vector<Window>& windows,
                 const MrtWeights& now) {
  const MrtPeer peer(now);
  std::vector<MrtView> views;
  std::vector<torch::Tensor> ways;
  std::vector<float> weights;
  for (const Window& window : windows) {
    const std::vector<BodyMotion> people = PeopleIn(groups[window.group], window, peer);
    const int last = static_cast<int>(people.front().size()) - 1 - kMrtFrames;
    for (int n = 0; n < static_cast<int>(people.size()); ++n) {
      views.push_back(Scaled(now.scalings, MrtViewOf(people, last, n)));
      ways.push_back(ToTensor(MrtWays(people[n], last)));
      weights.push_back(static_cast<float>(groups[window.group].weight));
    }
  }
  return {BatchOf(views), torch::stack(ways), torch::tensor(weights)};
}

// A person's own tokens are among everybody's too, but another encoder reads them.
void AddNoise(double size, MrtBatch* batch) {
  for (torch::Tensor* part : {&batch->all, &batch->own, &batch->query}) {
    *part = *part + size * torch::randn_like(*part);
  }
}

torch::Tensor DistanceLoss(const torch::Tensor& ways, const AskedBatch& batch) {
  constexpr double kTiny = 1e-12;  // m^2: a distance of zero has no derivative
  const torch::Tensor joints = (ways - batch.ways).view({ways.size(0), kMrtFrames, kBodyJoints, 3});
  const torch::Tensor distances = (joints.square().sum(3) + kTiny).sqrt().mean({1, 2});
  return (distances * batch.weights).sum() / batch.weights.sum();
}

// m, over the frames that were not given.
double DistanceAfter(const Peer& peer, const std::vector<MrtGroup>& groups) {
  double sum = 0.0;
  for (const MrtGroup& group : groups) {
    const int frames = NumFrames(group), people = static_cast<int>(group.people.size());
    const std::vector<BodyMotion> said = peer.Continue(group.people, frames);
    double of_group = 0.0;
    for (int n = 0; n < people; ++n) {
      for (int t = kMrtGiven; t < frames; ++t) {
        of_group += (said[n][t] - group.people[n][t]).colwise().norm().mean();
      }
    }
    sum += of_group / (people * (frames - kMrtGiven));
  }
  return sum / static_cast<double>(groups.size());
}

}  // namespace

bool HasWindow(const MrtGroup& group) { return NumFrames(group) >= kMrtGiven + kMrtFrames; }
bool HasFrameAfter(const MrtGroup& group) { return NumFrames(group) > kMrtGiven; }

struct MrtTrainer::Torch : EpochsRun<Run, Torch, MrtModule, MrtOptions> {
  std::vector<MrtGroup> training, held;
  std::vector<Window> windows;
  MrtScalings scalings;
  torch::Tensor mean, spread, to_ways;       // of the outputs
  std::vector<std::vector<Window>> batches;  // of this epoch

  // Some windows by chance, in batches of groups of one size.
  int64_t DrawBatches() override {
    batches.clear();
    const torch::Tensor order = torch::randperm(static_cast<int64_t>(windows.size()));
    const int64_t count = std::min<int64_t>(options.windows, order.size(0));
    std::map<size_t, std::vector<Window>> open;  // by the number of people
    const torch::Tensor steps = torch::randint(kMrtSteps, {count});
    for (int64_t i = 0; i < count; ++i) {
      Window window = windows[order[i].item<int64_t>()];
      const int most = (window.last + 1 - kMrtGiven) / kMrtFrames;  // frames before it
      window.said = std::min(most, static_cast<int>(steps[i].item<int64_t>()));
      std::vector<Window>& batch = open[training[window.group].people.size()];
      batch.push_back(window);
      if (static_cast<int>(batch.size()) < options.batch) continue;
      batches.push_back(std::move(batch));
      batch.clear();
    }
    for (auto& [people, batch] : open) {
      if (!batch.empty()) batches.push_back(std::move(batch));
    }
    return static_cast<int64_t>(batches.size());
  }

  torch::Tensor Ways(MrtModule* module, const MrtBatch& batch) const {
    return torch::matmul(to_ways, module->Forward(batch) * spread + mean);
  }

  torch::Tensor LossOf(int64_t b) override {
    AskedBatch batch = Asked(training, batches[b], network->Weights(scalings));
    AddNoise(options.input_noise, &batch.inputs);
    return DistanceLoss(Ways(network.get(), batch.inputs), batch);
  }

  double HeldLoss() override { return DistanceAfter(MrtPeer(network->Weights(scalings)), held); }
};

MrtTrainer::MrtTrainer(std::vector<MrtGroup> training, std::vector<MrtGroup> held,
                       const MrtOptions& options)
    : Trainer(std::make_unique<Torch>()) {
  StartTraining(options);
  Torch& t = As<Torch>();
  t.options = options;
  for (MrtGroup& group : training) {
    if (HasWindow(group)) t.training.push_back(std::move(group));
  }
  for (MrtGroup& group : held) {
    if (HasFrameAfter(group)) t.held.push_back(std::move(group));
  }
  std::vector<std::vector<BodyMotion>> people;
  for (size_t g = 0; g < t.training.size(); ++g) {
    people.push_back(t.training[g].people);
    for (int last = kMrtGiven - 1; last + kMrtFrames < NumFrames(t.training[g]); ++last) {
      t.windows.push_back({static_cast<int>(g), last});
    }
  }
  t.scalings = MrtScalingsOf(people, kScalingStride);
  t.mean = ToTensor(t.scalings.outputs.mean).view({kMrtFrames, kMrtPoseRows});
  t.spread = ToTensor(t.scalings.outputs.spread).view({kMrtFrames, kMrtPoseRows});
  t.to_ways = ToTensor(MrtWaysMatrix());
  auto network = std::make_shared<MrtModule>(options.size, options.dropout);
  t.Start(std::move(network), std::make_shared<MrtModule>(options.size, options.dropout));
}

MrtWeights MrtTrainer::Best() const {
  const Torch& t = As<Torch>();
  return t.best->Weights(t.scalings);
}

int64_t MrtTrainer::NumParameters() const { return NumNumbers(As<Torch>().network->parameters()); }

Eigen::MatrixXf MrtTrainer::LibTorchWays(const MrtView& view) const {
  torch::NoGradGuard no_grad;
  const Torch& t = As<Torch>();
  MrtModule* best = t.best.get();
  best->eval();
  const MrtBatch batch = BatchOf({Scaled(t.scalings, view)});
  return ToMatrix(t.Ways(best, batch)[0]).transpose();
}

}  // namespace pushid
