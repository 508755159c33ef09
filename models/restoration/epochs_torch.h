// models: training by epochs that keeps the best one, in LibTorch: what the trainers of windows, of
// siMLPe and of MRT share. Included by *_torch.cc files alone.
#pragma once

#include <memory>
#include <string>

#include "models/restoration/support_torch.h"

namespace pushid {

// Network: a module; `best` has the weights of the epoch with the least held-out loss.
template <typename Network>
struct Epochs {
  std::shared_ptr<Network> network, best;
  std::unique_ptr<torch::optim::AdamW> optimizer;
  int epoch = 0, best_epoch = 0;
  double best_loss = 1e30;

  // Both networks are of one shape.
  void Start(std::shared_ptr<Network> to_train, std::shared_ptr<Network> to_keep, double rate,
             double weight_decay) {
    network = std::move(to_train), best = std::move(to_keep);
    KeepBest();
    optimizer = std::make_unique<torch::optim::AdamW>(
        network->parameters(), torch::optim::AdamWOptions(rate).weight_decay(weight_decay));
  }

  // patience: epochs without a better one.
  bool Done(int epochs, int patience) const {
    return epoch >= epochs || epoch - best_epoch >= patience;
  }

  void Step(const torch::Tensor& loss) {
    optimizer->zero_grad();
    loss.backward();
    optimizer->step();
  }

  void Judge(double held_loss) {
    if (held_loss >= best_loss) return;
    best_loss = held_loss;
    best_epoch = epoch;
    KeepBest();
  }

  std::string State() const {
    torch::serialize::OutputArchive archive;
    WritePart("network", *network, &archive);
    WritePart("best", *best, &archive);
    WritePart("optimizer", *optimizer, &archive);
    archive.write("judged",
                  torch::tensor({static_cast<double>(best_epoch), best_loss}, torch::kFloat64));
    WriteProgress(epoch, &archive);
    return Archived(archive);
  }

  // False when the state is not one of this training.
  bool Resume(const std::string& state) {
    return Unarchived(state, [this](torch::serialize::InputArchive* archive) {
      torch::Tensor judged;
      archive->read("judged", judged);
      ReadPart("network", archive, network.get());
      ReadPart("best", archive, best.get());
      ReadPart("optimizer", archive, optimizer.get());
      best_epoch = static_cast<int>(judged[0].item<double>());
      best_loss = judged[1].item<double>();
      epoch = ReadProgress(archive);
    });
  }

 private:
  void KeepBest() {
    torch::NoGradGuard no_grad;
    for (size_t i = 0; i < network->parameters().size(); ++i) {
      best->parameters()[i].copy_(network->parameters()[i]);
    }
  }
};

}  // namespace pushid
