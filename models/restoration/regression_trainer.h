// models: training of a dense network on samples (the window's, or any other's), with LibTorch
// behind it and nothing of LibTorch in front.
//
//   RegressionTrainer trainer(training, validation, options);
//   while (!trainer.Done()) Show(trainer.RunEpoch());
//   Use(trainer.Best());
//
// Loss: mean absolute error of the outputs, weighted by sample. AdamW with a one-cycle learning
// rate (up over the first 30 % of the steps, down to nothing by cosines), dropout between layers,
// noise on the scaled inputs. Best() are the weights of the epoch with the least validation loss;
// training ends early after `patience` epochs without a better one. State() and Resume() carry
// everything over to another process, random generator included: with one thread a run that was
// broken off and resumed ends with the same bits.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "models/restoration/dense_network.h"

namespace pushid {

struct RegressionSamples {
  Eigen::MatrixXf inputs;   // scaled; a column per sample
  Eigen::MatrixXf targets;  // a column per sample
  Eigen::VectorXf weights;  // of the samples in the loss
};

struct RegressionOptions {
  int hidden = 256, hidden_layers = 2;
  double dropout = 0.2;
  double input_noise = 0.1;  // standard deviation, on scaled inputs
  double learning_rate = 2e-3;
  double weight_decay = 1e-2;
  int epochs = 40;
  int batch = 256;
  int patience = 15;  // epochs without a better validation loss
  uint64_t seed = 1;
  int num_threads = 1;
};

// What one epoch (or round of a longer training) came to; for the training curve.
struct TrainingPoint {
  int epoch = 0;
  double training_loss = 0.0, validation_loss = 0.0;
  std::string stage{};  // where a training has several
};

class RegressionTrainer {
 public:
  RegressionTrainer(const RegressionSamples& training, const RegressionSamples& validation,
                    const RegressionOptions& options);
  ~RegressionTrainer();
  RegressionTrainer(const RegressionTrainer&) = delete;
  RegressionTrainer& operator=(const RegressionTrainer&) = delete;

  bool Done() const;
  TrainingPoint RunEpoch();
  DenseNetwork Best() const;

  std::string State() const;
  // False when the state is not one of this training.
  bool Resume(const std::string& state);

 private:
  struct Torch;
  std::unique_ptr<Torch> torch_;
};

}  // namespace pushid
