// models: the diffusion network as a LibTorch module. Included by *_torch.cc files alone.
//
// Tensors are [row, channel], a row for every frame (row_maps_torch.h): those of the first person,
// then those of the next, the people of all groups of a step one after the other.
#pragma once

#include "models/generators/diffusion_network.h"
#include "models/generators/generator_trainers.h"
#include "models/generators/row_maps_torch.h"

namespace pushid {

// Where rows of a level come from. Level l has every 2^l-th frame.
struct LevelMaps {
  RowMapPointer taps;  // the three frames that a convolution sees, one after the other; from the
                       // level above, with twice the frames
  RowMapPointer
      tapped;  // sums of three rows a frame, those that it adds to itself and the next two
  RowMapPointer doubled;            // from the level below
  RowMapPointer people;             // from a row for every person
  RowMapPointer seen;               // of every view, one after the other
  std::vector<int64_t> group_rows;  // rows of every group
};

struct DiffusionBatch {
  torch::Tensor truth;                              // [row, motion row]; x_0
  torch::Tensor given;                              // [row, given row]
  torch::Tensor weights;                            // [row, 1], of the loss
  torch::Tensor step_weights;                       // the same, 0 where a motion begins
  torch::Tensor statics;                            // [person, static row]
  std::vector<int64_t> sizes;                       // of the groups
  std::vector<int64_t> frames;                      // of their motions
  std::vector<std::vector<Eigen::MatrixXf>> views;  // [group][view], as PoolingWeights
  std::vector<LevelMaps> levels;
};

class DiffusionConvolution : public torch::nn::Module {
 public:
  // halves: it takes every second frame, and is given rows that hold all it sees.
  DiffusionConvolution(int64_t inputs, int64_t outputs, int64_t taps, bool halves, double size)
      : taps_(taps), outputs_(outputs), halves_(halves) {
    const double bound = size / std::sqrt(static_cast<double>(inputs * taps));
    const torch::Tensor drawn = (2.0 * torch::rand({outputs, inputs, taps}) - 1.0) * bound;
    weight_ = register_parameter("weight", halves ? drawn.permute({0, 2, 1}).flatten(1)
                                                  : drawn.permute({2, 0, 1}).flatten(0, 1));
    bias_ = register_parameter("bias", torch::zeros({outputs}));
  }
  torch::Tensor operator()(const torch::Tensor& x) const {
    return torch::linear(x, weight_, bias_);
  }
  torch::Tensor operator()(const torch::Tensor& x, const LevelMaps& at) const {
    const torch::Tensor by_tap = torch::linear(x, weight_).view({-1, outputs_});
    return Mapped(by_tap, at.tapped).add_(bias_);
  }
  DenseLayer Layer() const {
    const torch::Tensor by_output =
        halves_ ? weight_ : weight_.view({taps_, outputs_, -1}).transpose(0, 1).flatten(1);
    return {ToMatrix(by_output), ToVector(bias_)};
  }

 private:
  int64_t taps_, outputs_;
  bool halves_;
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
    out_ = Convolution("out", kTaps, false, kDownWidths[0], structure.NumMotion(), 0.0);
    direct_ = Convolution("direct", 1, false, structure.NumInputs(), structure.NumMotion(), 0.0);
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
      const torch::Tensor& above = b == 0 ? input : levels.back();
      const LevelMaps& maps = batch.levels[b + 1];
      const torch::Tensor taps = Mapped(above, maps.taps).view({-1, kTaps * above.size(1)});
      levels.push_back(Finished(b, (*blocks_[b].first)(taps),
                                taps.narrow(1, (kTaps - 1) * above.size(1), above.size(1)),
                                conditions, maps));
    }
    torch::Tensor at = dropped(Pooled(kDiffusionLevels - 1, levels.back(), batch));
    for (int level = kDiffusionLevels - 1; level >= 0; --level) {
      const LevelMaps& maps = batch.levels[level + 1];
      const int b = kDiffusionBlocks - 1 - level;
      if (level < kDiffusionLevels - 1) {
        at = torch::cat({Mapped(at, maps.doubled), Pooled(level, levels[level], batch)}, 1);
      }
      at = Finished(b, (*blocks_[b].first)(at, maps), at, conditions, maps);
    }
    return (*out_)(Mapped(at, batch.levels[0].doubled), batch.levels[0]) + (*direct_)(input);
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
  ConvolutionPointer Convolution(const std::string& name, int taps, bool halves, int inputs,
                                 int outputs, double size) {
    return register_module(
        name, std::make_shared<DiffusionConvolution>(inputs, outputs, taps, halves, size));
  }

