// models: batches of groups.
#include <algorithm>

#include "models/generators/diffusion_module_torch.h"

namespace pushid {
namespace {

constexpr double kObservedWeight = 0.1;
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

// Frames that a group is shown.
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

// above, frames, below: of every group at the level before, at this one and at the next.
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

// Groups of one batch.
DiffusionBatch Joined(const std::vector<ObservedGroup>& groups, const std::vector<int>& past,
                      const MotionScales& scales, const DiffusionTrainingOptions& options) {
  std::vector<torch::Tensor> truth, given, weights, step_weights, statics;
  DiffusionBatch all;
  for (size_t g = 0; g < groups.size(); ++g) {
    const int frames = FramesOf(groups[g]);
    const GroupFeatures features = FeaturesOf(groups[g], scales, past[g], frames, options.dt);
    const DiffusionBatch one = WithoutMaps(features, options.structure);
    torch::Tensor of_person = torch::ones({frames, 1});
    of_person.narrow(0, 0, past[g]).fill_(kObservedWeight);
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

}  // namespace

DiffusionBatch BatchOf(const GroupFeatures& features, const DiffusionStructure& structure) {
  DiffusionBatch batch = WithoutMaps(features, structure);
  AddMaps(&batch);
  return batch;
}

DiffusionBatches::DiffusionBatches(const std::vector<ObservedGroup>& groups,
                                   const MotionScales& scales,
                                   const DiffusionTrainingOptions& options)
    : scales_(scales), options_(options) {
  for (const ObservedGroup& group : groups) {
    (group.size() > 1 ? groups_ : alone_).push_back(group);
  }
}

void DiffusionBatches::AddBystanders(ObservedGroup* group) const {
  const size_t count = 1 + Pick(2);
  for (size_t k = 0; k < count; ++k) {
    const ObservedGroup& from = groups_[Pick(groups_.size())];
    ObservedMotion person = from[Pick(from.size())];
    const Eigen::VectorXf first = person.frames.col(0);
    person.frames = first.replicate(1, group->front().frames.cols());
    person.controls = {};
    const double way = Uniform(kNearestBystander, kFarthestBystander);
    const double angle = Uniform(-M_PI, M_PI);
    // Seen from the outermost in that direction, so that nobody is nearer.
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

ObservedGroup DiffusionBatches::Varied(const ObservedGroup& group) const {
  const GroupChange change{Uniform(0.0, 1.0) < 0.5, Uniform(-options_.turn, options_.turn),
                           1.0 + Uniform(-options_.size, options_.size)};
  ObservedGroup varied = Changed(group, change);
  if (group.size() > 1 && Uniform(0.0, 1.0) < options_.bystanders) AddBystanders(&varied);
  return varied;
}

DiffusionBatch DiffusionBatches::Draw(int step) const {
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

DiffusionBatch DiffusionBatches::AsTheyAre(int most) const {
  std::vector<ObservedGroup> all = groups_;
  all.insert(all.end(), alone_.begin(), alone_.end());
  if (static_cast<int>(all.size()) > most) all.resize(most);
  return Joined(all, std::vector<int>(all.size(), 1), scales_, options_);
}

}  // namespace pushid
