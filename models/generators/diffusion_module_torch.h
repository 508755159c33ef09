// models: the diffusion network as a LibTorch module. Included by *_torch.cc files alone.
//
// Tensors are [person, channel, frame], the people of all groups of a step one after the other, so
// that groups of any size need no padding.
#pragma once

#include "models/generators/diffusion_network.h"
#include "models/generators/generator_trainers.h"
#include "models/restoration/support_torch.h"

namespace pushid {

struct DiffusionBatch {
  torch::Tensor truth;                            // [person, motion row, frame]; x_0
  torch::Tensor given;                            // [person, given row, frame]
  torch::Tensor weights;                          // [person, 1, frame], of the loss
  torch::Tensor statics;                          // [person, static row]
  std::vector<int64_t> sizes;                     // of the groups
  std::vector<std::vector<torch::Tensor>> views;  // [group][view], as PoolingWeights
};

class DiffusionConvolution : public torch::nn::Module {
 public:
  DiffusionConvolution(int64_t inputs, int64_t outputs, int64_t taps, int64_t stride, double size)
      : taps_(taps), stride_(stride) {
    const double bound = size / std::sqrt(static_cast<double>(inputs * taps));
    weight_ =
        register_parameter("weight", (2.0 * torch::rand({outputs, inputs, taps}) - 1.0) * bound);
    bias_ = register_parameter("bias", torch::zeros({outputs}));
  }
  torch::Tensor operator()(const torch::Tensor& x) const {
    const torch::Tensor padded = taps_ > 1 ? torch::constant_pad_nd(x, {taps_ - 1, 0}) : x;
    return torch::conv1d(padded, weight_, bias_, stride_);
  }
  DenseLayer Layer() const {
    return {ToMatrix(weight_.permute({0, 2, 1}).flatten(1)), ToVector(bias_)};
  }

 private:
  int64_t taps_, stride_;
  torch::Tensor weight_, bias_;
};

class DiffusionModule : public torch::nn::Module {
 public:
  DiffusionModule(const DiffusionStructure& structure, double dropout)
      : structure_(structure), dropout_(dropout) {
    first_time_ = Linear("time0", kTimeWidth, kConditionWidth);
    second_time_ = Linear("time1", kConditionWidth, kConditionWidth);
    first_static_ = Linear("static0", kStaticRows, kConditionWidth);
    second_static_ = Linear("static1", kConditionWidth, kConditionWidth);
    for (int b = 0; b < kDiffusionBlocks; ++b) AddBlock(b);
    for (int b = 0; b < kDiffusionLevels; ++b) {
      if (structure.AttendsAfter(b)) AddPool(b);
    }
    // It begins with the mean motion for everybody, not with noise to be unlearned.
    out_ = Convolution("out", kTaps, 1, kDownWidths[0], structure.NumMotion(), 0.0);
    direct_ = Convolution("direct", 1, 1, structure.NumInputs(), structure.NumMotion(), 0.0);
  }

  // time: [person, time feature]
  torch::Tensor Estimate(const torch::Tensor& noisy, const torch::Tensor& time,
                         const DiffusionBatch& batch) {
    const torch::Tensor input = torch::cat({noisy, batch.given}, 1);
    const auto dropped = [this](const torch::Tensor& x) {
      return torch::dropout(x, dropout_, is_training());
    };
    const torch::Tensor hidden = dropped(torch::silu(first_static_->forward(batch.statics)));
    const torch::Tensor of_time = second_time_->forward(torch::silu(first_time_->forward(time)));
    const torch::Tensor conditions = torch::silu(of_time + second_static_->forward(hidden));
    std::vector<torch::Tensor> levels;
    for (int b = 0; b < kDiffusionLevels; ++b) {
      levels.push_back(Apply(b, b == 0 ? input : levels.back(), conditions));
    }
    constexpr int kMiddle = kDiffusionLevels;
    torch::Tensor at =
        Apply(kMiddle, dropped(Pooled(kMiddle - 1, levels.back(), batch)), conditions);
    for (int level = kMiddle - 2; level >= 0; --level) {
      const torch::Tensor seen = Pooled(level, levels[level], batch);
      at = Apply(kDiffusionBlocks - 1 - level, torch::cat({Doubled(at), seen}, 1), conditions);
    }
    return (*out_)(Doubled(at)) + (*direct_)(input);
  }

  DiffusionNetwork Network(const MotionScales& scales) const {
    DiffusionNetwork network;
    network.structure = structure_;
    network.scales = scales;
    network.first_time = ToLayer(first_time_);
    network.second_time = ToLayer(second_time_);
    network.first_static = ToLayer(first_static_);
    network.second_static = ToLayer(second_static_);
    for (const Block& block : blocks_) {
      network.blocks.push_back(
          {block.first->Layer(), block.second->Layer(), block.skip->Layer(), ToLayer(block.film)});
    }
    for (const Pool& pool : pools_) {
      network.pools.push_back(
          {pool.query->Layer(), pool.key->Layer(), pool.value->Layer(), pool.mixed->Layer()});
    }
    network.out = out_->Layer();
    network.direct = direct_->Layer();
    return network;
  }

 private:
  using ConvolutionPointer = std::shared_ptr<DiffusionConvolution>;
  struct Block {
    ConvolutionPointer first, second, skip;
    torch::nn::Linear film{nullptr};
  };
  struct Pool {
    ConvolutionPointer query, key, value, mixed;
  };
  static constexpr double kSmallStart = 0.3;  // of what is added to a block's way around

