// models: training of the diffusion network in LibTorch: sparse maps between rows, the network as a
// module, batches of groups, and the trainer.
#include <Eigen/SparseCore>
#include <algorithm>

#include "models/generators/diffusion_generator.h"
#include "models/generators/generator_trainers.h"
#include "models/restoration/support_torch.h"

namespace pushid {
namespace {

// A sparse map of rows: `sums` has the weights of the input rows for each output row. Filled row by
// row.
struct RowMap : torch::CustomClassHolder {
  Eigen::SparseMatrix<float, Eigen::RowMajor> sums;

  RowMap(int64_t out, int64_t in) : sums(out, in) {}
  void BeginRow() { sums.startVec(++row_); }
  void Add(int64_t in, float weight = 1.0f) { sums.insertBack(row_, in) = weight; }

 private:
  int64_t row_ = -1;
};
using RowMapPointer = c10::intrusive_ptr<RowMap>;

using RowMajorMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
Eigen::Map<RowMajorMatrix> AsMatrix(const Tensor& rows) {
  return {rows.data_ptr<float>(), rows.size(0), rows.size(1)};
}

// Applies a RowMap to [row, channel].
class MappedRows : public torch::autograd::Function<MappedRows> {
 public:
  static Tensor forward(torch::autograd::AutogradContext* context, const Tensor& x,
                        const RowMapPointer& map) {
    context->saved_data["map"] = c10::IValue::make_capsule(map);
    const Tensor to = torch::empty({map->sums.rows(), x.size(1)});
    const Tensor from = x.contiguous();
    AsMatrix(to).noalias() = map->sums * AsMatrix(from);
    return to;
  }

  static torch::autograd::variable_list backward(torch::autograd::AutogradContext* context,
                                                 const torch::autograd::variable_list& gradients) {
    const auto map =
        c10::static_intrusive_pointer_cast<RowMap>(context->saved_data["map"].toCapsule());
    const Tensor from = gradients[0].contiguous();
    const Tensor to = torch::empty({map->sums.cols(), from.size(1)});
    AsMatrix(to).noalias() = map->sums.transpose() * AsMatrix(from);
    return {to, Tensor()};
  }
};

Tensor Mapped(const Tensor& x, const RowMapPointer& map) { return MappedRows::apply(x, map); }

// The row maps of a level. Level l has every 2^l-th frame.
struct LevelMaps {
  RowMapPointer taps;               // input frames of a convolution with stride 2, level above
  RowMapPointer tapped;             // sums of the three products of a convolution with stride 1
  RowMapPointer doubled;            // from the level below, frames doubled
  RowMapPointer people;             // from one row per person
  RowMapPointer seen;               // sums over the others, one row per view
  std::vector<int64_t> group_rows;  // number of rows of each group
};

struct DiffusionBatch {
  Tensor truth;                                     // [row, motion row]; x_0
  Tensor given;                                     // [row, given row]
  Tensor weights;                                   // [row, 1], of the loss
  Tensor step_weights;                              // the same, 0 where a motion begins
  Tensor statics;                                   // [person, static row]
  std::vector<int64_t> sizes;                       // of the groups
  std::vector<int64_t> frames;                      // of their motions
  std::vector<std::vector<Eigen::MatrixXf>> views;  // [group][view], as PoolingWeights
  std::vector<LevelMaps> levels;
};

class DiffusionConvolution : public torch::nn::Module {
 public:
  // halves: stride 2; its input rows hold all taps of a frame.
  DiffusionConvolution(int64_t inputs, int64_t outputs, int64_t taps, bool halves, double size)
      : taps_(taps), outputs_(outputs), halves_(halves) {
    const double bound = size / std::sqrt(static_cast<double>(inputs * taps));
    const Tensor drawn = (2.0 * torch::rand({outputs, inputs, taps}) - 1.0) * bound;
    weight_ = register_parameter("weight", halves ? drawn.permute({0, 2, 1}).flatten(1)
                                                  : drawn.permute({2, 0, 1}).flatten(0, 1));
    bias_ = register_parameter("bias", torch::zeros({outputs}));
  }
  Tensor operator()(const Tensor& x) const { return torch::linear(x, weight_, bias_); }
  Tensor operator()(const Tensor& x, const LevelMaps& at) const {
    const Tensor by_tap = torch::linear(x, weight_).view({-1, outputs_});
    return Mapped(by_tap, at.tapped).add_(bias_);
  }
  DenseLayer Layer() const {
    const Tensor by_output =
        halves_ ? weight_ : weight_.view({taps_, outputs_, -1}).transpose(0, 1).flatten(1);
    return {ToMatrix(by_output), ToVector(bias_)};
  }

