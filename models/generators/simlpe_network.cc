// models: siMLPe, forward.
#include "models/generators/simlpe_network.h"

#include <cmath>

namespace pushid {
namespace {

// Each column to mean 0 and variance 1, then by row.
Eigen::MatrixXf Normed(const Eigen::MatrixXf& values, const SimlpeBlock& block) {
  Eigen::MatrixXf normed = values.rowwise() - values.colwise().mean();
  const Eigen::RowVectorXf variance = normed.array().square().colwise().mean();
  normed.array().rowwise() /= (variance.array() + kNormSmooth).sqrt();
  normed.array().colwise() *= block.scale.array();
  return normed.colwise() + block.shift;
}

}  // namespace

Trajectories SimlpeNetwork::Forecast(const Trajectories& seen, int frames) const {
  const int given = observed();
  const Eigen::MatrixXf transform = CosineTransform(given).cast<float>();
  Trajectories motion = seen.rightCols(given);
  while (motion.cols() < given + frames) {
    const Eigen::MatrixXf last = motion.rightCols(given);
    Eigen::MatrixXf poses = last.colwise() - pose_mean;
    poses.array().colwise() /= pose_spread.array();
    Eigen::MatrixXf state = Applied(input, poses * transform.transpose());
    for (const SimlpeBlock& block : blocks) {
      state += Normed(Applied(block.mix, state.transpose()).transpose(), block);
    }
    const Eigen::MatrixXf moved = pose_spread.asDiagonal() * Applied(output, state) * transform;
    motion.conservativeResize(Eigen::NoChange, motion.cols() + given);
    motion.rightCols(given) = moved.colwise() + last.col(given - 1);
  }
  return motion.middleCols(given, frames);
}

namespace {

void ListTensors(const std::string& name, int observed, int coordinates, SimlpeNetwork* network,
                 TensorFields* fields) {
  fields->Matrix(name + ".pose_mean", coordinates, 1, &network->pose_mean);
  fields->Positive(name + ".pose_spread", coordinates, &network->pose_spread);
  fields->Layer(name + ".input", coordinates, coordinates, &network->input);
  fields->Layer(name + ".output", coordinates, coordinates, &network->output);
  for (size_t i = 0; i < network->blocks.size(); ++i) {
    SimlpeBlock& block = network->blocks[i];
    const std::string of_block = name + ".block" + std::to_string(i);
    fields->Layer(of_block + ".mix", observed, observed, &block.mix);
    fields->Matrix(of_block + ".scale", coordinates, 1, &block.scale);
    fields->Matrix(of_block + ".shift", coordinates, 1, &block.shift);
  }
}

}  // namespace

void AddTensors(const std::string& name, const SimlpeNetwork& network, TensorList* tensors) {
  SimlpeNetwork written = network;
  TensorFields fields(tensors);
  ListTensors(name, network.observed(), static_cast<int>(network.pose_mean.size()), &written,
              &fields);
}

SimlpeNetwork TakeSimlpe(const std::string& name, int observed, int coordinates, int blocks,
                         TensorReader* reader) {
  SimlpeNetwork network;
  network.blocks.resize(static_cast<size_t>(blocks));
  TensorFields fields(reader);
  ListTensors(name, observed, coordinates, &network, &fields);
  return network;
}

Trajectories MeanForecast(const std::vector<SimlpeNetwork>& members, const Trajectories& seen,
                          int frames) {
  Trajectories sum = Trajectories::Zero(seen.rows(), frames);
  for (const SimlpeNetwork& member : members) sum += member.Forecast(seen, frames);
  return sum / static_cast<float>(members.size());
}

std::vector<Trajectories> SimlpeGenerator::Forecast(const std::vector<ObservedMotion>& people,
                                                    int frames) const {
  std::vector<Trajectories> motions;
  for (const ObservedMotion& person : people) {
    motions.push_back(MeanForecast(members_, person.frames, frames));
  }
  return motions;
}

std::vector<std::vector<SampledFuture>> SimlpeGenerator::Sample(
    const std::vector<ObservedMotion>& people, int frames, int count, const NormalSource&) const {
  std::vector<std::vector<SampledFuture>> futures;
  for (Trajectories& motion : Forecast(people, frames)) {
    futures.emplace_back(static_cast<size_t>(count), SampledFuture{std::move(motion)});
  }
  return futures;
}

}  // namespace pushid
