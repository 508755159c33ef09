// models: LibTorch functions that the trainers share. Included by *_torch.cc files alone.
#pragma once

#include <malloc.h>
#include <torch/torch.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "models/restoration/dense_network.h"
#include "models/restoration/trainer.h"

// LibTorch and glog both define LOG and CHECK, so a file that includes this must not include glog.

namespace pushid {

using torch::Tensor;
using torch::optim::AdamW;

// A row per sample, as LibTorch's layers expect; Eigen's columns have the same memory layout.
inline Tensor ToTensor(const Eigen::MatrixXf& columns) {
  return torch::from_blob(const_cast<float*>(columns.data()), {columns.cols(), columns.rows()})
      .clone();
}
inline Tensor ToTensor(const Eigen::VectorXf& values) {
  return torch::from_blob(const_cast<float*>(values.data()), {values.size()}).clone();
}

inline Eigen::MatrixXf ToMatrix(const Tensor& tensor) {
  const Tensor rows = tensor.detach().to(torch::kFloat32).contiguous();
  using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const int64_t columns = rows.dim() == 1 ? 1 : rows.size(1);
  return Eigen::Map<const RowMajor>(rows.data_ptr<float>(), rows.size(0), columns);
}

inline Eigen::VectorXf ToVector(const Tensor& tensor) { return ToMatrix(tensor).col(0); }

inline DenseLayer ToLayer(const torch::nn::Linear& linear) {
  return {ToMatrix(linear->weight), ToVector(linear->bias)};
}

// The learning rate as a share of the largest: up by a cosine over the first 30 %, then down.
inline double OneCycle(double done) {
  constexpr double kUp = 0.3;
  const double floor = done < kUp ? 0.04 : 1e-4;
  const double phase = done < kUp ? 1.0 - done / kUp : (done - kUp) / (1.0 - kUp);
  return floor + (1.0 - floor) * 0.5 * (1.0 + std::cos(M_PI * phase));
}

// Takes one step. clip: largest norm of the gradient over `parameters`; 0: not clipped.
inline void Improve(AdamW* optimizer, double rate, const Tensor& loss,
                    const std::vector<Tensor>& parameters = {}, double clip = 0.0) {
  for (auto& group : optimizer->param_groups()) {
    static_cast<torch::optim::AdamWOptions&>(group.options()).lr(rate);
  }
  optimizer->zero_grad();
  loss.backward();
  if (clip > 0.0) torch::nn::utils::clip_grad_norm_(parameters, clip);
  optimizer->step();
}

// Both modules must have the same shape.
inline void CopyWeights(const torch::nn::Module& from, torch::nn::Module* to) {
  torch::NoGradGuard no_grad;
  const std::vector<Tensor> source = from.parameters(), target = to->parameters();
  for (size_t i = 0; i < source.size(); ++i) target[i].copy_(source[i]);
}

inline void StartTraining(const TrainerOptions& options) {
  // Keeps freed memory for the next step's tensors: mapping it again takes a tenth of the time.
  mallopt(M_MMAP_THRESHOLD, 1 << 25);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  torch::set_num_threads(options.num_threads);
  torch::manual_seed(options.seed);
}

// A training in rounds of kStepsOfRound steps; a round never crosses two stages.
template <typename Interface>
struct StepsTraining : Interface {
  int step = 0;

  virtual int AllSteps() const = 0;
  virtual double Step() = 0;                         // takes a step and returns its loss
  virtual const char* Stage(int of_step) const = 0;  // its name
  virtual int StageEnd(int /*of_step*/) const { return AllSteps(); }
  virtual double HeldLoss(int of_step) = 0;  // NaN without held data
  virtual void Finish() {}                   // after the last step

  bool Done() const override { return step >= AllSteps(); }
  double ShareDone() const override { return static_cast<double>(step) / AllSteps(); }
  TrainingPoint RunRound() override {
    const int first = step, end = std::min(first + kStepsOfRound, StageEnd(first));
    double sum = 0.0;
    for (; step < end; ++step) sum += Step();
    if (Done()) Finish();
    return {step, sum / std::max(1, end - first), HeldLoss(first), Stage(first)};
  }
};

inline std::unique_ptr<AdamW> MakeOptimizer(const std::vector<Tensor>& parameters, double rate,
                                            double weight_decay) {
  return std::make_unique<AdamW>(parameters,
                                 torch::optim::AdamWOptions(rate).weight_decay(weight_decay));
}

}  // namespace pushid
