// models: a training, with LibTorch behind it and nothing of LibTorch in front.
//
//   RegressionTrainer trainer(training, validation, options);
//   while (!trainer.Done()) Show(trainer.RunRound());
//   Use(trainer.Best());
//
// State() and Resume() carry everything over to another process, random generator included: with
// one thread a run that was broken off and resumed ends with the same bits.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "models/restoration/dense_network.h"

namespace pushid {

// What every training is told; its own options add to this.
struct TrainerOptions {
  uint64_t seed = 1;
  int num_threads = 1;
};

inline constexpr int kStepsOfRound = 50;  // where a round is not an epoch

// What one round (an epoch, or some steps) came to; for the training curve.
struct TrainingPoint {
  int epoch = 0;
  double training_loss = 0.0, validation_loss = 0.0;
  std::string stage{};  // where a training has several
};

// done: share of all steps, 0 .. 1.
using TrainingProgress = std::function<void(const TrainingPoint& point, double done)>;

// A training of one kind has a class derived from this, with what it gives in the end, and in its
// *_torch.cc a struct derived from Run.
class Trainer {
 public:
  bool Done() const { return run_->Done(); }
  TrainingPoint RunRound() { return run_->RunRound(); }
  double ShareDone() const { return run_->ShareDone(); }  // after a round; 0 .. 1
  std::string State() const { return run_->State(); }
  // False when the state is not one of this training.
  bool Resume(const std::string& state) { return run_->Resume(state); }

 protected:
  struct Run {
    virtual ~Run() = default;
    virtual bool Done() const = 0;
    virtual TrainingPoint RunRound() = 0;
    virtual double ShareDone() const = 0;
    virtual std::string State() = 0;
    virtual bool Resume(const std::string& state) = 0;
  };
  explicit Trainer(std::unique_ptr<Run> run) : run_(std::move(run)) {}
  template <typename Torch>
  Torch& As() const {
    return static_cast<Torch&>(*run_);
  }

 private:
  std::unique_ptr<Run> run_;
};

// Training of a dense network on samples (the window's, or any other's).
//
// Loss: mean absolute error of the outputs, weighted by sample. AdamW with a one-cycle learning
// rate (up over the first 30 % of the steps, down to nothing by cosines), dropout between layers,
// noise on the scaled inputs. A round is an epoch; Best() are the weights of the epoch with the
// least validation loss; training ends early after `patience` epochs without a better one.

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
