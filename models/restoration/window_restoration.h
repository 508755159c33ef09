// models: the window network: the shape of the body at a frame from the pendulum around that frame,
// no memory of its own, so that nothing can drift.
#pragma once

#include "models/restoration/dense_network.h"
#include "models/restoration/restoration.h"
#include "models/restoration/restoration_view.h"

namespace pushid {

struct WindowWeights {
  RestorationView view = RestorationView::kPendulum;
  Scaling inputs;
  DenseNetwork network;  // outputs in m
};

class WindowRestoration : public Restoration {
 public:
  explicit WindowRestoration(WindowWeights weights) : weights_(std::move(weights)) {}
  std::string_view kind() const override { return Name(RestorationKind::kWindow); }
  std::vector<BodyMotion> Restore(const std::vector<RestorationInput>& people) const override;
  const WindowWeights& weights() const { return weights_; }

 private:
  WindowWeights weights_;
};

}  // namespace pushid
