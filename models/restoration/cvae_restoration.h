// models: bodies by LDP's chain, frame after frame, everybody together.
#pragma once

#include <functional>

#include "models/normal_source.h"
#include "models/restoration/cvae_networks.h"
#include "models/restoration/restoration.h"

namespace pushid {

class CvaeRestoration : public Restoration {
 public:
  // draws: of z where there is no pendulum, made anew for every call of Restore.
  explicit CvaeRestoration(CvaeWeights weights, std::function<NormalSource()> draws = nullptr)
      : weights_(std::move(weights)), draws_(std::move(draws)) {}
  std::string_view kind() const override { return Name(RestorationKind::kCvae); }
  std::vector<BodyMotion> Restore(const std::vector<RestorationInput>& people) const override;
  const CvaeWeights& weights() const { return weights_; }

 private:
  CvaeWeights weights_;
  std::function<NormalSource()> draws_;
};

}  // namespace pushid
