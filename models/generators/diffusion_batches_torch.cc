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

// A column per person and frame to [person, row, frame].
torch::Tensor ByPerson(const Eigen::MatrixXf& columns, int people) {
  const torch::Tensor all = ToTensor(columns);
  return all.view({people, all.size(0) / people, all.size(1)}).transpose(1, 2);
}

int FramesOf(const ObservedGroup& group) { return static_cast<int>(group.front().frames.cols()); }

int Padded(int frames) {
  return (frames + kDiffusionFrames - 1) / kDiffusionFrames * kDiffusionFrames;
}

// Groups of one batch, padded to the longest.
DiffusionBatch Joined(const std::vector<ObservedGroup>& groups, const std::vector<int>& past,
                      const MotionScales& scales, const DiffusionTrainingOptions& options) {
  int longest = 0;
  int64_t people = 0;
  for (const ObservedGroup& group : groups) {
    longest = std::max(longest, Padded(FramesOf(group)));
    people += static_cast<int64_t>(group.size());
  }
  const bool pendulum = options.structure.pendulum;
  DiffusionBatch all;
  all.truth = torch::zeros({people, scales.rows(), longest});
  all.given = torch::zeros({people, GivenRows(pendulum, scales.rows()), longest});
  all.weights = torch::zeros({people, 1, longest});
  all.statics = torch::zeros({people, kStaticRows});
  int64_t begin = 0;
  for (size_t g = 0; g < groups.size(); ++g) {
    const int frames = FramesOf(groups[g]), count = static_cast<int>(groups[g].size());
    const GroupFeatures features =
        FeaturesOf(groups[g], scales, past[g], frames, options.dt, pendulum);
    Eigen::MatrixXf rows(scales.rows(), count * frames);
    for (int n = 0; n < count; ++n) {
      rows.middleCols(n * frames, frames) = MotionRows(groups[g][n], scales, pendulum);
    }
    const DiffusionBatch one = BatchOf(features, options.structure);
    const auto place = [&](torch::Tensor& to) { return to.narrow(0, begin, count); };
    place(all.truth).narrow(2, 0, frames).copy_(ByPerson(rows, count));
    place(all.given).narrow(2, 0, frames).copy_(one.given.narrow(2, 0, frames));
    place(all.weights).narrow(2, 0, past[g]).fill_(kObservedWeight);
    place(all.weights).narrow(2, past[g], frames - past[g]).fill_(1.0);
    place(all.statics).copy_(one.statics);
    all.sizes.push_back(count);
    all.views.push_back(one.views.front());
    begin += count;
  }
  return all;
}

}  // namespace

DiffusionBatch BatchOf(const GroupFeatures& features, const DiffusionStructure& structure) {
  DiffusionBatch batch;
  const torch::Tensor given = ByPerson(features.given, features.people);
  batch.given = torch::constant_pad_nd(given, {0, Padded(features.frames) - features.frames});
  batch.statics = ToTensor(features.statics);
  batch.sizes = {features.people};
  batch.views.emplace_back();
  for (const Eigen::MatrixXf& view : PoolingWeights(structure.pooling, features.places)) {
    batch.views.back().push_back(ToTensor(Eigen::MatrixXf(view.transpose())));
  }
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
    if (person.pendulum.size() > 0) {
      const Eigen::VectorXf place = person.pendulum.col(0);
      person.pendulum = place.replicate(1, person.frames.cols());
    }
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
  GroupChange change;
  change.mirrored = Uniform(0.0, 1.0) < 0.5;
  change.turn = Uniform(-options_.turn, options_.turn);
  change.size = 1.0 + Uniform(-options_.size, options_.size);
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