  void AddBlock(int b) {
    const BlockWidths widths = WidthsOf(b, structure_);
    const std::string name = "block" + std::to_string(b);
    Block block;
    block.first =
        Convolution(name + "_first", kTaps, b < kDiffusionLevels, widths.in, widths.out, 1.0);
    block.second = Convolution(name + "_second", kTaps, false, widths.out, widths.out, kSmallStart);
    block.skip = Convolution(name + "_skip", 1, false, widths.in, widths.out, 1.0);
    block.film = Linear(name + "_film", kConditionWidth, 2 * widths.out);
    torch::nn::init::zeros_(block.film->weight);
    torch::nn::init::zeros_(block.film->bias);
    blocks_.push_back(block);
  }
  void AddPool(int block) {
    const int width = WidthsOf(block, structure_).out;
    const std::string name = "pool" + std::to_string(block);
    const auto layer = [&](const char* of) {
      return Convolution(name + of, 1, false, width, width, 1.0);
    };
    pools_.push_back({layer("_query"), layer("_key"), layer("_value"), layer("_mixed")});
  }

  // A block from its first convolution on; x: what came in, of the frames that go out.
  torch::Tensor Finished(int b, const torch::Tensor& first, const torch::Tensor& x,
                         const torch::Tensor& conditions, const LevelMaps& maps) {
    Block& block = blocks_[b];
    const std::vector<torch::Tensor> film = block.film->forward(conditions).chunk(2, 1);
    const torch::Tensor inner = torch::addcmul(Mapped(film[1], maps.people), torch::silu(first),
                                               Mapped(1.0 + film[0], maps.people));
    return torch::silu((*block.second)(inner, maps)) + (*block.skip)(x);
  }

  torch::Tensor Pooled(int block, const torch::Tensor& y, const DiffusionBatch& batch) const {
    if (!structure_.PoolsAfter(block)) return y;
    const LevelMaps& maps = batch.levels[block + 1];
    if (!structure_.AttendsAfter(block)) {
      const torch::Tensor seen = Mapped(y, maps.seen);
      return torch::cat({y, seen.view({y.size(0), structure_.NumViews() * y.size(1)})}, 1);
    }
    const Pool& pool = pools_[structure_.join == SocialJoin::kBottleneck ? 0 : block];
    const std::vector<torch::Tensor> groups = y.split_with_sizes(maps.group_rows, 0);
    std::vector<torch::Tensor> seen;
    for (size_t g = 0; g < groups.size(); ++g) {
      seen.push_back(Attended(pool, groups[g], batch.sizes[g]));
    }
    return torch::cat({y, torch::cat(seen, 0)}, 1);
  }

  // A softmax over everybody, frame by frame.
  static torch::Tensor Attended(const Pool& pool, const torch::Tensor& y, int64_t people) {
    const int64_t width = y.size(1);
    // [frame, head, person, channel]
    const auto by_head = [&](const ConvolutionPointer& layer) {
      return (*layer)(y).view({people, -1, kHeads, width / kHeads}).permute({1, 2, 0, 3});
    };
    const double scale = 1.0 / std::sqrt(static_cast<double>(width / kHeads));
    const torch::Tensor scores =
        scale * torch::matmul(by_head(pool.query), by_head(pool.key).transpose(2, 3));
    const torch::Tensor seen = torch::matmul(torch::softmax(scores, 3), by_head(pool.value));
    return (*pool.mixed)(seen.permute({2, 0, 1, 3}).reshape({y.size(0), width}));
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
