// residuals: from recordings to batches of people side by side.
#include "residuals/adjoint/adjoint_gradient.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "residuals/adjoint/adjoint_batch.h"

namespace pushid {
namespace {

// More people side by side are no faster, and each keeps all its steps.
constexpr int kPeopleTogether = 64;

MaybeError WhatCannotBeDone(const std::vector<AdjointRecording>& recordings,
                            const ModelOptions& options, const ParameterMap& map) {
  if (options.learned == nullptr) return Error{"the adjoint gradient needs a network"};
  if (options.stance != Stance::kSlide) {
    return Error{
        "the adjoint gradient is for feet that slide; leave --stance out, or use a "
        "network small enough for Gauss-Newton"};
  }
  if (map.num_deviations > 0) {
    return Error{
        "the adjoint gradient has no deviations by subject or setting; fit them without the "
        "network first and hold them here"};
  }
  for (const AdjointRecording& r : recordings) {
    const size_t people = static_cast<size_t>(r.recording->num_people());
    if (r.held.size() > 1 && r.held.size() != people) {
      return Error{"recording '" + r.recording->id + "' has " + std::to_string(people) +
                   " people, but held values of " + std::to_string(r.held.size())};
    }
    if (r.recording->initial_velocity == InitialVelocity::kFree) {
      return Error{"recording '" + r.recording->id +
                   "' has a free initial velocity, which the adjoint gradient does not fit; make "
                   "it zero or estimated"};
    }
  }
  return {};
}

}  // namespace

int AdjointCost::num_failed() const {
  return static_cast<int>(
      std::count_if(status.begin(), status.end(), [](const RolloutStatus& s) { return !s.ok; }));
}

AdjointGradient::AdjointGradient() = default;
AdjointGradient::AdjointGradient(AdjointGradient&&) noexcept = default;
AdjointGradient::~AdjointGradient() = default;

Result<AdjointGradient> AdjointGradient::Create(const std::vector<AdjointRecording>& recordings,
                                                const ModelOptions& options,
                                                const ParameterMap& map,
                                                const ResidualSigmas& sigmas,
                                                const VectorKernels& kernels) {
  if (const MaybeError error = WhatCannotBeDone(recordings, options, map)) return *error;
  AdjointGradient gradient;
  gradient.map_ = map;
  gradient.num_weights_ = options.learned->num_weights();
  gradient.num_recordings_ = static_cast<int>(recordings.size());
  const auto frames = [&](int i) {
    const int all = recordings[i].recording->num_frames();
    return recordings[i].horizon > 0 ? std::min(recordings[i].horizon, all) : all;
  };
  std::vector<int> order(recordings.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return frames(a) > frames(b); });
  for (size_t begin = 0; begin < order.size();) {
    std::vector<int> together;
    for (int people = 0; begin < order.size() && (together.empty() || people < kPeopleTogether);) {
      people += recordings[order[begin]].recording->num_people();
      together.push_back(order[begin++]);
    }
    gradient.batches_.push_back(
        std::make_unique<Batch>(recordings, together, options, sigmas, kernels));
  }
  return gradient;
}

int AdjointGradient::num_shared() const { return map_.num_shared(); }
int AdjointGradient::num_weights() const { return num_weights_; }

AdjointCost AdjointGradient::Evaluate(const double* shared, const double* weights,
                                      double* by_shared, double* by_weight) {
  ParameterSet<double> by_parameter{};
  AdjointCost result;
  result.status.resize(num_recordings_);
  if (by_weight != nullptr) std::fill_n(by_weight, num_weights_, 0.0);
  for (const auto& batch : batches_) {
    result.cost += batch->Forward(map_, shared, weights, &result.status);
    if (by_shared == nullptr && by_weight == nullptr) continue;
    batch->Backward(&by_parameter, by_weight);
  }
  if (by_shared == nullptr) return result;
  std::fill_n(by_shared, map_.num_shared(), 0.0);
  // What is fitted is the same of everybody, and so are the slopes.
  const ParameterSet<double> p = map_.Apply<double>(shared, nullptr);
  for (const ColumnEntry& entry : map_.Entries(p, -1)) {
    by_shared[entry.column] += entry.derivative * by_parameter[entry.parameter];
  }
  return result;
}

}  // namespace pushid
