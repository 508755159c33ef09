// ident: sampled groups against what they did.
#include "ident/generators/group_spread.h"

#include <algorithm>

#include "datasets/files/number_text.h"
#include "datasets/files/random.h"

namespace pushid {

GroupSpread SpreadOf(const LoadedGenerator& loaded, const std::vector<BodyRecording>& recordings,
                     int samples, uint64_t seed) {
  GroupSpread spread;
  spread.samples = samples;
  Random random(seed);
  const NormalSource normal = [&random] { return random.Normal(); };
  const int observed = loaded.settings.observed;
  double frames = 0.0;
  for (const BodyRecording& recording : recordings) {
    const std::vector<ObservedMotion> whole = GroupOf(recording);
    std::vector<ObservedMotion> people = whole;
    for (ObservedMotion& person : people) {
      person.frames = Trajectories(person.frames.leftCols(observed));
    }
    const int after = recording.num_frames() - observed;
    const auto futures = loaded.generator->Sample(people, after, samples, normal);
    for (size_t n = 0; n < people.size(); ++n) {
      for (int t = 0; t < after; ++t) {
        float low = futures[n].front().motion(0, t), high = low;
        for (const SampledFuture& future : futures[n]) {
          low = std::min(low, future.motion(0, t));
          high = std::max(high, future.motion(0, t));
        }
        const float recorded = whole[n].frames(0, observed + t);
        spread.inside += recorded >= low && recorded <= high ? 1.0 : 0.0;
        spread.width += high - low;
        frames += 1.0;
      }
    }
  }
  spread.inside /= std::max(1.0, frames);
  spread.width /= std::max(1.0, frames);
  return spread;
}

nlohmann::ordered_json ToJson(const GroupSpread& spread) {
  return {{"samples", spread.samples},
          {"hip_x_inside", spread.inside},
          {"hip_x_width_m", spread.width}};
}

std::string SpreadText(const GroupSpread& spread) {
  const double ideal = (spread.samples - 1.0) / (spread.samples + 1.0);
  return "the recorded hip lies among " + std::to_string(spread.samples) + " sampled futures in " +
         Rounded(100.0 * spread.inside, 3) + " % of frames (" + Rounded(100.0 * ideal, 3) +
         " % if they spread as people do); they are " + Rounded(spread.width, 3) + " m wide\n";
}

}  // namespace pushid
