// models: bodies by LDP's chain, frame after frame, everybody together.
#pragma once

#include "models/restoration/cvae_networks.h"
#include "models/restoration/restoration.h"

namespace pushid {

class CvaeRestoration : public Restoration {
 public:
  CvaeRestoration(CvaeWeights weights, CvaeCoordinates coordinates)
      : weights_(std::move(weights)), coordinates_(coordinates) {}
  std::string_view kind() const override { return Name(RestorationKind::kCvae); }
  std::vector<BodyMotion> Restore(const std::vector<RestorationInput>& people) const override;
  const CvaeWeights& weights() const { return weights_; }

 private:
  CvaeWeights weights_;
  CvaeCoordinates coordinates_;
};

}  // namespace pushid
