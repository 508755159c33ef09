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

namespace pushid {

// What every training is told; its own options add to this.
struct TrainerOptions {
  uint64_t seed = 1;
  int num_threads = 1;
};

// What one round (an epoch, or some steps) came to; for the training curve.
struct TrainingPoint {
  int epoch = 0;
  double training_loss = 0.0, validation_loss = 0.0;
  std::string stage{};  // where a training has several
};

// done: share of all steps, 0 .. 1.
using TrainingProgress = std::function<void(const TrainingPoint& point, double done)>;

class Trainer {
 public:
  Trainer() = default;
  virtual ~Trainer() = default;
  Trainer(const Trainer&) = delete;
  Trainer& operator=(const Trainer&) = delete;

  virtual bool Done() const = 0;
  virtual TrainingPoint RunRound() = 0;
  virtual double ShareDone() const = 0;  // after a round; 0 .. 1
  virtual std::string State() const = 0;
  // False when the state is not one of this training.
  virtual bool Resume(const std::string& state) = 0;
};

}  // namespace pushid
