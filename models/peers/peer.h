// models: a peer: a motion forecaster to compare with, which has no pendulum and no push, only the
// motion so far. It is given everybody's first frames and continues them, again and again from its
// own output, until all frames are there.
//
// Peers see recordings at 60 Hz, the rate of the published ones. There MRT's task in LDP's
// comparison, 20 frames given and 60 to predict, fits 34 of the 49 published groups; shorter ones
// are predicted to their end (the shortest has 43 frames), and so are longer ones, on and on.
#pragma once

#include <string_view>
#include <vector>

#include "models/restoration/body.h"

namespace pushid {

inline constexpr double kPeerRate = 60.0;  // Hz

class Peer {
 public:
  virtual ~Peer() = default;
  virtual std::string_view name() const = 0;  // of its kind, in files and scores
  // Frames that it has to be given.
  virtual int given_frames() const = 0;
  // people: everybody of one recording, at least given_frames() frames each, of which the first
  // given_frames() are read and returned as they are; the rest is predicted, `frames` in all. The
  // order of people changes nothing.
  virtual std::vector<BodyMotion> Continue(const std::vector<BodyMotion>& people,
                                           int frames) const = 0;
};

}  // namespace pushid
