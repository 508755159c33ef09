// models: training of a dense network on samples (the window's, or any other's).
//
// Loss: mean absolute error of the outputs, weighted by sample. AdamW with a one-cycle learning
// rate (up over the first 30 % of the steps, down to nothing by cosines), dropout between layers,
// noise on the scaled inputs. A round is an epoch; Best() are the weights of the epoch with the
// least validation loss; training ends early after `patience` epochs without a better one.
#pragma once

#include <string>

#include "models/restoration/dense_network.h"
#include "models/restoration/trainer.h"

namespace pushid {

struct RegressionSamples {
  Eigen::MatrixXf inputs;   // scaled; a column per sample
  Eigen::MatrixXf targets;  // a column per sample
  Eigen::VectorXf weights;  // of the samples in the loss
};

struct RegressionOptions : TrainerOptions {
  int hidden = 256, hidden_layers = 2;
  double dropout = 0.2;
  double input_noise = 0.1;  // standard deviation, on scaled inputs
  double learning_rate = 2e-3;
  double weight_decay = 1e-2;
  int epochs = 40;
  int batch = 256;
  int patience = 15;  // epochs without a better validation loss
};

class RegressionTrainer : public Trainer {
 public:
  RegressionTrainer(const RegressionSamples& training, const RegressionSamples& validation,
                    const RegressionOptions& options);

  DenseNetwork Best() const;

 private:
  struct Torch;
};

}  // namespace pushid
