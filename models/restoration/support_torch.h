// models: LibTorch kept in one place: what the trainers share. Included by *_torch.cc files alone.
#pragma once

// LibTorch and glog both define LOG and CHECK: a file that includes this includes no glog.
#include <torch/torch.h>

#include <cmath>
#include <sstream>
#include <string>

#include "models/restoration/dense_network.h"

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

inline std::string Archived(const torch::serialize::OutputArchive& archive) {
  std::ostringstream stream;
  const_cast<torch::serialize::OutputArchive&>(archive).save_to(stream);
  return stream.str();
}

// A module's or an optimizer's state as a part of a training's.
template <typename Part>
void WritePart(const char* name, const Part& part, torch::serialize::OutputArchive* archive) {
  torch::serialize::OutputArchive of_part;
  part.save(of_part);
  archive->write(name, of_part);
}
template <typename Part>
void ReadPart(const char* name, torch::serialize::InputArchive* archive, Part* part) {
  torch::serialize::InputArchive of_part;
  archive->read(name, of_part);
  part->load(of_part);
}

// Reads what Archived wrote; read: takes the archive. False when the state is another training's.
template <typename Read>
bool Unarchived(const std::string& state, const Read& read) {
  try {
    std::istringstream stream(state);
    torch::serialize::InputArchive archive;
    archive.load_from(stream);
    read(&archive);
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

// How far a training is, and where its random numbers are.
inline void WriteProgress(int step, torch::serialize::OutputArchive* archive) {
  archive->write("step", torch::tensor(step));
  archive->write("random", at::detail::getDefaultCPUGenerator().get_state());
}
inline int ReadProgress(torch::serialize::InputArchive* archive) {
  torch::Tensor step, random;
  archive->read("step", step);
  archive->read("random", random);
  auto generator = at::detail::getDefaultCPUGenerator();
  generator.set_state(random);
  return step.item<int>();
}

}  // namespace pushid
