// models: LibTorch kept in one place: what the trainers share. Included by *_torch.cc files alone.
#pragma once

#include <malloc.h>
#include <torch/torch.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "models/restoration/dense_network.h"
#include "models/restoration/trainer.h"

// LibTorch and glog both define LOG and CHECK: a file that includes this includes no glog.

namespace pushid {

// A row per sample, as LibTorch's layers want them; Eigen's columns are such rows in memory.
inline torch::Tensor ToTensor(const Eigen::MatrixXf& columns) {
  return torch::from_blob(const_cast<float*>(columns.data()), {columns.cols(), columns.rows()},
                          torch::kFloat32)
      .clone();
}

inline torch::Tensor ToTensor(const Eigen::VectorXf& values) {
  return torch::from_blob(const_cast<float*>(values.data()), {values.size()}, torch::kFloat32)
      .clone();
}

inline Eigen::MatrixXf ToMatrix(const torch::Tensor& tensor) {
  const torch::Tensor rows = tensor.detach().to(torch::kFloat32).contiguous();
  using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const int64_t columns = rows.dim() == 1 ? 1 : rows.size(1);
  return Eigen::Map<const RowMajor>(rows.data_ptr<float>(), rows.size(0), columns);
}

inline Eigen::VectorXf ToVector(const torch::Tensor& tensor) { return ToMatrix(tensor).col(0); }

inline DenseLayer ToLayer(const torch::nn::Linear& linear) {
  return {ToMatrix(linear->weight), ToVector(linear->bias)};
}

// Learning rate of a step as a share of the largest: up by a cosine over the first 30 %, then down.
inline double OneCycle(double done) {
  constexpr double kUp = 0.3;
  const double floor = done < kUp ? 0.04 : 1e-4;
  const double phase = done < kUp ? 1.0 - done / kUp : (done - kUp) / (1.0 - kUp);
  return floor + (1.0 - floor) * 0.5 * (1.0 + std::cos(M_PI * phase));
}

inline void SetLearningRate(torch::optim::AdamW* optimizer, double rate) {
  for (auto& group : optimizer->param_groups()) {
    static_cast<torch::optim::AdamWOptions&>(group.options()).lr(rate);
  }
}

inline void Improve(torch::optim::AdamW* optimizer, const torch::Tensor& loss) {
  optimizer->zero_grad();
  loss.backward();
  optimizer->step();
}
// The gradient held within `clip`.
inline void Improve(torch::optim::AdamW* optimizer, const torch::Tensor& loss,
                    const std::vector<torch::Tensor>& parameters, double clip) {
  optimizer->zero_grad();
  loss.backward();
  torch::nn::utils::clip_grad_norm_(parameters, clip);
  optimizer->step();
}

// Both modules are of one shape.
inline void CopyWeights(const torch::nn::Module& from, torch::nn::Module* to) {
  torch::NoGradGuard no_grad;
  const std::vector<torch::Tensor> source = from.parameters(), target = to->parameters();
  for (size_t i = 0; i < source.size(); ++i) target[i].copy_(source[i]);
}

inline int64_t NumNumbers(const std::vector<torch::Tensor>& parameters) {
  int64_t count = 0;
  for (const torch::Tensor& parameter : parameters) count += parameter.numel();
  return count;
}

inline void StartTraining(const TrainerOptions& options) {
  // Tensors of every step come from memory that is kept: mapped anew they take a tenth of the time.
  mallopt(M_MMAP_THRESHOLD, 1 << 25);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  torch::set_num_threads(options.num_threads);
  torch::manual_seed(options.seed);
}

// The state of a training: one list of its fields, Torch::Keep(StateWriter or StateReader*), serves
// writing and reading. The random generator belongs to every state.
class StateWriter {
 public:
  static constexpr bool kReads = false;
  template <typename Kept>
  void Part(const char* name, Kept* part) {  // a module or an optimizer
    torch::serialize::OutputArchive of_part;
    part->save(of_part);
    archive_.write(name, of_part);
  }
  void Tensor(const char* name, torch::Tensor* tensor) { archive_.write(name, *tensor); }
  template <typename... Number>
  void Numbers(const char* name, Number*... numbers) {
    archive_.write(name, torch::tensor({static_cast<double>(*numbers)...}, torch::kFloat64));
  }
  std::string Finish() {
    archive_.write("random", at::detail::getDefaultCPUGenerator().get_state());
    std::ostringstream stream;
    archive_.save_to(stream);
    return stream.str();
  }

 private:
  torch::serialize::OutputArchive archive_;
};

class StateReader {
 public:
  static constexpr bool kReads = true;
  explicit StateReader(const std::string& state) {
    std::istringstream stream(state);
    archive_.load_from(stream);
  }
  template <typename Kept>
  void Part(const char* name, Kept* part) {
    torch::serialize::InputArchive of_part;
    archive_.read(name, of_part);
    part->load(of_part);
  }
  void Tensor(const char* name, torch::Tensor* tensor) { archive_.read(name, *tensor); }
  template <typename... Number>
  void Numbers(const char* name, Number*... numbers) {
    torch::Tensor all;
    archive_.read(name, all);
    all = all.reshape({-1});
    int64_t i = 0;
    ((*numbers = static_cast<Number>(all[i++].item<double>())), ...);
  }
  void Finish() {
    torch::Tensor random;
    archive_.read("random", random);
    auto generator = at::detail::getDefaultCPUGenerator();
    generator.set_state(random);
  }

 private:
  torch::serialize::InputArchive archive_;
};

template <typename Torch>
std::string StateOf(Torch* torch) {
  StateWriter writer;
  torch->Keep(&writer);
  return writer.Finish();
}

// False when the state is another training's.
template <typename Torch>
bool ResumeFrom(const std::string& state, Torch* torch) {
  try {
    StateReader reader(state);
    torch->Keep(&reader);
    reader.Finish();
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

// State and Resume of a run (Trainer::Run) that lists its fields.
template <typename Run, typename Self>
struct KeptRun : Run {
  std::string State() override { return StateOf(static_cast<Self*>(this)); }
  bool Resume(const std::string& state) override {
    return ResumeFrom(state, static_cast<Self*>(this));
  }
};

// Training by steps, with a point of the curve for every round of them. A round is of one stage.
template <typename Run, typename Self>
struct StepsRun : KeptRun<Run, Self> {
  int step = 0;

  virtual int AllSteps() const = 0;
  virtual double Step() = 0;  // takes a step; its loss
  // Name of the stage that a step belongs to.
  virtual const char* Stage(int of_step) const = 0;
  virtual int StageEnd(int /*of_step*/) const { return AllSteps(); }
  virtual double HeldLoss(int of_step) = 0;  // NaN where nothing is held
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

// As LibTorch's AdamW has it.
inline std::unique_ptr<torch::optim::AdamW> MakeOptimizer(
    const std::vector<torch::Tensor>& parameters, double rate, double weight_decay) {
  return std::make_unique<torch::optim::AdamW>(
      parameters, torch::optim::AdamWOptions(rate).weight_decay(weight_decay));
}

}  // namespace pushid
