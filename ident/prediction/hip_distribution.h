// ident: where hips will be, as mixtures of normal distributions: one component for each node of
// the recording's effect (results/recording_effect.h).
#pragma once

#include <vector>

#include "datasets/files/random.h"
#include "ident/results/recording_filter.h"

namespace pushid {

// Of the standard normal distribution.
double NormalCdf(double x);

class HipDistribution {
 public:
  // Of the frames that the filter has not seen. centre: what is predicted of them; the mixture is
  // moved there, and widened by what the effect says of the time seen.
  HipDistribution(const RecordingFilter& filter, const RecordingEffect& effect,
                  const HipPaths& centre);

  int num_people() const { return static_cast<int>(points_.size()); }
  int num_frames() const { return points_.empty() ? 0 : static_cast<int>(points_[0].size()); }

  // frame: 0 is the first that was not seen; axis: 0 x, 1 y, 2 z.
  double Cdf(int person, int frame, int axis, double value) const;
  double Quantile(int person, int frame, int axis, double share) const;
  // One future: a component, and how far from its middle each person goes on each axis, in
  // deviations. Frame by frame draws are spread as the distribution says; a person who is far out
  // stays so, as errors of velocity do, which add up.
  HipPaths Draw(Random* random) const;

 private:
  std::vector<double> weights_;
  std::vector<std::vector<MixturePoint>> points_;  // on the world's axes
};

}  // namespace pushid