 private:
  int64_t taps_, outputs_;
  bool halves_;
  Tensor weight_, bias_;
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
    // Zero weights: training begins with the mean motion instead of noise.
    out_ = Convolution("out", kTaps, false, kDownWidths[0], structure.NumMotion(), 0.0);
    direct_ = Convolution("direct", 1, false, structure.NumInputs(), structure.NumMotion(), 0.0);
  }

  // time: [person, time feature]
  Tensor Estimate(const Tensor& noisy, const Tensor& time, const DiffusionBatch& batch) {
    const Tensor input = torch::cat({noisy, batch.given}, 1);
    const auto dropped = [this](const Tensor& x) {
      return torch::dropout(x, dropout_, is_training());
    };
    const Tensor hidden = dropped(torch::silu(first_static_->forward(batch.statics)));
    const Tensor of_time = second_time_->forward(torch::silu(first_time_->forward(time)));
    const Tensor conditions = torch::silu(of_time + second_static_->forward(hidden));
    std::vector<Tensor> levels;
    for (int b = 0; b < kDiffusionLevels; ++b) {
      const Tensor& above = b == 0 ? input : levels.back();
      const LevelMaps& maps = batch.levels[b + 1];
      const Tensor taps = Mapped(above, maps.taps).view({-1, kTaps * above.size(1)});
      levels.push_back(Finished(b, (*blocks_[b].first)(taps),
                                taps.narrow(1, (kTaps - 1) * above.size(1), above.size(1)),
                                conditions, maps));
    }
    Tensor at = dropped(Pooled(kDiffusionLevels - 1, levels.back(), batch));
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
  static constexpr double kSmallStart = 0.3;  // initial size of a block's sum beside its skip

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

  // The rest of a block after its first convolution; x: the block's input at the output's frames.
  Tensor Finished(int b, const Tensor& first, const Tensor& x, const Tensor& conditions,
                  const LevelMaps& maps) {
    Block& block = blocks_[b];
    const std::vector<Tensor> film = block.film->forward(conditions).chunk(2, 1);
    const Tensor inner = torch::addcmul(Mapped(film[1], maps.people), torch::silu(first),
                                        Mapped(1.0 + film[0], maps.people));
    return torch::silu((*block.second)(inner, maps)) + (*block.skip)(x);
  }

  Tensor Pooled(int block, const Tensor& y, const DiffusionBatch& batch) const {
    if (!structure_.PoolsAfter(block)) return y;
    const LevelMaps& maps = batch.levels[block + 1];
    if (!structure_.AttendsAfter(block)) {
      const Tensor seen = Mapped(y, maps.seen);
      return torch::cat({y, seen.view({y.size(0), structure_.NumViews() * y.size(1)})}, 1);
    }
    const Pool& pool = pools_[structure_.join == SocialJoin::kBottleneck ? 0 : block];
    const std::vector<Tensor> groups = y.split_with_sizes(maps.group_rows, 0);
    std::vector<Tensor> seen;
    for (size_t g = 0; g < groups.size(); ++g) {
      seen.push_back(Attended(pool, groups[g], batch.sizes[g]));
    }
    return torch::cat({y, torch::cat(seen, 0)}, 1);
  }

  // Attention over all people of a group, frame by frame.
  static Tensor Attended(const Pool& pool, const Tensor& y, int64_t people) {
    const int64_t width = y.size(1);
    // [frame, head, person, channel]
    const auto by_head = [&](const ConvolutionPointer& layer) {
      return (*layer)(y).view({people, -1, kHeads, width / kHeads}).permute({1, 2, 0, 3});
    };
    const double scale = 1.0 / std::sqrt(static_cast<double>(width / kHeads));
    const Tensor scores =
        scale * torch::matmul(by_head(pool.query), by_head(pool.key).transpose(2, 3));
    const Tensor seen = torch::matmul(torch::softmax(scores, 3), by_head(pool.value));
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

constexpr int kUsualPast = 20, kLeastPast = 2, kMostPast = 30;       // frames
constexpr double kOneFrame = 0.5, kUsual = 0.3, kNothing = 0.15;     // shares of groups
constexpr double kNearestBystander = 2.5, kFarthestBystander = 6.0;  // m
constexpr int kAloneEvery = 5;

double Uniform(double low, double high) {
  return low + (high - low) * torch::rand({1}).item<double>();
}
size_t Pick(size_t count) {
  return static_cast<size_t>(torch::randint(static_cast<int64_t>(count), {1}).item<int64_t>());
}

// The number of observed frames, drawn.
int DrawnPast(int frames) {
  const double drawn = Uniform(0.0, 1.0);
  int past = 1;
  if (drawn >= kOneFrame) past = kUsualPast;
  if (drawn >= kOneFrame + kUsual) {
    past = kLeastPast + static_cast<int>(Pick(kMostPast - kLeastPast + 1));
  }
  if (Uniform(0.0, 1.0) < kNothing) past = 0;
  return std::min(past, frames - 1);
}

int FramesOf(const ObservedGroup& group) { return static_cast<int>(group.front().frames.cols()); }

int64_t RowsOf(const DiffusionBatch& batch, const std::vector<int64_t>& frames) {
  int64_t rows = 0;
  for (size_t g = 0; g < frames.size(); ++g) rows += batch.sizes[g] * frames[g];
  return rows;
}

// above, frames, below: each group's number of frames at the previous, this and the next level.
LevelMaps MapsOf(const DiffusionBatch& batch, const std::vector<int64_t>& above,
                 const std::vector<int64_t>& frames, const std::vector<int64_t>& below) {
  const auto map = [](int64_t out, int64_t in) { return c10::make_intrusive<RowMap>(out, in); };
  const int64_t all = RowsOf(batch, frames);
  const int64_t views = static_cast<int64_t>(batch.views.front().size());
  LevelMaps maps = {
      map(kTaps * all, RowsOf(batch, above)), map(all, kTaps * all), map(all, RowsOf(batch, below)),
      map(all, batch.statics.size(0)),        map(views * all, all), {}};
  int64_t first_above = 0, first = 0, first_below = 0, person = 0;
  for (size_t g = 0; g < frames.size(); ++g) {
    const int64_t group = first;
    for (int64_t n = 0; n < batch.sizes[g]; ++n, ++person) {
      for (int64_t t = 0; t < frames[g]; ++t) {
        maps.tapped->BeginRow();
        for (int64_t back = kTaps - 1, tap = 0; back >= 0; --back, ++tap) {
          maps.taps->BeginRow();
          if (2 * t >= back) maps.taps->Add(first_above + 2 * t - back);
          if (t >= back) maps.tapped->Add(kTaps * (first + t - back) + tap);
        }
        const bool between = t % 2 == 0 && t > 0;
        maps.doubled->BeginRow();
        if (between) maps.doubled->Add(first_below + t / 2 - 1, 0.5f);
        maps.doubled->Add(first_below + t / 2, between ? 0.5f : 1.0f);
        maps.people->BeginRow();
        maps.people->Add(person);
        for (const Eigen::MatrixXf& view : batch.views[g]) {
          maps.seen->BeginRow();
          for (int64_t other = 0; other < batch.sizes[g]; ++other) {
            maps.seen->Add(group + other * frames[g] + t, view(n, other));
          }
        }
      }
      first_above += above[g], first += frames[g], first_below += below[g];
    }
    maps.group_rows.push_back(first - group);
  }
  for (const RowMapPointer& of : {maps.taps, maps.tapped, maps.doubled, maps.people, maps.seen}) {
    of->sums.finalize();
  }
  return maps;
}

void AddMaps(DiffusionBatch* batch) {
  std::vector<std::vector<int64_t>> frames = {batch->frames};
  for (int level = 0; level <= kDiffusionLevels; ++level) {
    frames.push_back(frames.back());
    for (int64_t& of_group : frames.back()) of_group = (of_group + 1) / 2;
  }
  for (int level = 0; level <= kDiffusionLevels; ++level) {
    batch->levels.push_back(
        MapsOf(*batch, frames[std::max(0, level - 1)], frames[level], frames[level + 1]));
  }
}

DiffusionBatch WithoutMaps(const GroupFeatures& features, const DiffusionStructure& structure) {
  DiffusionBatch batch;
  batch.given = ToTensor(features.given);
  batch.statics = ToTensor(features.statics);
  batch.sizes = {features.people};
  batch.frames = {features.frames};
  batch.views = {PoolingWeights(structure.pooling, features.places)};
  return batch;
}

DiffusionBatch Joined(const std::vector<ObservedGroup>& groups, const std::vector<int>& past,
                      const MotionScales& scales, const DiffusionTrainingOptions& options) {
  std::vector<Tensor> truth, given, weights, step_weights, statics;
  DiffusionBatch all;
  for (size_t g = 0; g < groups.size(); ++g) {
    const int frames = FramesOf(groups[g]);
    const GroupFeatures features = FeaturesOf(groups[g], scales, past[g], frames, options.dt);
    const DiffusionBatch one = WithoutMaps(features, options.structure);
    Tensor of_person = torch::ones({frames, 1});
    of_person.narrow(0, 0, past[g]).fill_(options.observed_weight);
    for (const ObservedMotion& person : groups[g]) {
      truth.push_back(ToTensor(MotionRows(person, scales)));
      weights.push_back(of_person);
    }
    of_person = of_person.clone();
    of_person[0] = 0.0;
    step_weights.insert(step_weights.end(), groups[g].size(), of_person);
    given.push_back(one.given), statics.push_back(one.statics);
    all.sizes.push_back(one.sizes.front()), all.frames.push_back(frames);
    all.views.push_back(one.views.front());
  }
  all.truth = torch::cat(truth), all.given = torch::cat(given), all.weights = torch::cat(weights);
  all.step_weights = torch::cat(step_weights), all.statics = torch::cat(statics);
  AddMaps(&all);
  return all;
}

class DiffusionBatches {
 public:
  DiffusionBatches(const std::vector<ObservedGroup>& groups, const MotionScales& scales,
                   const DiffusionTrainingOptions& options)
      : scales_(scales), options_(options) {
    for (const ObservedGroup& group : groups) {
      (group.size() > 1 ? groups_ : alone_).push_back(group);
    }
  }

  bool empty() const { return groups_.empty() && alone_.empty(); }

  // The random batch of a training step.
  DiffusionBatch Draw(int step) const {
    const bool of_groups = alone_.empty() || (!groups_.empty() && step % kAloneEvery != 0);
    const std::vector<ObservedGroup>& from = of_groups ? groups_ : alone_;
    std::vector<ObservedGroup> drawn;
    std::vector<int> past;
    for (int k = 0; k < (of_groups ? options_.groups : options_.people_alone); ++k) {
      drawn.push_back(Varied(from[Pick(from.size())]));
      past.push_back(DrawnPast(FramesOf(drawn.back())));
    }
    return Joined(drawn, past, scales_, options_);
  }

  // At most `most` groups as recorded, with one observed frame.
  DiffusionBatch AsTheyAre(int most) const {
    std::vector<ObservedGroup> all = groups_;
    all.insert(all.end(), alone_.begin(), alone_.end());
    if (static_cast<int>(all.size()) > most) all.resize(most);
    return Joined(all, std::vector<int>(all.size(), 1), scales_, options_);
  }

 private:
  ObservedGroup Varied(const ObservedGroup& group) const {
    const GroupChange change{Uniform(0.0, 1.0) < options_.mirrored,
                             Uniform(-options_.turn, options_.turn),
                             1.0 + Uniform(-options_.size, options_.size)};
    ObservedGroup varied = Changed(group, change);
    if (group.size() > 1 && Uniform(0.0, 1.0) < options_.bystanders) AddBystanders(&varied);
    return varied;
  }

  void AddBystanders(ObservedGroup* group) const {
    const size_t count = 1 + Pick(2);
    for (size_t k = 0; k < count; ++k) {
      const ObservedGroup& from = groups_[Pick(groups_.size())];
      ObservedMotion person = from[Pick(from.size())];
      const Eigen::VectorXf first = person.frames.col(0);
      person.frames = first.replicate(1, group->front().frames.cols());
      person.controls = {};
      const double way = Uniform(kNearestBystander, kFarthestBystander);
      const double angle = Uniform(-M_PI, M_PI);
      // The distance counts from the outermost person in that direction.
      const Eigen::Vector2f direction(static_cast<float>(std::cos(angle)),
                                      static_cast<float>(std::sin(angle)));
      float outermost = -1e9f;
      Eigen::Vector2f edge = Eigen::Vector2f::Zero();
      for (const ObservedMotion& other : *group) {
        if (other.place.dot(direction) <= outermost) continue;
        outermost = other.place.dot(direction);
        edge = other.place;
      }
      person.place = edge + static_cast<float>(way) * direction;
      group->push_back(std::move(person));
    }
  }

  const MotionScales scales_;
  const DiffusionTrainingOptions& options_;
  std::vector<ObservedGroup> groups_, alone_;
};

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

// x_t with the signal's share `a`, [row, 1].
Tensor Noised(const Tensor& truth, const Tensor& a, const Tensor& noise) {
  return a.sqrt() * truth + (1.0 - a).sqrt() * noise;
}

struct DiffusionTraining : StepsTraining<DiffusionTrainer> {
  DiffusionTraining(const std::vector<ObservedGroup>& learnt,
                    const std::vector<ObservedGroup>& held, const DiffusionTrainingOptions& given)
      : options(given),
        scales(MotionScalesOf(learnt, given.structure.frame)),
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
    StartTraining(options);
    module = std::make_shared<DiffusionModule>(options.structure, options.dropout);
    mean = std::make_shared<DiffusionModule>(options.structure, options.dropout);
    CopyWeights(*module, mean.get());
    mean->eval();
    optimizer = MakeOptimizer(module->parameters(), options.learning_rate, options.weight_decay);
  }

  DiffusionTrainingOptions options;
  MotionScales scales;
  Tensor joints_of_rows, sums_of_joints;  // [row, row], m; [row, joint]
  DiffusionBatches batches, held_batches;
  std::shared_ptr<DiffusionModule> module, mean;  // mean: of the weights
  std::unique_ptr<AdamW> optimizer;

  // times: one per group.
  Tensor EstimateBy(DiffusionModule* of, const Tensor& noisy, const std::vector<double>& times,
                    const DiffusionBatch& batch) const {
    std::vector<Tensor> features;
    for (size_t g = 0; g < times.size(); ++g) {
      features.insert(features.end(), batch.sizes[g], ToTensor(TimeFeatures(times[g])));
    }
    return of->Estimate(noisy, torch::stack(features), batch);
  }

  static Tensor Shares(const std::vector<double>& times, const DiffusionBatch& batch) {
    std::vector<Tensor> shares;
    for (size_t g = 0; g < times.size(); ++g) {
      shares.push_back(torch::full({batch.levels[0].group_rows[g], 1}, SignalShare(times[g])));
    }
    return torch::cat(shares);
  }

  // Mean joint distance, m; an error of the hip moves all joints.
  Tensor JointError(const Tensor& miss) const {
    constexpr double kSmooth = 1e-12;  // m^2; a root has no derivative at 0
    const Tensor squares = torch::mm(miss, joints_of_rows).square();
    return (torch::mm(squares, sums_of_joints) + kSmooth).sqrt().mean(1, true);
  }

  Tensor Loss(const Tensor& estimate, const DiffusionBatch& batch) const {
    const Tensor miss = estimate - batch.truth;
    const auto weighted = [](const Tensor& by_frame, const Tensor& weights) {
      return (by_frame * weights).sum() / weights.sum();
    };
    Tensor loss = weighted(miss.abs().mean(1, true), batch.weights);
    if (options.joint_weight > 0.0) {
      loss = loss + options.joint_weight * weighted(JointError(miss), batch.weights);
    }
    if (options.difference_weight > 0.0) {
      const int64_t later = miss.size(0) - 1;
      const Tensor steps = miss.narrow(0, 1, later) - miss.narrow(0, 0, later);
      loss = loss + options.difference_weight *
                        weighted(steps.abs().mean(1, true), batch.step_weights.narrow(0, 1, later));
    }
    return loss;
  }

  double Step() override {
    const DiffusionBatch batch = batches.Draw(step);
    std::vector<double> times(batch.sizes.size());
    for (double& time : times) time = kDiffusionTime * torch::rand({1}).item<double>();
    const Tensor noisy = Noised(batch.truth, Shares(times, batch), torch::randn_like(batch.truth));
    module->train();
    const Tensor loss = Loss(EstimateBy(module.get(), noisy, times, batch), batch);
    Improve(optimizer.get(),
            options.learning_rate * RateShareToFloor(step, options.steps, options.warm_up), loss,
            module->parameters(), options.clip);
    Average();
    return loss.item<double>();
  }

  // Early averages forget faster; otherwise they would keep the random initial weights.
  void Average() {
    torch::NoGradGuard no_grad;
    const double keep = std::min(options.averaging, (1.0 + step) / (10.0 + step));
    const auto now = module->parameters();
    const auto means = mean->parameters();
    for (size_t i = 0; i < now.size(); ++i) means[i].mul_(keep).add_(now[i], 1.0 - keep);
  }

  // The loss of an estimate from nearly pure noise, the first frame and the push.
  double HeldLoss(int) override {
    if (held_batches.empty()) return std::nan("");
    torch::NoGradGuard no_grad;
    const DiffusionBatch batch = held_batches.AsTheyAre(kHeldGroups);
    auto generator = at::detail::createCPUGenerator(kHeldSeed);
    const Tensor noise = torch::randn(batch.truth.sizes(), generator);
    const std::vector<double> times(batch.sizes.size(), kHeldTime);
    mean->eval();
    const Tensor noisy = Noised(batch.truth, Shares(times, batch), noise);
    return Loss(EstimateBy(mean.get(), noisy, times, batch), batch).item<double>();
  }

  int AllSteps() const override { return options.steps; }
  const char* Stage(int) const override { return "diffusion"; }

  DiffusionNetwork Network() const override { return mean->Network(scales); }

  Eigen::MatrixXf Estimate(const GroupFeatures& features, const Eigen::MatrixXf& noisy,
                           double t) const override {
    torch::NoGradGuard no_grad;
    DiffusionBatch batch = WithoutMaps(features, options.structure);
    AddMaps(&batch);
    mean->eval();
    return ToMatrix(EstimateBy(mean.get(), ToTensor(noisy), {t}, batch)).transpose();
  }
};

}  // namespace

std::unique_ptr<DiffusionTrainer> DiffusionTrainer::Make(const std::vector<ObservedGroup>& learnt,
                                                         const std::vector<ObservedGroup>& held,
                                                         const DiffusionTrainingOptions& options) {
  return std::make_unique<DiffusionTraining>(learnt, held, options);
}

}  // namespace pushid