  torch::nn::Linear Linear(const std::string& name, int inputs, int outputs) {
    return register_module(name, torch::nn::Linear(inputs, outputs));
  }
  ConvolutionPointer Convolution(const std::string& name, int taps, int stride, int inputs,
                                 int outputs, double size) {
    return register_module(
        name, std::make_shared<DiffusionConvolution>(inputs, outputs, taps, stride, size));
  }

  void AddBlock(int b) {
    const BlockWidths widths = WidthsOf(b, structure_);
    const std::string name = "block" + std::to_string(b);
    const int stride = b < kDiffusionLevels ? 2 : 1;
    Block block;
    block.first = Convolution(name + "_first", kTaps, stride, widths.in, widths.out, 1.0);
    block.second = Convolution(name + "_second", kTaps, 1, widths.out, widths.out, kSmallStart);
    block.skip = Convolution(name + "_skip", 1, stride, widths.in, widths.out, 1.0);
    block.film = Linear(name + "_film", kConditionWidth, 2 * widths.out);
    torch::nn::init::zeros_(block.film->weight);
    torch::nn::init::zeros_(block.film->bias);
    blocks_.push_back(block);
  }
  void AddPool(int block) {
    const int width = WidthsOf(block, structure_).out;
    const std::string name = "pool" + std::to_string(block);
    const auto layer = [&](const char* of) {
      return Convolution(name + of, 1, 1, width, width, 1.0);
    };
    pools_.push_back({layer("_query"), layer("_key"), layer("_value"), layer("_mixed")});
  }

  torch::Tensor Apply(int b, const torch::Tensor& x, const torch::Tensor& conditions) {
    Block& block = blocks_[b];
    const std::vector<torch::Tensor> film =
        block.film->forward(conditions).unsqueeze(2).chunk(2, 1);
    const torch::Tensor inner = torch::silu((*block.first)(x)) * (1.0 + film[0]) + film[1];
    return torch::silu((*block.second)(inner)) + (*block.skip)(x);
  }

  torch::Tensor Pooled(int block, const torch::Tensor& y, const DiffusionBatch& batch) const {
    if (!structure_.PoolsAfter(block)) return y;
    const std::vector<torch::Tensor> groups = y.split_with_sizes(batch.sizes, 0);
    std::vector<torch::Tensor> seen;
    for (size_t g = 0; g < groups.size(); ++g) {
      if (structure_.AttendsAfter(block)) {
        const size_t pool = structure_.join == SocialJoin::kBottleneck ? 0 : block;
        seen.push_back(Attended(pools_[pool], groups[g]));
        continue;
      }
      std::vector<torch::Tensor> sums;
      for (const torch::Tensor& view : batch.views[g]) {
        sums.push_back(torch::matmul(view, groups[g].flatten(1)).view_as(groups[g]));
      }
      seen.push_back(torch::cat(sums, 1));
    }
    return torch::cat({y, torch::cat(seen, 0)}, 1);
  }

  // A softmax over everybody, frame by frame.
  static torch::Tensor Attended(const Pool& pool, const torch::Tensor& y) {
    const int64_t people = y.size(0), width = y.size(1), frames = y.size(2);
    // [frame, head, person, channel]
    const auto by_head = [&](const ConvolutionPointer& layer) {
      return (*layer)(y).view({people, kHeads, width / kHeads, frames}).permute({3, 1, 0, 2});
    };
    const double scale = 1.0 / std::sqrt(static_cast<double>(width / kHeads));
    const torch::Tensor scores =
        scale * torch::matmul(by_head(pool.query), by_head(pool.key).transpose(2, 3));
    const torch::Tensor seen = torch::matmul(torch::softmax(scores, 3), by_head(pool.value));
    return (*pool.mixed)(seen.permute({2, 1, 3, 0}).reshape({people, width, frames}));
  }

  static torch::Tensor Doubled(const torch::Tensor& x) {
    const torch::Tensor before = torch::cat({x.narrow(2, 0, 1), x.narrow(2, 0, x.size(2) - 1)}, 2);
    return torch::stack({0.5 * (before + x), x}, 3).flatten(2);
  }

  DiffusionStructure structure_;
  double dropout_;
  torch::nn::Linear first_time_{nullptr}, second_time_{nullptr};
  torch::nn::Linear first_static_{nullptr}, second_static_{nullptr};
  std::vector<Block> blocks_;
  std::vector<Pool> pools_;
  ConvolutionPointer out_, direct_;
};

class DiffusionBatches {
 public:
  DiffusionBatches(const std::vector<ObservedGroup>& groups, const MotionScales& scales,
                   const DiffusionTrainingOptions& options);

  bool empty() const { return groups_.empty() && alone_.empty(); }
  // Of a training step, with all that is random in it.
  DiffusionBatch Draw(int step) const;
  // Of these groups as they are, of which the first frame is shown; at most `most`.
  DiffusionBatch AsTheyAre(int most) const;

 private:
  ObservedGroup Varied(const ObservedGroup& group) const;
  void AddBystanders(ObservedGroup* group) const;

  const MotionScales scales_;
  const DiffusionTrainingOptions& options_;
  std::vector<ObservedGroup> groups_, alone_;
};

// One group's features as a batch of it alone.
DiffusionBatch BatchOf(const GroupFeatures& features, const DiffusionStructure& structure);

}  // namespace pushid
